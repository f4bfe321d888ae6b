// luthier for three.js with WebGPURenderer.

import { BakeLoader } from "./loader.js";
import { LuthierNodeMaterial } from "./node-material.js";

export { LuthierEnvironmentLoader } from "./loader.js";
export { LuthierBake } from "./bake.js";
export { LuthierNodeMaterial };

/** Loads a bake with a shader in WGSL; its materials are `LuthierNodeMaterial`. */
export class LuthierLoader extends BakeLoader {
  target = "wgsl";
  Material = LuthierNodeMaterial;
}
