// Scenes of test.mjs. They are drawn into textures of linear 32-bit floats, so that figures are of light.

import * as pc from "playcanvas";
import { LuthierHandler } from "luthier-playcanvas";
import { add, driver, exposure, mesh, open, png, run } from "./page.js";

const SIZE = 256;
const SCENES = { lights, units, moved, set };

run(async ({ device: kind, scene, ...rest }) => {
  const app = await open(kind, rest.size ?? SIZE);
  const bake = await asset(app, "bake/manifest.json");
  const { pixels, figures } = await SCENES[scene](app, bake, rest);
  return { picture: png(toned(pixels)), figures, driver: driver(app) };
});

/** A bake that is an asset. */
function asset(app, url) {
  app.loader.addHandler("luthier", new LuthierHandler(app));
  const asset = new pc.Asset("bake", "luthier", { url });
  app.assets.add(asset);
  return new Promise((resolve, reject) => {
    asset.once("error", reject);
    asset.ready(({ resource }) => resolve(resource));
    app.assets.load(asset);
  });
}

const LINEAR = { toneMapping: pc.TONEMAP_NONE, gammaCorrection: pc.GAMMA_NONE, clearColor: pc.Color.BLACK };

/** A ball over a floor under a lamp of each kind. Every lamp alone, all together, and each without its shadow. */
async function lights(app, bake, { material, floor, clustered }) {
  app.scene.clusteredLightingEnabled = clustered;
  app.scene.ambientLight = pc.Color.BLACK;
  const parts = [
    mesh(app, new pc.SphereGeometry({ radius: 0.6, latitudeBands: 48, longitudeBands: 96 }), bake.material(material), [0, 0.9, 0]),
    mesh(app, new pc.PlaneGeometry({ halfExtents: new pc.Vec2(3, 3) }), bake.material(floor)),
  ];
  const shadow = { castShadows: true, shadowResolution: 1024, shadowDistance: 12, shadowBias: 0.1, normalOffsetBias: 0.05, range: 20 };
  const cone = { innerConeAngle: 20, outerConeAngle: 20.01 };
  const lamps = {
    directional: add(app, "light", { type: "directional", intensity: 1, ...shadow }),
    omni: add(app, "light", { type: "omni", intensity: 1, ...shadow }, [2, 3, 1.5]),
    spot: add(app, "light", { type: "spot", intensity: 1, ...cone, ...shadow }, [0.3, 3.5, 1]),
    // At the place of the spot, without a cone.
    bare: add(app, "light", { type: "omni", intensity: 1, ...shadow }, [0.3, 3.5, 1]),
  };
  lamps.directional.setRotation(new pc.Quat().setFromDirections(pc.Vec3.UP, new pc.Vec3(-2, 3, 1).normalize()));
  lamps.spot.setRotation(new pc.Quat().setFromDirections(pc.Vec3.UP, new pc.Vec3(0.1, 1, 0.3).normalize()));
  const camera = add(app, "camera", { ...LINEAR, fov: 40, nearClip: 0.1, farClip: 20 }, [0, 3, 5]);
  camera.lookAt(0, 0.5, 0);
  const shoot = exposure(app, camera, SIZE, pc.PIXELFORMAT_RGBA32F);
  /** The picture of some lamps; a lamp that is out stays in the program. */
  const lit = (names, shadowIntensity = 1) => {
    for (const [name, { light }] of Object.entries(lamps)) Object.assign(light, { intensity: Number(names.includes(name)), shadowIntensity });
    return shoot();
  };

  const kinds = ["directional", "omni", "spot"];
  const all = await lit(kinds);
  const alone = {};
  const figures = { lit: {}, shadowed: {} };
  for (const kind of kinds) {
    alone[kind] = await lit([kind]);
    const bright = await lit([kind], 0);
    figures.lit[kind] = count(bright, (_, i) => bright[i] > 1e-3);
    // A shadow takes the whole light of the lamp.
    figures.shadowed[kind] = count(bright, (_, i) => bright[i] > 1e-3 && alone[kind][i] === 0);
  }
  const colors = (fold) => all.reduce((most, value, i) => (i % 4 < 3 ? Math.max(most, fold(value, i)) : most), 0);
  figures.sum_off = colors((value, i) => Math.abs(value - kinds.reduce((sum, kind) => sum + alone[kind][i], 0))) / colors((value) => value);
  // Within the cone, without its rim, a spot is a lamp without one.
  const [spot, bare] = [await lit(["spot"], 0), await lit(["bare"], 0)];
  const within = spot.map((value, i) => Math.abs(value - bare[i]) / bare[i]).filter((_, i) => i % 4 === 0 && spot[i] > 0).sort();
  figures.spot_off = within[Math.floor(0.95 * within.length)];
  figures.outside_of_cone = count(bare, (_, i) => bare[i] > 1e-3 && spot[i] === 0);
  figures.programs = programs(app);
  // Thick fog is all that is seen; it needs another program.
  const color = [0.2, 0.3, 0.4];
  Object.assign(app.scene.fog, { type: pc.FOG_LINEAR, color: new pc.Color(...color).gamma(), start: 0.1, end: 0.2 });
  for (const { render } of parts) for (const instance of render.meshInstances) instance.material = instance.material.clone();
  const fog = await lit(kinds);
  figures.fog_off = colors((_, i) => (i % 4 === 0 && all[i] > 0 ? Math.max(...color.map((c, k) => Math.abs(fog[i + k] - c))) : 0));
  return { pixels: all, figures };
}

