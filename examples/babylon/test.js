// Scenes of test.mjs. All but the balls are drawn into textures of linear 32-bit floats, so that figures are of light.

import { Bone } from "@babylonjs/core/Bones/bone.js";
import { Skeleton } from "@babylonjs/core/Bones/skeleton.js";
import { Camera } from "@babylonjs/core/Cameras/camera.js";
import { FreeCamera } from "@babylonjs/core/Cameras/freeCamera.js";
import { DirectionalLight } from "@babylonjs/core/Lights/directionalLight.js";
import { PointLight } from "@babylonjs/core/Lights/pointLight.js";
import { ShadowGenerator } from "@babylonjs/core/Lights/Shadows/shadowGenerator.js";
import "@babylonjs/core/Lights/Shadows/shadowGeneratorSceneComponent.js";
import { SpotLight } from "@babylonjs/core/Lights/spotLight.js";
import { Color3, Color4 } from "@babylonjs/core/Maths/math.color.js";
import { Matrix, Vector3 } from "@babylonjs/core/Maths/math.vector.js";
import { CreateGround } from "@babylonjs/core/Meshes/Builders/groundBuilder.js";
import "@babylonjs/core/Meshes/instancedMesh.js";
import "@babylonjs/core/Meshes/thinInstanceMesh.js";
import { MorphTarget } from "@babylonjs/core/Morph/morphTarget.js";
import { MorphTargetManager } from "@babylonjs/core/Morph/morphTargetManager.js";
import { Scene } from "@babylonjs/core/scene.js";
import { LuthierBake } from "luthier-babylon";
import { ballScene } from "./ball.js";
import { ball, driver, exposure, open, png, run } from "./page.js";

const SIZE = 256;
const SCENES = { lights, moved, set };

run(async ({ renderer, scene: name, ...rest }) => {
  const engine = await open(renderer, SIZE);
  const { picture, figures } = name === "balls" ? await balls(engine, rest) : await linear(engine, SCENES[name], rest);
  return { picture, figures, driver: driver(engine) };
});

/** A picture of each ball of a list. The bakes are in the folder of the description. */
async function balls(engine, { list }) {
  const figures = {};
  for (const { name, bake, ...description } of list) {
    const scene = await ballScene(engine, `scene/${bake}`, description);
    figures[name] = png(await exposure(scene, SIZE)());
    scene.dispose();
  }
  return { picture: Object.values(figures)[0], figures };
}

/** A scene whose colours stay linear, and without a bound. */
async function linear(engine, draw, description) {
  const scene = new Scene(engine);
  scene.clearColor = new Color4(0, 0, 0, 1);
  Object.assign(scene.imageProcessingConfiguration, { applyByPostProcess: true, skipFinalColorClamp: true });
  const bake = await LuthierBake.LoadAsync("bake/manifest.json", scene);
  const { pixels, figures } = await draw(scene, bake, description);
  return { picture: png(toned(pixels)), figures };
}

