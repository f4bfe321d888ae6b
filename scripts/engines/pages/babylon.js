// White furnace of Babylon.js: pixels of a grid of cosines and roughnesses, and balls.

import { Camera } from "@babylonjs/core/Cameras/camera.js";
import { TargetCamera } from "@babylonjs/core/Cameras/targetCamera.js";
import { Constants } from "@babylonjs/core/Engines/constants.js";
import { Engine } from "@babylonjs/core/Engines/engine.js";
import "@babylonjs/core/Materials/Textures/Loaders/ddsTextureLoader.js";
import "@babylonjs/core/Materials/Textures/Loaders/exrTextureLoader.js";
import "@babylonjs/core/Materials/Textures/baseTexture.polynomial.js";
import { HDRFiltering } from "@babylonjs/core/Materials/Textures/Filtering/hdrFiltering.js";
import { RawCubeTexture } from "@babylonjs/core/Materials/Textures/rawCubeTexture.js";
import { RawTexture } from "@babylonjs/core/Materials/Textures/rawTexture.js";
import { RenderTargetTexture } from "@babylonjs/core/Materials/Textures/renderTargetTexture.js";
import { Texture } from "@babylonjs/core/Materials/Textures/texture.js";
import { PBRMaterial } from "@babylonjs/core/Materials/PBR/pbrMaterial.js";
import { Color3, Color4 } from "@babylonjs/core/Maths/math.color.js";
import { Vector3 } from "@babylonjs/core/Maths/math.vector.js";
import { CreateSphere } from "@babylonjs/core/Meshes/Builders/sphereBuilder.js";
import { Mesh } from "@babylonjs/core/Meshes/mesh.js";
import { VertexData } from "@babylonjs/core/Meshes/mesh.vertexData.js";
import { CubeMapToSphericalPolynomialTools } from "@babylonjs/core/Misc/HighDynamicRange/cubemapToSphericalPolynomial.js";
import { RGBDTextureTools } from "@babylonjs/core/Misc/rgbdTextureTools.js";
import { Scene } from "@babylonjs/core/scene.js";

import { BALLS, CELL, finish, job } from "./job.js";

/** Distance of the camera in pixels: so far that all views are parallel. */
const FAR = 1e8;

const MEASURES = {
  "white metal, one bounce": { color: 1, oneBounce: true },
  "black metal, one bounce": { color: 0, oneBounce: true },
  "white metal": { color: 1 },
  "grey metal": { color: 0.5 },
  "black metal": { color: 0 },
  sheen: { color: 0, sheen: true },
};

function surface(scene, { color, oneBounce, sheen }, roughness) {
  const material = new PBRMaterial("surface", scene);
  material.albedoColor = new Color3(color, color, color);
  material.metallic = sheen ? 0 : 1;
  material.roughness = roughness;
  if (oneBounce) {
    material.brdf.useEnergyConservation = false;
    // Otherwise a metal without compensation reflects the missing energy as if it were matt.
    material.brdf.useLegacySpecularEnergyConservation = true;
  }
  if (sheen) {
    // A dielectric without a reflection of its own.
    material.metallicF0Factor = 0;
    material.sheen.isEnabled = true;
    material.sheen.roughness = roughness;
    material.sheen.albedoScaling = true;
  }
  return material;
}

/** One square for each cosine, whose normal is tilted so far from the view. */
function row(scene, cosines) {
  const data = new VertexData();
  [data.positions, data.normals, data.indices] = [[], [], []];
  cosines.forEach((cos, i) => {
    for (const [x, y] of [[0, 0], [1, 0], [1, 1], [0, 1]]) {
      data.positions.push((i + x) * CELL, y * CELL, 0);
      data.normals.push(Math.sqrt(1 - cos * cos), 0, -cos);
    }
    data.indices.push(...[0, 1, 2, 0, 2, 3].map((corner) => 4 * i + corner));
  });
  const mesh = new Mesh("row", scene);
  data.applyToMesh(mesh);
  return mesh;
}

/** A cube of the surroundings that is 1 everywhere, filtered as the engine does it. */
async function furnace(engine, scene) {
  const size = 16;
  const face = () => new Float32Array(size * size * 4).fill(1);
  const faces = Array.from({ length: 6 }, face);
  const [format, type] = [Constants.TEXTUREFORMAT_RGBA, Constants.TEXTURETYPE_FLOAT];
  const cube = new RawCubeTexture(scene, faces, size, format, type, true, false, Texture.TRILINEAR_SAMPLINGMODE);
  cube.gammaSpace = false;
  const [right, left, up, down, front, back] = faces;
  const info = { size, right, left, up, down, front, back, format, type, gammaSpace: false };
  const polynomial = CubeMapToSphericalPolynomialTools.ConvertCubeMapToSphericalPolynomial(info);
  await new HDRFiltering(engine, { quality: 64 }).prefilter(cube);
  cube.sphericalPolynomial = polynomial;
  return cube;
}

