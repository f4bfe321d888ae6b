import { PBRMaterial } from "@babylonjs/core/Materials/PBR/pbrMaterial.js";
import { BaseTexture } from "@babylonjs/core/Materials/Textures/baseTexture.js";
import { RawCubeTexture } from "@babylonjs/core/Materials/Textures/rawCubeTexture.js";
import { Scene } from "@babylonjs/core/scene.js";
import { LuthierManifest, LuthierManifestMaterial } from "luthier-web";

export { LuthierManifest, LuthierManifestMaterial };

/** What a material of luthier has beside those of Babylon.js. */
export interface LuthierOptions {
  /** Variance of the slopes of the normals that a pixel sees, along either axis: it widens highlights, as the size of a lamp does. 0 by default. */
  slopeVariance?: number;
}

/** A bake in memory, for one scene. */
export class LuthierBake {
  /** Loads `manifest.json` of a bake, and the shader, tables and maps that it names. Rejects with the file and what to do where the bake cannot be drawn with. */
  static LoadAsync(url: string, scene: Scene, options?: { /** Whether maps get mipmaps; true by default. */ mipmaps?: boolean }): Promise<LuthierBake>;
  readonly scene: Scene;
  readonly manifest: LuthierManifest;
  /** Names of the materials. The index is the number of a material in the shader. */
  readonly names: readonly string[];
  /** Textures of the tables, by the names of the bindings. */
  readonly tables: ReadonlyMap<string, BaseTexture>;
  /** Textures of the maps. */
  readonly maps: ReadonlyMap<string, BaseTexture>;
  /** A material of the bake; throws where it has none of the name. */
  material(name: string, options?: LuthierOptions): LuthierMaterial;
  /** Number of a material in the shader, and its entry in the manifest. */
  find(name: string): { number: number; entry: LuthierManifestMaterial };
  /** Light from all around; null for none. Needs a bake with `--functions surface,environment`. */
  environment: LuthierEnvironment | null;
  /** Frees textures and numbers. */
  dispose(): void;
}

/** The two cubes of `luthier environment --layout cube`. */
export class LuthierEnvironment {
  /** Loads `environment.json` and its cubes. */
  static LoadAsync(url: string, scene: Scene): Promise<LuthierEnvironment>;
  readonly environment: RawCubeTexture;
  readonly irradiance: RawCubeTexture;
  dispose(): void;
}

/** A material of a bake: settings that are not of the surface are those of a PBRMaterial, and so are lights, shadows, fog and image processing. */
export class LuthierMaterial extends PBRMaterial {
  constructor(bake: LuthierBake, name: string, options?: LuthierOptions);
  slopeVariance: number;
  clone(name: string): LuthierMaterial;
}
