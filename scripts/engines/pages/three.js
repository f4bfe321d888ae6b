// White furnace of three.js: pixels of a grid of cosines and roughnesses, and balls. With the build that has WebGPURenderer by its nodes,
// on WebGL 2, and without the measures that need another shader.

import * as THREE from "three";

import { BALLS, CELL, finish, job } from "./job.js";

/** Cuts the light of further bounces out of the shader, which leaves f0 * scale + bias. */
function singleBounce(shader) {
  const name = "lights_physical_pars_fragment";
  const chunk = THREE.ShaderChunk[name];
  const cut = chunk.replace("multiScatter += Fms * Ems;", "");
  if (cut === chunk) throw new Error(`${name} adds further bounces otherwise than expected`);
  shader.fragmentShader = shader.fragmentShader.replace(`#include <${name}>`, cut);
}

const MEASURES = {
  "white metal, one bounce": { color: 1, onBeforeCompile: singleBounce },
  "black metal, one bounce": { color: 0, onBeforeCompile: singleBounce },
  "white metal": { color: 1 },
  "grey metal": { color: 0.5 },
  "black metal": { color: 0 },
};

const { WebGPURenderer } = THREE;

function metal({ color, onBeforeCompile }, roughness) {
  const material = new THREE.MeshStandardMaterial({ metalness: 1, roughness });
  material.color.setRGB(color, color, color);
  if (onBeforeCompile) {
    material.onBeforeCompile = onBeforeCompile;
    material.customProgramCacheKey = () => onBeforeCompile.name;
  }
  return material;
}

/** One square for each cosine, whose normal is tilted so far from the view. */
function row(cosines) {
  const [positions, normals, indices] = [[], [], []];
  cosines.forEach((cos, i) => {
    for (const [x, y] of [[0, 0], [1, 0], [1, 1], [0, 1]]) {
      positions.push((i + x) * CELL, y * CELL, 0);
      normals.push(Math.sqrt(1 - cos * cos), 0, cos);
    }
    indices.push(...[0, 1, 2, 0, 2, 3].map((corner) => 4 * i + corner));
  });
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute("position", new THREE.Float32BufferAttribute(positions, 3));
  geometry.setAttribute("normal", new THREE.Float32BufferAttribute(normals, 3));
  geometry.setIndex(indices);
  return geometry;
}

/** A map of the surroundings that is 1 everywhere; the renderer filters it itself. */
function furnace() {
  const [width, height] = [64, 32];
  const texels = new Float32Array(width * height * 4).fill(1);
  const texture = new THREE.DataTexture(texels, width, height, THREE.RGBAFormat, THREE.FloatType);
  texture.mapping = THREE.EquirectangularReflectionMapping;
  texture.magFilter = texture.minFilter = THREE.LinearFilter;
  texture.needsUpdate = true;
  return texture;
}

await finish(async () => {
  const { cosines, roughnesses, replace } = job;
  const canvas = document.createElement("canvas");
  const renderer = WebGPURenderer
    ? new WebGPURenderer({ canvas, forceWebGL: true })
    : new THREE.WebGLRenderer({ canvas, preserveDrawingBuffer: true });
  await renderer.init?.();
  const [width, height] = [cosines.length * CELL, roughnesses.length * CELL];
  const nearest = { minFilter: THREE.NearestFilter, magFilter: THREE.NearestFilter };
  const target = new (WebGPURenderer ? THREE.RenderTarget : THREE.WebGLRenderTarget)(width, height, { type: THREE.FloatType, ...nearest });
  const surroundings = furnace();
  const view = (right, top) => new THREE.OrthographicCamera(0, right, top, 0, -1000, 1000);

  function scene(meshes) {
    const result = new THREE.Scene();
    result.environment = surroundings;
    for (const { geometry, material, at } of meshes) {
      const mesh = new THREE.Mesh(geometry, material);
      mesh.position.set(...at);
      result.add(mesh);
    }
    return result;
  }

  async function measure(name) {
    const geometry = row(cosines);
    const meshes = roughnesses.map((roughness, i) => ({ geometry, material: metal(MEASURES[name], roughness), at: [0, i * CELL, 0] }));
    renderer.setRenderTarget(target);
    renderer.render(scene(meshes), view(width, height));
    const buffer = new Float32Array(width * height * 4);
    const pixels = await renderer.readRenderTargetPixelsAsync(target, 0, 0, width, height, ...(WebGPURenderer ? [] : [buffer]));
    const middle = CELL / 2;
    return roughnesses.map((_, y) => cosines.map((_, x) => pixels[4 * ((y * CELL + middle) * width + x * CELL + middle)]));
  }

  if (replace) {
    // The renderer sets the uniform at each draw to one texture of its own: that texture gets other texels.
    const material = metal({ color: 1 }, 0.5);
    renderer.setRenderTarget(target);
    renderer.render(scene([{ geometry: row(cosines), material, at: [0, 0, 0] }]), view(width, height));
    const texture = renderer.properties.get(material).uniforms.dfgLUT.value;
    const bytes = await (await fetch(replace.url)).arrayBuffer();
    texture.dispose();
    texture.image = { data: new Uint16Array(bytes), width: replace.size[0], height: replace.size[1] };
    texture.needsUpdate = true;
  }

  const isMeasured = (name) => !(WebGPURenderer && MEASURES[name].onBeforeCompile);
  const values = {};
  for (const name of Object.keys(MEASURES).filter(isMeasured)) values[name] = await measure(name);

  const { size, balls } = BALLS;
  const rows = BALLS.rows.filter(isMeasured);
  renderer.setSize(size * balls.length, size * rows.length, false);
  renderer.setRenderTarget(null);
  renderer.setClearColor(0xffffff);
  const ball = new THREE.SphereGeometry(size * 0.42, 96, 64);
  const shown = rows.flatMap((name, y) =>
    balls.map((roughness, x) => {
      const at = [(x + 0.5) * size, (rows.length - y - 0.5) * size, 0];
      return { geometry: ball, material: metal(MEASURES[name], roughness), at };
    }),
  );
  renderer.render(scene(shown), view(size * balls.length, size * rows.length));
  return { values, picture: canvas.toDataURL("image/png") };
});