/** Waits until a texture holds its texels. */
async function ready(texture) {
  while (!texture.isReady()) await new Promise((resolve) => setTimeout(resolve, 10));
}

/** A table in place of the engine's own. */
async function replacement(scene, { url, kind, size }) {
  let texture;
  if (kind === "rgbd") {
    texture = new Texture(url, scene, { noMipmap: true, invertY: false, samplingMode: Texture.BILINEAR_SAMPLINGMODE });
    await new Promise((resolve) => texture.onLoadObservable.addOnce(resolve));
    texture.isRGBD = true;
    RGBDTextureTools.ExpandRGBDTexture(texture);
  } else if (kind === "half") {
    const texels = new Uint16Array(await (await fetch(url)).arrayBuffer());
    texture = RawTexture.CreateRGBATexture(texels, ...size, scene, false, false, Texture.BILINEAR_SAMPLINGMODE, Constants.TEXTURETYPE_HALF_FLOAT);
  } else {
    // DDS and EXR, by the engine's loaders.
    await new Promise((onLoad, reject) => {
      const onError = (message) => reject(new Error(`${url} does not load: ${message}`));
      texture = new Texture(url, scene, { noMipmap: true, invertY: false, samplingMode: Texture.BILINEAR_SAMPLINGMODE, onLoad, onError });
    });
  }
  texture.wrapU = texture.wrapV = Texture.CLAMP_ADDRESSMODE;
  await ready(texture);
  return texture;
}

await finish(async () => {
  const { cosines, roughnesses, replace } = job;
  const { size, balls, rows } = BALLS;
  const canvas = document.createElement("canvas");
  [canvas.width, canvas.height] = [size * balls.length, size * rows.length];
  const engine = new Engine(canvas, true, { preserveDrawingBuffer: true });
  const scene = new Scene(engine);
  scene.clearColor = new Color4(1, 1, 1, 1);
  if (replace) scene.environmentBRDFTexture = await replacement(scene, replace);
  scene.environmentTexture = await furnace(engine, scene);

  function camera(right, top) {
    const result = new TargetCamera("camera", new Vector3(right / 2, top / 2, -FAR), scene);
    result.setTarget(new Vector3(right / 2, top / 2, 0));
    result.mode = Camera.ORTHOGRAPHIC_CAMERA;
    [result.orthoLeft, result.orthoRight, result.orthoBottom, result.orthoTop] = [-right / 2, right / 2, -top / 2, top / 2];
    [result.minZ, result.maxZ] = [FAR / 2, FAR * 2];
    return result;
  }

  const [width, height] = [cosines.length * CELL, roughnesses.length * CELL];
  async function measure(name) {
    const options = { type: Constants.TEXTURETYPE_FLOAT, samplingMode: Texture.NEAREST_SAMPLINGMODE };
    const target = new RenderTargetTexture("target", { width, height }, scene, options);
    target.activeCamera = camera(width, height);
    target.renderList = roughnesses.map((roughness, i) => {
      const mesh = row(scene, cosines);
      mesh.position.y = i * CELL;
      mesh.material = surface(scene, MEASURES[name], roughness);
      mesh.material.backFaceCulling = false;
      return mesh;
    });
    // Linear values, which only a later pass would turn into colours of a screen.
    scene.imageProcessingConfiguration.applyByPostProcess = true;
    while (!target.isReadyForRendering()) await new Promise((resolve) => setTimeout(resolve, 20));
    target.render();
    const pixels = await target.readPixels();
    scene.imageProcessingConfiguration.applyByPostProcess = false;
    for (const mesh of target.renderList.slice()) mesh.dispose(false, true);
    target.dispose();
    const middle = CELL / 2;
    return roughnesses.map((_, y) => cosines.map((_, x) => pixels[4 * ((y * CELL + middle) * width + x * CELL + middle)]));
  }
  const values = {};
  for (const name of Object.keys(MEASURES)) values[name] = await measure(name);

  scene.activeCamera = camera(canvas.width, canvas.height);
  rows.forEach((name, y) =>
    balls.forEach((roughness, x) => {
      const ball = CreateSphere("ball", { diameter: size * 0.84, segments: 48 }, scene);
      ball.position.set((x + 0.5) * size, (rows.length - y - 0.5) * size, 0);
      ball.material = surface(scene, MEASURES[name], roughness);
    }),
  );
  await scene.whenReadyAsync();
  scene.render();
  return { values, picture: canvas.toDataURL("image/png") };
});
