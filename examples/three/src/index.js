// luthier for three.js with WebGLRenderer. For WebGPURenderer import "luthier-three/webgpu", which has the same loaders.

import { BakeLoader } from "./loader.js";
import { LuthierMaterial } from "./material.js";

export { LuthierEnvironmentLoader } from "./loader.js";
export { LuthierBake } from "./bake.js";
export { LuthierMaterial };

/** Loads a bake with a shader in GLSL ES 3.00; its materials are `LuthierMaterial`. */
export class LuthierLoader extends BakeLoader {
  target = "glsl-es300";
  Material = LuthierMaterial;
}
