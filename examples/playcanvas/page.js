// What the pages of this folder share: PlayCanvas on either device, pictures, and the answer to the server that `../browser.mjs` runs.

import * as pc from "playcanvas";

const errors = [];
const isSaved = new URLSearchParams(location.search).has("save");

/** An application on a device, "webgl2" or "webgpu", that draws when it is told to. */
export async function open(kind, size) {
  // The engine reports shaders that do not compile, and misuse, there.
  for (const level of ["error", "warn"]) {
    const say = console[level];
    console[level] = (...words) => {
      errors.push(words.map(String).join(" "));
      say(...words);
    };
  }
  const canvas = document.createElement("canvas");
  canvas.width = canvas.height = size;
  document.body.append(canvas);
  const device = await pc.createGraphicsDevice(canvas, { deviceTypes: [kind], antialias: false });
  if (device.deviceType !== kind) throw new Error(`this browser has no ${kind}`);
  if (isSaved && device.isWebGPU) {
    // Without a window WebGPU has no canvas to draw into.
    device.gpuContext = null;
    device.externalBackbuffer = new pc.Texture(device, { width: size, height: size, format: device.backBufferFormat, mipmaps: false });
  }
  const options = new pc.AppOptions();
  options.graphicsDevice = device;
  options.componentSystems = [pc.RenderComponentSystem, pc.CameraComponentSystem, pc.LightComponentSystem];
  const app = new pc.AppBase(canvas);
  app.init(options);
  app.autoRender = !isSaved;
  app.start();
  return app;
}

/** An entity of the scene with a component. */
export function add(app, component, settings, [x, y, z] = [0, 0, 0]) {
  const entity = new pc.Entity(component, app);
  entity.addComponent(component, settings);
  entity.setPosition(x, y, z);
  app.root.addChild(entity);
  return entity;
}

/** A part of the scene. */
export function mesh(app, geometry, material, place) {
  const instance = new pc.MeshInstance(pc.Mesh.fromGeometry(app.graphicsDevice, geometry), material);
  return add(app, "render", { meshInstances: [instance] }, place);
}

/** A texture of a format that a camera draws into; `shoot` draws and returns its texels from the top row down. */
export function exposure(app, camera, size, format) {
  const device = app.graphicsDevice;
  const colorBuffer = new pc.Texture(device, { width: size, height: size, format, mipmaps: false, minFilter: pc.FILTER_NEAREST, magFilter: pc.FILTER_NEAREST });
  const renderTarget = new pc.RenderTarget({ colorBuffer, depth: true });
  camera.camera.renderTarget = renderTarget;
  return async () => {
    app.render();
    const texels = await colorBuffer.read(0, 0, size, size, { renderTarget, immediate: true });
    if (device.isWebGPU) return texels;
    const rows = texels.slice();
    for (let y = 0; y < size; y++) rows.set(texels.subarray(4 * size * y, 4 * size * (y + 1)), 4 * size * (size - 1 - y));
    return rows;
  };
}

/** The camera's picture as PNG for the server; in a window the canvas has it. */
export async function show(app, camera, size) {
  return isSaved && png(await exposure(app, camera, size, pc.PIXELFORMAT_SRGBA8)());
}

/** PNG of rows of RGBA, 8 bits each. */
export function png(pixels) {
  const canvas = document.createElement("canvas");
  canvas.width = canvas.height = Math.sqrt(pixels.length / 4);
  canvas.getContext("2d").putImageData(new ImageData(new Uint8ClampedArray(pixels), canvas.width), 0, 0);
  return canvas.toDataURL("image/png");
}

/** The driver that draws. */
export function driver({ graphicsDevice: device }) {
  if (!device.isWebGPU) return device.unmaskedRenderer;
  const { vendor, architecture } = device.wgpu.adapterInfo;
  return `WebGPU, ${vendor} ${architecture}`;
}

/** Shows what `main` makes of scene.json; `?save` sends its answer to the server. */
export async function run(main) {
  const answer = await fetch("/scene.json")
    .then((response) => response.json())
    .then(main)
    .then((answer) => {
      if (errors.length) throw new Error(errors[0]);
      return answer;
    })
    .catch((error) => ({ error: String(error.stack ?? error) }));
  if (answer.error) document.body.append(answer.error);
  if (isSaved) await fetch("/save", { method: "POST", body: JSON.stringify(answer) });
}
