// luthier for Babylon.js, with the WebGL 2 engine and the WebGPU engine.

export { LuthierBake, LuthierEnvironment } from "./bake.js";
export { LuthierMaterial } from "./material.js";
