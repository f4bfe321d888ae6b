// luthier for PlayCanvas, for the devices of WebGL 2 and WebGPU.

export { LuthierBake } from "./bake.js";
export { loadBake, loadEnvironment, LuthierHandler } from "./loader.js";
export { LuthierMaterial } from "./material.js";
