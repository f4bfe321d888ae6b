// What the pages of this folder share: an engine and a scene, meshes, pictures, and the answer to the server that `../browser.mjs` runs.

import { Mesh } from "@babylonjs/core/Meshes/mesh.js";
import { VertexData } from "@babylonjs/core/Meshes/mesh.vertexData.js";
import { Constants } from "@babylonjs/core/Engines/constants.js";
import { RenderTargetTexture } from "@babylonjs/core/Materials/Textures/renderTargetTexture.js";

const errors = [];
const isSaved = new URLSearchParams(location.search).has("save");

/** An engine of either kind, "webgl" or "webgpu", with a square canvas. */
export async function open(kind, size) {
  const canvas = document.createElement("canvas");
  canvas.width = canvas.height = size;
  document.body.append(canvas);
  // Colours of pictures are sRGB to the bit.
  const settings = { useExactSrgbConversions: true, antialias: false, adaptToDeviceRatio: false };
  let engine;
  if (kind === "webgpu") {
    const { WebGPUEngine } = await import("@babylonjs/core/Engines/webgpuEngine.js");
    if (!(await WebGPUEngine.IsSupportedAsync)) throw new Error("this browser has no WebGPU");
    if (isSaved) canvas.getContext = () => textureContext(size);
    engine = new WebGPUEngine(canvas, settings);
    await engine.initAsync();
    engine._device.lost.then(({ reason, message }) => errors.push(`the device is lost: ${reason} ${message}`));
    engine._device.addEventListener("uncapturederror", ({ error }) => errors.push(error.message));
  } else {
    const { Engine } = await import("@babylonjs/core/Engines/engine.js");
    engine = new Engine(canvas, false, { ...settings, preserveDrawingBuffer: true });
  }
  return engine;
}

/** Without a window WebGPU has no canvas to draw into. A texture stands for it. */
function textureContext(size) {
  let texture;
  return {
    configure: ({ device, format, usage }) => (texture = device.createTexture({ size: [size, size], format, usage })),
    getCurrentTexture: () => texture,
  };
}

/**
 * A ball of radius 1 in the frame of `luthier preview --shape sphere`, mirrored where the scene is left-handed. Texture coordinates begin at the top, behind.
 */
export function ball(scene, columns = 128, rows = 64) {
  const flip = scene.useRightHandedSystem ? 1 : -1;
  const [positions, uvs, indices] = [[], [], []];
  for (let row = 0; row <= rows; row++) {
    for (let column = 0; column <= columns; column++) {
      const [u, v] = [column / columns, row / rows];
      const [phi, theta] = [2 * Math.PI * u, Math.PI * v];
      positions.push(-Math.cos(phi) * Math.sin(theta), Math.cos(theta), flip * Math.sin(phi) * Math.sin(theta));
      uvs.push(u + 0.25, v);
      if (row === rows || column === columns) continue;
      const [a, b, c, d] = [0, 1, columns + 1, columns + 2].map((step) => row * (columns + 1) + column + step);
      // Faces of right-handed scenes turn the other way.
      indices.push(...(flip < 0 ? [b, a, c, b, c, d] : [a, b, c, c, b, d]));
    }
  }
  const data = Object.assign(new VertexData(), { positions, indices, uvs, normals: [...positions] });
  const mesh = new Mesh("ball", scene);
  data.applyToMesh(mesh, true);
  return mesh;
}

/** A point or direction of a right-handed frame in the scene's. */
export const placed = (scene, [x, y, z]) => [x, y, scene.useRightHandedSystem ? z : -z];

/** A function that draws into a texture, and returns RGBA from the top row down: 32-bit floats, or bytes. */
export function exposure(scene, size, isFloat) {
  const type = isFloat ? Constants.TEXTURETYPE_FLOAT : Constants.TEXTURETYPE_UNSIGNED_BYTE;
  const target = new RenderTargetTexture("picture", size, scene, { generateMipMaps: false, type, format: Constants.TEXTUREFORMAT_RGBA });
  const { activeCamera } = scene;
  activeCamera.outputRenderTarget = target;
  return async () => {
    await scene.whenReadyAsync();
    scene.render();
    const rows = await target.readPixels();
    const pixels = new rows.constructor(4 * size * size);
    for (let y = 0; y < size; y++) pixels.set(rows.subarray(4 * size * y, 4 * size * (y + 1)), 4 * size * (size - 1 - y));
    return pixels;
  };
}

/** Draws into the canvas, and for the server as PNG. */
export async function show(scene, size) {
  if (isSaved) return png(await exposure(scene, size)());
  await scene.whenReadyAsync();
  scene.render();
  return undefined;
}

/** PNG of a square of RGBA, 8 bits each. */
export function png(pixels) {
  const canvas = document.createElement("canvas");
  canvas.width = canvas.height = Math.sqrt(pixels.length / 4);
  canvas.getContext("2d").putImageData(new ImageData(Uint8ClampedArray.from(pixels, (value, i) => (i % 4 === 3 ? 255 : value)), canvas.width), 0, 0);
  return canvas.toDataURL("image/png");
}

/** The driver that draws. */
export const driver = (engine) => (engine.isWebGPU ? `WebGPU, ${engine.getInfo().vendor}` : engine.getGlInfo().renderer);

/** Shows what `main` makes of scene.json; `?save` sends its answer to the server. */
export async function run(main) {
  const answer = await fetch("/scene.json")
    .then((response) => response.json())
    .then(main)
    .then((answer) => {
      if (errors.length) throw new Error(errors[0]);
      return answer;
    })
    .catch((error) => ({ error: [...errors, error.stack ?? error].join("\n") }));
  if (answer.error) console.error(answer.error);
  if (isSaved) await fetch("/save", { method: "POST", body: JSON.stringify(answer) });
}
