import { AppBase, GraphicsDevice, ResourceHandler, StandardMaterial, StorageBuffer, Texture } from "playcanvas";
import { Bake, LuthierManifest, LuthierManifestMaterial } from "luthier-web";

export { LuthierManifest, LuthierManifestMaterial };

/** The two cubes of `luthier environment --layout cube`. */
export interface LuthierEnvironment {
  environment: Texture;
  irradiance: Texture;
}

export interface LuthierParameters {
  /** Variance of the slopes of the normals that a pixel sees, along either axis: it widens highlights, as the size of a lamp does. 0 by default. */
  slopeVariance?: number;
}

/** A material of a bake, under the lights, shadows, fog and tone curve of PlayCanvas. */
export class LuthierMaterial extends StandardMaterial {
  constructor(bake: LuthierBake, name: string, options?: LuthierParameters);
  readonly isLuthierMaterial: true;
  slopeVariance: number;
  clone(): this;
  copy(source: LuthierMaterial): this;
  /** Light from all around, of this material alone; `LuthierBake.environment` is that of all. */
  setEnvironment(cubes: LuthierEnvironment | null): void;
}

/** A bake in memory. */
export class LuthierBake extends Bake<Texture> {
  readonly device: GraphicsDevice;
  /** Materials that were made and not destroyed. */
  readonly materials: ReadonlySet<LuthierMaterial>;
  /** Textures and the material buffer of all materials, by the names of the shader. */
  readonly resources: ReadonlyMap<string, Texture | StorageBuffer>;
  /** A material of the bake; throws where it has none of the name. */
  material(name: string, options?: LuthierParameters): LuthierMaterial;
  /** Light from all around; null for none. Needs a bake with `--functions surface,environment`. */
  environment: LuthierEnvironment | null;
  /** Frees the materials, the textures and the material buffer. */
  destroy(): void;
}

/** Loads `manifest.json` of a bake. Rejects with the file and what to do where the bake cannot be drawn with. */
export function loadBake(
  device: GraphicsDevice,
  url: string | URL,
  options?: {
    /** Whether maps get mipmaps; true by default. */
    mipmaps?: boolean;
  },
): Promise<LuthierBake>;

/** Loads `environment.json` of `luthier environment --layout cube`. */
export function loadEnvironment(device: GraphicsDevice, url: string | URL): Promise<LuthierEnvironment>;

/** Assets of the type "luthier", whose file is the manifest of a bake and whose resource is a `LuthierBake`. */
export class LuthierHandler extends ResourceHandler {
  constructor(app: AppBase);
}