/** A ball over a floor under a lamp of each kind. Every lamp alone, all together, and each without its shadow. */
async function lights(scene, bake, { material, floor }) {
  const sphere = ball(scene, 96, 48);
  sphere.scaling.setAll(0.6);
  sphere.position.y = 0.9;
  const ground = CreateGround("floor", { width: 6, height: 6 }, scene);
  [[sphere, material], [ground, floor]].forEach(([mesh, name]) => {
    // The falloff of glTF: spots have an edge.
    mesh.material = Object.assign(bake.material(name), { usePhysicalLightFalloff: false, useGLTFLightFalloff: true });
    mesh.receiveShadows = true;
  });
  const place = new Vector3(0.3, 3.5, -1);
  const lamps = {
    directional: new DirectionalLight("directional", new Vector3(2, -3, 1), scene),
    point: new PointLight("point", new Vector3(2, 3, -1.5), scene),
    spot: new SpotLight("spot", place, place.scale(-1), 0.7, 0, scene),
    // At the place of the spot, without a cone.
    bare: new PointLight("bare", place, scene),
  };
  Object.assign(lamps.directional, { intensity: 3, position: new Vector3(-2, 3, -1) });
  Object.assign(lamps.point, { intensity: 30 });
  Object.assign(lamps.spot, { intensity: 40, innerAngle: 0.69 });
  Object.assign(lamps.bare, { intensity: 40 });
  const shadows = Object.values(lamps).map((lamp) => {
    Object.assign(lamp, { shadowMinZ: 0.5, shadowMaxZ: 10, metadata: lamp.intensity });
    const generator = new ShadowGenerator(512, lamp);
    generator.addShadowCaster(sphere);
    Object.assign(generator, { bias: 0.005, normalBias: 0.02 });
    return generator;
  });
  const camera = new FreeCamera("camera", new Vector3(0, 3, -5), scene);
  camera.setTarget(new Vector3(0, 0.5, 0));
  camera.fov = (40 * Math.PI) / 180;
  const shoot = exposure(scene, SIZE, true);
  /** The picture of some lamps; a lamp that is out stays in the program. */
  const lit = (names, darkness = 0) => {
    for (const [name, lamp] of Object.entries(lamps)) lamp.intensity = names.includes(name) ? lamp.metadata : 0;
    for (const generator of shadows) generator.setDarkness(darkness);
    return shoot();
  };

  const kinds = ["directional", "point", "spot"];
  const all = await lit(kinds);
  const alone = {};
  const figures = { lit: {}, shadowed: {} };
  for (const kind of kinds) {
    alone[kind] = await lit([kind]);
    const bright = await lit([kind], 1);
    figures.lit[kind] = count(bright, (_, i) => bright[i] > 1e-3);
    // A shadow takes the whole light of the lamp.
    figures.shadowed[kind] = count(bright, (_, i) => bright[i] > 1e-3 && alone[kind][i] === 0);
  }
  const most = all.reduce((most, value, i) => (i % 4 < 3 ? Math.max(most, value) : most), 0);
  figures.sum_off = all.reduce((off, value, i) => (i % 4 < 3 ? Math.max(off, Math.abs(value - kinds.reduce((sum, kind) => sum + alone[kind][i], 0))) : off), 0) / most;
  // Well within the cone a spot is a lamp without one.
  const [spot, bare] = [await lit(["spot"], 1), await lit(["bare"], 1)];
  const inside = count(bare, (value, i) => value > 1e-3 && Math.abs(spot[i] / value - 1) < 1e-3);
  Object.assign(figures, { inside_of_cone: inside, outside_of_cone: count(bare, (value, i) => value > 1e-3 && spot[i] === 0) });
  figures.programs = programs(scene);
  // Thick fog is all that is seen; it needs another program.
  Object.assign(scene, { fogMode: Scene.FOGMODE_LINEAR, fogStart: 0.1, fogEnd: 0.2, fogColor: new Color3(0.2, 0.3, 0.4).toGammaSpace(true) });
  const fog = await lit(kinds);
  figures.fog_off = all.reduce((off, value, i) => (i % 4 === 0 && value > 0 ? Math.max(off, ...[0.2, 0.3, 0.4].map((c, k) => Math.abs(fog[i + k] - c))) : off), 0);
  return { pixels: all, figures };
}

