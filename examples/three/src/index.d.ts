import { MaterialParameters, ShaderMaterial } from "three";
import { BakeLoader, LuthierBake, LuthierParameters } from "./bake.js";

export { LuthierBake, LuthierEnvironment, LuthierEnvironmentLoader, LuthierManifest, LuthierManifestMaterial, LuthierParameters } from "./bake.js";

/** A material of a bake for WebGLRenderer. */
export class LuthierMaterial extends ShaderMaterial {
  constructor(bake: LuthierBake, name: string, options?: MaterialParameters & LuthierParameters);
  readonly isLuthierMaterial: true;
  slopeVariance: number;
}

/** Loads a bake with a shader in GLSL ES 3.00. */
export class LuthierLoader extends BakeLoader<LuthierBake<LuthierMaterial, MaterialParameters>> {}
