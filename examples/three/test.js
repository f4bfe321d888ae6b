// Scenes of test.mjs. They are drawn into textures of linear 32-bit floats, so that figures are of light.

import { car } from "./car.js";
import { driver, open, png, run } from "./page.js";

const SIZE = 256;
const SCENES = { lights, moved, driven };

run(async ({ renderer: kind, scene, ...rest }) => {
  const host = await open(kind, SIZE);
  host.bake = await new host.LuthierLoader().loadAsync("bake/manifest.json");
  const { pixels, figures } = await SCENES[scene](host, rest);
  return { picture: png(toned(pixels), Math.sqrt(pixels.length / 4)), figures, driver: driver(host.renderer) };
});

/** A ball over a floor under a lamp of each kind. Every lamp alone, all together, and each without its shadow. */
async function lights({ THREE, bake, renderer, isGpu }, { material, floor }) {
  renderer.shadowMap.enabled = true;
  const scene = new THREE.Scene();
  const ball = new THREE.Mesh(new THREE.SphereGeometry(0.6, 96, 48), bake.material(material));
  ball.position.y = 0.9;
  const ground = new THREE.Mesh(new THREE.PlaneGeometry(6, 6), bake.material(floor));
  ground.rotation.x = -Math.PI / 2;
  for (const mesh of [ball, ground]) scene.add(Object.assign(mesh, { castShadow: true, receiveShadow: true }));
  const lamps = {
    directional: new THREE.DirectionalLight(0xffffff, 3),
    point: new THREE.PointLight(0xffffff, 30),
    spot: new THREE.SpotLight(0xffffff, 40, 0, 0.35, 0),
    // At the place of the spot, without a cone.
    bare: new THREE.PointLight(0xffffff, 40),
  };
  lamps.directional.position.set(-2, 3, 1);
  Object.assign(lamps.directional.shadow.camera, { left: -4, right: 4, top: 4, bottom: -4, near: 0.5, far: 10 });
  lamps.point.position.set(2, 3, 1.5);
  for (const name of ["spot", "bare"]) lamps[name].position.set(0.3, 3.5, 1);
  for (const lamp of Object.values(lamps)) {
    lamp.castShadow = true;
    lamp.shadow.mapSize.set(1024, 1024);
    lamp.shadow.normalBias = 0.02;
    lamp.userData.intensity = lamp.intensity;
    scene.add(lamp);
  }
  const camera = new THREE.PerspectiveCamera(40, 1, 0.1, 20);
  camera.position.set(0, 3, 5);
  camera.lookAt(0, 0.5, 0);
  const shoot = exposure(THREE, renderer, isGpu, scene, camera, SIZE);
  /** The picture of some lamps; a lamp that is out stays in the program. */
  const lit = (names, shadow = 1) => {
    for (const [name, lamp] of Object.entries(lamps)) {
      lamp.intensity = names.includes(name) ? lamp.userData.intensity : 0;
      lamp.shadow.intensity = shadow;
    }
    return shoot();
  };

  const kinds = ["directional", "point", "spot"];
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
  const most = all.reduce((most, value, i) => (i % 4 < 3 ? Math.max(most, value) : most), 0);
  figures.sum_off = all.reduce((off, value, i) => (i % 4 < 3 ? Math.max(off, Math.abs(value - kinds.reduce((sum, kind) => sum + alone[kind][i], 0))) : off), 0) / most;
  // Within the cone a spot is a lamp without one.
  const [spot, bare] = [await lit(["spot"], 0), await lit(["bare"], 0)];
  figures.spot_off = spot.reduce((off, value, i) => (i % 4 < 3 && value > 0 ? Math.max(off, Math.abs(value - bare[i]) / bare[i]) : off), 0);
  figures.outside_of_cone = count(bare, (_, i) => bare[i] > 1e-3 && spot[i] === 0);
  figures.programs = programs(renderer);
  // Thick fog is all that is seen; it needs another program.
  scene.fog = new THREE.Fog(new THREE.Color(0.2, 0.3, 0.4), 0.1, 0.2);
  for (const mesh of [ball, ground]) mesh.material = mesh.material.clone();
  const fog = await lit(kinds);
  figures.fog_off = all.reduce((off, value, i) => (i % 4 === 0 && value > 0 ? Math.max(off, ...[0.2, 0.3, 0.4].map((c, k) => Math.abs(fog[i + k] - c))) : off), 0);
  return { pixels: all, figures };
}

