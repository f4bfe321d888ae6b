import { CompressedCubeTexture, Loader, Material, Texture } from "three";
import { LuthierManifest, LuthierManifestMaterial } from "luthier-web";

export { LuthierManifest, LuthierManifestMaterial };

/** The two cubes of `luthier environment --layout cube`. */
export interface LuthierEnvironment {
  environment: CompressedCubeTexture;
  irradiance: CompressedCubeTexture;
}

/** What a material of luthier has beside those of three.js. */
export interface LuthierParameters {
  /** Variance of the slopes of the normals that a pixel sees, along either axis: it widens highlights, as the size of a lamp does. 0 by default. */
  slopeVariance?: number;
}

/** A bake in memory; `M` is the class of its materials, `P` their parameters. */
export class LuthierBake<M extends Material = Material, P extends object = object> {
  readonly manifest: LuthierManifest;
  /** Names of the materials. The index is the number of a material in the shader. */
  readonly names: readonly string[];
  /** Textures of the tables, by the names of the bindings. */
  readonly tables: ReadonlyMap<string, Texture>;
  /** Textures of the maps. */
  readonly maps: ReadonlyMap<string, Texture>;
  /** A material of the bake; throws where it has none of the name. */
  material(name: string, options?: P & LuthierParameters): M;
  /** Number of a material in the shader, and its entry in the manifest. */
  find(name: string): { number: number; entry: LuthierManifestMaterial };
  /** Light from all around; null for none. Needs a bake with `--functions surface,environment`. */
  set environment(cubes: LuthierEnvironment | null);
  /** Frees the textures. */
  dispose(): void;
}

/** Loads `manifest.json` of a bake. Rejects with the file and what to do where the bake cannot be drawn with. */
export class BakeLoader<B> extends Loader<B> {
  /** Whether maps get mipmaps; true by default. */
  mipmaps: boolean;
  load(url: string, onLoad: (bake: B) => void, onProgress?: (event: ProgressEvent) => void, onError?: (error: unknown) => void): void;
  loadAsync(url: string): Promise<B>;
}

/** Loads `environment.json` of `luthier environment --layout cube`. */
export class LuthierEnvironmentLoader extends Loader<LuthierEnvironment> {
  load(url: string, onLoad: (cubes: LuthierEnvironment) => void, onProgress?: (event: ProgressEvent) => void, onError?: (error: unknown) => void): void;
  loadAsync(url: string): Promise<LuthierEnvironment>;
}
