/** What `manifest.json` says; docs/manifest.md has all of it. */
export interface LuthierManifest {
  readonly schema: 4;
  readonly generator: string;
  readonly materials: readonly LuthierManifestMaterial[];
  readonly [field: string]: unknown;
}

export interface LuthierManifestMaterial {
  readonly name: string;
  readonly model: string;
  readonly class: string;
  readonly maps: readonly { readonly slot: string; readonly layer: number | null; readonly srgb?: boolean; readonly [field: string]: unknown }[];
  readonly [field: string]: unknown;
}

/** A map of a material, as in `materials[].maps[]` of the manifest. */
export interface LuthierMap {
  readonly slot: string;
  readonly file: { readonly path: string };
  readonly srgb?: boolean;
}

/** Numbers of the maps of a material, one element for each texture that it may have. */
export interface MapNumbers {
  kinds: number[];
  /** Matrices of the texture coordinates, nine numbers each, column by column. */
  rows: number[][];
  factors: number[][];
  base: number[];
}

/** What the maps of a bake have in common. */
export interface Surface {
  /** Textures that a material has at most. */
  readonly width: number;
  readonly lines: { readonly before: string; readonly texel: string; readonly after: string };
  /** The maps of a material that its model shows, in the order in which they fill the place. */
  mapsOf(entry: LuthierManifestMaterial): LuthierMap[];
  uniformsOf(entry: LuthierManifestMaterial): MapNumbers;
}

/** What `readBake` makes, and `new Bake` takes; `T` is the host's texture of a table, `M` that of a map. */
export interface BakeFiles<T, M = T> {
  manifest: LuthierManifest;
  text: string;
  interface: unknown;
  words: Float32Array;
  tables: Map<string, T>;
  maps: Map<string, M>;
}

/** A bake in memory. */
export class Bake<T, M = T> {
  constructor(files: BakeFiles<T, M>);
  readonly manifest: LuthierManifest;
  /** Names of the materials. The index is the number of a material in the shader. */
  readonly names: readonly string[];
  /** Text of the shader, and the functions that it declares. */
  readonly text: string;
  readonly functions: readonly string[];
  /** The material buffer, four numbers to a word. */
  readonly words: Float32Array;
  /** Textures of the tables, by the names of the bindings. */
  readonly tables: ReadonlyMap<string, T>;
  /** Textures of the maps, by `mapKey`. */
  readonly maps: ReadonlyMap<string, M>;
  readonly surface: Surface;
  /** Number of a material in the shader, and its entry in the manifest. */
  find(name: string): { number: number; entry: LuthierManifestMaterial };
}

/** A host, as `readBake` asks it. */
export interface Host<T, M = T> {
  /** Names of the renderer and of the package, for what is refused. */
  host: string;
  name: string;
  target: "glsl-es300" | "wgsl";
  file: FileReader;
  table(bytes: ArrayBuffer, format: string): T | Promise<T>;
  map(url: URL, map: LuthierMap): M | Promise<M>;
}

export interface FileReader {
  (url: URL, type: "text"): Promise<string>;
  (url: URL, type: "arraybuffer"): Promise<ArrayBuffer>;
}

export function mapKey(map: LuthierMap): string;
export function readBake<T, M = T>(url: URL, host: Host<T, M>): Promise<BakeFiles<T, M>>;
export function readEnvironment(url: URL, file: FileReader): Promise<{ environment: ArrayBuffer; irradiance: ArrayBuffer }>;

/** Size and levels of a file; the texels of a cube are face by face. `unzstd` is a decoder of zstd. */
export function readKtx2(
  file: ArrayBuffer,
  unzstd: (bytes: Uint8Array, length: number) => Uint8Array | Promise<Uint8Array>,
): Promise<{ width: number; height: number; levels: ArrayBuffer[] }>;
export function toHalfFloats(texels: ArrayBuffer): Uint16Array;

/** How a shader names the numbers of map `i`, and reads its texel. */
export interface MapNames {
  kind(i: number): string;
  rows(i: number): string;
  factor(i: number): string;
  base: string;
  sample(i: number, at: string): string;
}

export function fill(surface: Surface, names: MapNames): string;
export function glslAround(bake: Pick<Bake<unknown>, "functions" | "surface">, names: Omit<MapNames, "sample"> & Partial<MapNames>): string;
export function wgslAround(bake: Pick<Bake<unknown>, "functions" | "surface">): string;
export function withOwnSamplers(text: string, sampler: (texture: string) => string): string;