/** Balls of white chalk, of the bake and of PlayCanvas, under lamps and ambient light: both units are the same. */
async function units(app, bake, { albedo }) {
  app.scene.ambientLight = new pc.Color(0.3, 0.2, 0.1).gamma();
  const own = new pc.StandardMaterial();
  own.diffuse = new pc.Color(albedo, albedo, albedo).gamma();
  own.specular = pc.Color.BLACK;
  own.update();
  const chalk = bake.material("chalk");
  const { render } = mesh(app, new pc.SphereGeometry({ radius: 1, latitudeBands: 48, longitudeBands: 96 }), chalk);
  add(app, "light", { type: "omni", intensity: 1, range: 20 }, [2, 1, 3]);
  add(app, "light", { type: "directional", intensity: 1 }).setEulerAngles(40, 30, 0);
  const camera = add(app, "camera", { ...LINEAR, fov: 30 }, [0, 0, 5]);
  const shoot = exposure(app, camera, SIZE, pc.PIXELFORMAT_RGBA32F);
  const pixels = await shoot();
  render.meshInstances[0].material = own;
  const theirs = await shoot();
  // On the silhouette the package turns normals to the eye.
  const lit = theirs.filter((value, i) => i % 4 < 3 && value > 0);
  const off = pixels.map((value, i) => Math.abs(value - theirs[i])).filter((_, i) => i % 4 < 3 && theirs[i] > 0).sort()[Math.floor(0.99 * lit.length)];
  return { pixels, figures: { off, largest: theirs.reduce((most, value, i) => (i % 4 < 3 ? Math.max(most, value) : most), 0) } };
}