/** Balls that instances, a bone and a morph target move, against balls at the same places. */
async function moved({ THREE, bake, renderer, isGpu }) {
  const scene = new THREE.Scene();
  const lamp = new THREE.DirectionalLight(0xffffff, 3);
  lamp.position.set(1, 2, 3);
  scene.add(lamp);
  const camera = new THREE.OrthographicCamera(-1.5, 1.5, 1.5, -1.5, 0.1, 20);
  camera.position.z = 10;
  const shoot = exposure(THREE, renderer, isGpu, scene, camera, SIZE);
  const material = bake.material("red-lacquer");
  const ball = new THREE.SphereGeometry(0.45, 48, 24);
  const { count: vertices } = ball.attributes.position;
  const matrix = (x, y) => new THREE.Matrix4().makeTranslation(x, y, 0);

  const instances = new THREE.InstancedMesh(ball, material, 3);
  for (const i of [0, 1, 2]) instances.setMatrixAt(i, matrix(i - 1, 0.5));
  const skinned = new THREE.SkinnedMesh(ball.clone(), material);
  skinned.geometry.setAttribute("skinIndex", new THREE.Uint16BufferAttribute(new Uint16Array(4 * vertices), 4));
  skinned.geometry.setAttribute("skinWeight", new THREE.Float32BufferAttribute(Float32Array.from({ length: 4 * vertices }, (_, i) => Number(i % 4 === 0)), 4));
  const bone = new THREE.Bone();
  skinned.add(bone);
  skinned.bind(new THREE.Skeleton([bone]));
  bone.position.set(-0.5, -0.5, 0);
  const morphed = new THREE.Mesh(ball.clone(), material);
  morphed.geometry.morphAttributes.position = [ball.attributes.position.clone().applyMatrix4(matrix(0.5, -0.5))];
  morphed.updateMorphTargets();
  morphed.morphTargetInfluences[0] = 1;
  scene.add(instances, skinned, morphed);
  const pixels = await shoot();

  scene.remove(instances, skinned, morphed);
  for (const [x, y] of [[-1, 0.5], [0, 0.5], [1, 0.5], [-0.5, -0.5], [0.5, -0.5]]) {
    const mesh = new THREE.Mesh(ball, material);
    mesh.applyMatrix4(matrix(x, y));
    scene.add(mesh);
  }
  const meshes = await shoot();
  const off = pixels.reduce((off, value, i) => Math.max(off, Math.abs(value - meshes[i])), 0);
  return { pixels, figures: { off, lit: count(meshes, (value) => value > 1e-3) } };
}

/** A car, each part of which has a material of its own. */
async function driven({ THREE, bake, renderer, isGpu }) {
  const size = 512;
  renderer.setSize(size, size);
  const scene = new THREE.Scene();
  const body = new THREE.Group();
  const { large, small } = car(THREE);
  const plain = bake.names.filter((name) => !(name in large));
  const parts = [...Object.entries(large), ...small.map((geometry, i) => [plain[i], geometry])];
  for (const [name, geometry] of parts) body.add(new THREE.Mesh(geometry, bake.material(name)));
  scene.add(body);
  for (const [color, ...at] of [[0xffffff, 1, 3, 3], [0x88aaff, 4, 2, -1]]) {
    const lamp = new THREE.DirectionalLight(color, 3);
    lamp.position.set(...at);
    scene.add(lamp);
  }
  const camera = new THREE.PerspectiveCamera(27, 1, 0.1, 40);
  camera.position.set(6.5, 3.5, 8.5);
  camera.lookAt(0.2, 0.7, 0);
  const shoot = exposure(THREE, renderer, isGpu, scene, camera, size);
  const start = performance.now();
  let pixels = await shoot();
  const first = performance.now() - start;
  const frames = 10;
  const again = performance.now();
  for (let i = 0; i < frames; i++) {
    body.rotation.y = 0.01 * i;
    pixels = await shoot();
  }
  const frame = (performance.now() - again) / frames;
  return { pixels, figures: { parts: new Set(parts.map(([name]) => name)).size, lit: count(pixels, (value) => value > 1e-3), programs: programs(renderer), first_ms: Math.round(first), frame_ms: Math.round(frame) } };
}

/** A function that draws, and returns linear RGBA from the top row down. */
function exposure(THREE, renderer, isGpu, scene, camera, size) {
  const target = new (isGpu ? THREE.RenderTarget : THREE.WebGLRenderTarget)(size, size, { type: THREE.FloatType });
  return async () => {
    renderer.setRenderTarget(target);
    renderer.render(scene, camera);
    if (isGpu) return renderer.readRenderTargetPixelsAsync(target, 0, 0, size, size);
    const rows = new Float32Array(4 * size * size);
    renderer.readRenderTargetPixels(target, 0, 0, size, size, rows);
    const pixels = new Float32Array(rows.length);
    for (let y = 0; y < size; y++) pixels.set(rows.subarray(4 * size * y, 4 * size * (y + 1)), 4 * size * (size - 1 - y));
    return pixels;
  };
}

/** Programs that shade with materials of the bake. */
function programs({ info, isWebGPURenderer }) {
  // There each stage is a program.
  return isWebGPURenderer ? info.memory.programs / 2 : info.programs.filter(({ type }) => type === "LuthierMaterial").length;
}

/** Pixels whose red counts. */
const count = (pixels, counts) => pixels.reduce((sum, value, i) => sum + (i % 4 === 0 && counts(value, i)), 0);

const toned = (pixels) => pixels.map((value, i) => (i % 4 === 3 ? 255 : Math.round(255 * (value > 0.0031308 ? 1.055 * Math.min(value, 1) ** (1 / 2.4) - 0.055 : 12.92 * Math.max(value, 0)))));
