// What the packages for browsers share. None of it knows a renderer.

export { Bake, mapKey, readBake, readEnvironment } from "./bake.js";
export { readKtx2, toHalfFloats } from "./ktx2.js";
export { glslAround } from "./glsl.js";
export { wgslAround, withOwnSamplers } from "./wgsl.js";
export { fill } from "./surface.js";