/** Balls that instances, a bone and a morph target move, against balls at the same places. */
async function moved(app, bake) {
  const device = app.graphicsDevice;
  app.scene.ambientLight = pc.Color.BLACK;
  const lamp = add(app, "light", { type: "directional", intensity: 1 });
  lamp.setRotation(new pc.Quat().setFromDirections(pc.Vec3.UP, new pc.Vec3(1, 2, 3).normalize()));
  const camera = add(app, "camera", { ...LINEAR, projection: pc.PROJECTION_ORTHOGRAPHIC, orthoHeight: 1.5, nearClip: 0.1, farClip: 20 }, [0, 0, 10]);
  const shoot = exposure(app, camera, SIZE, pc.PIXELFORMAT_RGBA32F);
  const ball = () => new pc.SphereGeometry({ radius: 0.45, latitudeBands: 24, longitudeBands: 48 });
  const material = bake.material("red-lacquer");
  const part = (geometry, place) => {
    const entity = mesh(app, geometry, material, place);
    const [instance] = entity.render.meshInstances;
    instance.cull = false;
    return { entity, instance };
  };

  const instances = part(ball());
  const matrices = new Float32Array([-1, 0, 1].flatMap((x) => [...new pc.Mat4().setTranslate(x, 0.5, 0).data]));
  instances.instance.setInstancing(new pc.VertexBuffer(device, pc.VertexFormat.getDefaultInstancingFormat(device), 3, { data: matrices.buffer }));
  const bent = ball();
  const vertices = bent.positions.length / 3;
  bent.blendIndices = Array(4 * vertices).fill(0);
  bent.blendWeights = Array.from({ length: 4 * vertices }, (_, i) => Number(i % 4 === 0));
  const skinned = part(bent);
  const bone = new pc.Entity("bone", app);
  bone.setPosition(-0.5, -0.5, 0);
  app.root.addChild(bone);
  const skin = new pc.SkinInstance(new pc.Skin(device, [new pc.Mat4()], ["bone"]));
  skin.bones = [bone];
  skinned.instance.skinInstance = skin;
  const morphed = part(ball());
  const deltaPositions = Float32Array.from({ length: 3 * vertices }, (_, i) => [0.5, -0.5, 0][i % 3]);
  const morph = new pc.Morph([new pc.MorphTarget({ deltaPositions })], device);
  morphed.instance.mesh.morph = morph;
  morphed.instance.morphInstance = new pc.MorphInstance(morph);
  morphed.instance.morphInstance.setWeight(0, 1);
  const pixels = await shoot();

  for (const { entity } of [instances, skinned, morphed]) entity.destroy();
  for (const [x, y] of [[-1, 0.5], [0, 0.5], [1, 0.5], [-0.5, -0.5], [0.5, -0.5]]) part(ball(), [x, y, 0]);
  const meshes = await shoot();
  const off = pixels.reduce((off, value, i) => Math.max(off, Math.abs(value - meshes[i])), 0);
  return { pixels, figures: { off, lit: count(meshes, (value) => value > 1e-3) } };
}

/** A part for each material of the bake. */
async function set(app, bake, { size }) {
  app.scene.ambientLight = pc.Color.BLACK;
  const columns = Math.ceil(Math.sqrt(bake.names.length));
  const geometry = new pc.SphereGeometry({ radius: 0.48, latitudeBands: 24, longitudeBands: 48 });
  const parts = bake.names.map((name, i) => mesh(app, geometry, bake.material(name), [(i % columns) - (columns - 1) / 2, (columns - 1) / 2 - Math.floor(i / columns), 0]));
  const lamp = add(app, "light", { type: "directional", intensity: 1 });
  lamp.setRotation(new pc.Quat().setFromDirections(pc.Vec3.UP, new pc.Vec3(1, 2, 3).normalize()));
  const camera = add(app, "camera", { ...LINEAR, projection: pc.PROJECTION_ORTHOGRAPHIC, orthoHeight: columns / 2, nearClip: 0.1, farClip: 20 }, [0, 0, 10]);
  const shoot = exposure(app, camera, size, pc.PIXELFORMAT_RGBA32F);
  const start = performance.now();
  let pixels = await shoot();
  const first = performance.now() - start;
  const frames = 3;
  const again = performance.now();
  for (let i = 0; i < frames; i++) {
    for (const part of parts) part.setEulerAngles(0, i, 0);
    pixels = await shoot();
  }
  const frame = (performance.now() - again) / frames;
  return { pixels, figures: { materials: bake.names.length, programs: programs(app), first_ms: Math.round(first), frame_ms: Math.round(frame) } };
}

/** Programs that shade with materials of a bake. */
const programs = ({ graphicsDevice: { shaders } }) => shaders.filter(({ definition }) => definition.fshader.includes("luthier_prepare_at")).length;

/** Pixels whose red counts. */
const count = (pixels, counts) => pixels.reduce((sum, value, i) => sum + (i % 4 === 0 && counts(value, i)), 0);

const toned = (pixels) => pixels.map((value, i) => (i % 4 === 3 ? 255 : Math.round(255 * (value > 0.0031308 ? 1.055 * Math.min(value, 1) ** (1 / 2.4) - 0.055 : 12.92 * Math.max(value, 0)))));
