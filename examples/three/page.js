// What the pages of this folder share: a renderer of three.js with the package for it, and the answer to the server that `../browser.mjs` runs.

/** A renderer of either kind, "webgl" or "webgpu", of a square picture; three.js and luthier-three for it. */
export async function open(kind, size) {
  const isGpu = kind === "webgpu";
  const THREE = await import(isGpu ? "three/webgpu" : "three");
  const luthier = await import(isGpu ? "luthier-three/webgpu" : "luthier-three");
  const renderer = isGpu ? new THREE.WebGPURenderer({ forceWebGL: false }) : new THREE.WebGLRenderer();
  renderer.setPixelRatio(1);
  renderer.setSize(size, size);
  document.body.append(renderer.domElement);
  if (isGpu) {
    await renderer.init();
    if (!renderer.backend.isWebGPUBackend) throw new Error("this browser has no WebGPU");
    renderer.backend.device.addEventListener("uncapturederror", ({ error }) => errors.push(error.message));
  } else {
    renderer.debug.onShaderError = (gl, program, vertex, fragment) => {
      throw new Error(`${gl.getProgramInfoLog(program)} ${gl.getShaderInfoLog(vertex)} ${gl.getShaderInfoLog(fragment)}`);
    };
  }
  return { THREE, ...luthier, renderer, isGpu };
}

const errors = [];
const isSaved = new URLSearchParams(location.search).has("save");

/** Draws into the canvas, and for the server as PNG. */
export async function show(renderer, scene, camera) {
  const { width, height } = renderer.domElement;
  if (!isSaved || !renderer.isWebGPURenderer) {
    renderer.render(scene, camera);
    // In the task of the drawing: later the canvas may be empty.
    return isSaved && renderer.domElement.toDataURL("image/png");
  }
  // Without a window WebGPU has no canvas to draw into: what would be in it is drawn into a texture.
  const { RenderTarget } = await import("three/webgpu");
  const target = new RenderTarget(width, height);
  renderer.setOutputRenderTarget(target);
  renderer.render(scene, camera);
  const pixels = await renderer.readRenderTargetPixelsAsync(target, 0, 0, width, height);
  renderer.setOutputRenderTarget(null);
  return png(pixels, width);
}

/** PNG of rows of RGBA, 8 bits each. */
export function png(pixels, width) {
  const canvas = document.createElement("canvas");
  canvas.width = width;
  canvas.height = pixels.length / 4 / width;
  canvas.getContext("2d").putImageData(new ImageData(new Uint8ClampedArray(pixels), width), 0, 0);
  return canvas.toDataURL("image/png");
}

/** The driver that draws. */
export function driver(renderer) {
  if (renderer.isWebGPURenderer) {
    const { vendor, architecture } = renderer.backend.device.adapterInfo;
    return `WebGPU, ${vendor} ${architecture}`;
  }
  const gl = renderer.getContext();
  const info = gl.getExtension("WEBGL_debug_renderer_info");
  return gl.getParameter(info ? info.UNMASKED_RENDERER_WEBGL : gl.RENDERER);
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
  if (answer.error) console.error(answer.error);
  if (isSaved) await fetch("/save", { method: "POST", body: JSON.stringify(answer) });
}
