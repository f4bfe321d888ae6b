import { MaterialParameters } from "three";
import { NodeMaterial } from "three/webgpu";
import { BakeLoader, LuthierBake, LuthierParameters } from "./bake.js";

export { LuthierBake, LuthierEnvironment, LuthierEnvironmentLoader, LuthierManifest, LuthierManifestMaterial, LuthierParameters } from "./bake.js";

/** A material of a bake for WebGPURenderer. */
export class LuthierNodeMaterial extends NodeMaterial {
  constructor(bake: LuthierBake, name: string, options?: MaterialParameters & LuthierParameters);
  readonly isLuthierNodeMaterial: true;
  slopeVariance: number;
}

/** Loads a bake with a shader in WGSL. */
export class LuthierLoader extends BakeLoader<LuthierBake<LuthierNodeMaterial, MaterialParameters>> {}