/** Balls that instances, a bone and a morph target move, against balls at the same places. */
async function moved(scene, bake) {
  new DirectionalLight("lamp", new Vector3(-1, -2, 3), scene).intensity = 3;
  orthographic(scene, 1.5);
  const shoot = exposure(scene, SIZE, true);
  const material = bake.material("red-lacquer");
  const small = () => {
    const mesh = ball(scene, 48, 24);
    mesh.bakeTransformIntoVertices(Matrix.Scaling(0.45, 0.45, 0.45));
    mesh.material = material.clone("small");
    return mesh;
  };

  const whole = small();
  whole.position.set(-1, 0.5, 0);
  whole.createInstance("instance").position.set(0, 0.5, 0);
  const thin = small();
  thin.thinInstanceAdd(Matrix.Translation(1, 0.5, 0));
  const skinned = small();
  const vertices = skinned.getTotalVertices();
  skinned.setVerticesData("matricesIndices", new Float32Array(4 * vertices));
  skinned.setVerticesData("matricesWeights", Float32Array.from({ length: 4 * vertices }, (_, i) => Number(i % 4 === 0)));
  skinned.skeleton = new Skeleton("skeleton", "skeleton", scene);
  new Bone("bone", skinned.skeleton, null, Matrix.Identity()).position = new Vector3(-0.5, -0.5, 0);
  const morphed = small();
  const target = new MorphTarget("target", 1, scene);
  target.setPositions(morphed.getVerticesData("position").map((value, i) => value + [0.5, -0.5, 0][i % 3]));
  target.setNormals(morphed.getVerticesData("normal"));
  morphed.morphTargetManager = new MorphTargetManager(scene);
  morphed.morphTargetManager.addTarget(target);
  for (const mesh of [thin, skinned, morphed]) mesh.alwaysSelectAsActiveMesh = true;
  const pixels = await shoot();

  for (const mesh of [...scene.meshes]) mesh.dispose();
  for (const [x, y] of [[-1, 0.5], [0, 0.5], [1, 0.5], [-0.5, -0.5], [0.5, -0.5]]) small().position.set(x, y, 0);
  const meshes = await shoot();
  const off = pixels.reduce((off, value, i) => Math.max(off, Math.abs(value - meshes[i])), 0);
  return { pixels, figures: { off, lit: count(meshes, (value) => value > 1e-3) } };
}

/** A part for each material of the bake. */
async function set(scene, bake) {
  const size = 512;
  const columns = Math.ceil(Math.sqrt(bake.names.length));
  bake.names.forEach((name, i) => {
    const mesh = ball(scene, 48, 24);
    mesh.scaling.setAll(0.48);
    mesh.position.set((i % columns) - (columns - 1) / 2, (columns - 1) / 2 - Math.floor(i / columns), 0);
    mesh.material = bake.material(name);
  });
  new DirectionalLight("lamp", new Vector3(-1, -2, 3), scene).intensity = 3;
  orthographic(scene, columns / 2);
  const shoot = exposure(scene, size, true);
  const start = performance.now();
  let pixels = await shoot();
  const first = performance.now() - start;
  const frames = 10;
  const again = performance.now();
  for (let i = 0; i < frames; i++) {
    for (const mesh of scene.meshes) mesh.rotation.y = 0.01 * i;
    pixels = await shoot();
  }
  const frame = (performance.now() - again) / frames;
  return { pixels, figures: { materials: bake.names.length, programs: programs(scene), first_ms: Math.round(first), frame_ms: Math.round(frame) } };
}

function orthographic(scene, half) {
  const camera = new FreeCamera("camera", new Vector3(0, 0, -10), scene);
  camera.mode = Camera.ORTHOGRAPHIC_CAMERA;
  Object.assign(camera, { orthoLeft: -half, orthoRight: half, orthoTop: half, orthoBottom: -half, minZ: 0.1, maxZ: 20 });
}

/** Programs that shade the meshes of a scene. */
const programs = (scene) => new Set(scene.meshes.flatMap(({ subMeshes }) => subMeshes.map(({ effect }) => effect))).size;

/** Pixels whose red counts. */
const count = (pixels, counts) => pixels.reduce((sum, value, i) => sum + (i % 4 === 0 && counts(value, i)), 0);

const toned = (pixels) => pixels.map((value, i) => (i % 4 === 3 ? 255 : Math.round(255 * (value > 0.0031308 ? 1.055 * Math.min(value, 1) ** (1 / 2.4) - 0.055 : 12.92 * Math.max(value, 0)))));
