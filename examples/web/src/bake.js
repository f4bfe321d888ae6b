// The folder of a bake: its manifest, what it is refused for, and the files that it names. How files are loaded, and what textures are, the host says.

import { Surface } from "./surface.js";

/** The version of the manifest that this package reads. */
const SCHEMA = 4;

/** A bake in memory. `Texture` is what the host makes of tables and maps. */
export class Bake {
  constructor({ manifest, text, interface: known, words, tables, maps }) {
    this.manifest = manifest;
    /** Names of the materials. The index is the number of a material in the shader. */
    this.names = manifest.materials.map(({ name }) => name);
    /** Text of the shader, and what it declares. */
    this.text = text;
    this.functions = known.functions.map(({ name }) => name);
    /** The material buffer, four numbers to a word. */
    this.words = words;
    /** Textures of the tables, by the names of the bindings. */
    this.tables = tables;
    /** Textures of the maps, by `mapKey`. */
    this.maps = maps;
    this.surface = new Surface(manifest, known, text);
  }

  /** Number of a material in the shader, and its entry in the manifest. */
  find(name) {
    const number = this.names.indexOf(name);
    if (number < 0) throw new Error(`the bake has no material ${name}; it has ${this.names.join(", ")}`);
    return { number, entry: this.manifest.materials[number] };
  }
}

/** Maps with one key are one texture: of the same file, with the same curve, and filtered or not. */
export function mapKey({ file, srgb, slot }) {
  return `${file.path} ${Boolean(srgb)} ${slot === "flake-normal"}`;
}

/**
 * Reads the manifest at a URL, and the shader, tables and maps that it names; the argument of `new Bake`. The host has a name, `host`, and a package,
 * `name`, for what is refused; a language, `target`; and functions: `file(url, "text" or "arraybuffer")` loads, `table(bytes, format)` and
 * `map(url, map)` make a texture.
 */
export async function readBake(url, { host, name, target, file, table, map }) {
  const manifest = await json(url, file);
  const bad = problem(manifest, { host, name, target });
  if (bad) throw new Error(`${url}: ${bad}`);
  const beside = (path, type = "arraybuffer") => file(new URL(path, url), type);

  const { file: shader, interface: known } = manifest.shaders.find((shader) => isBaked(shader, target));
  const [text, words] = await Promise.all([beside(shader.path, "text"), beside(manifest.material_buffer.path)]);
  const tables = await each(manifest.bindings.filter(({ resource }) => resource === "texture_2d<f32>"), async ({ name }) => {
    const { texture, format } = manifest.tables.find(({ kind }) => name === `luthier_${kind}`);
    return [name, await table(await beside(texture.path), format)];
  });
  const maps = await each(distinctMaps(manifest), async ([key, entry]) => [key, await map(new URL(entry.file.path, url), entry)]);
  return { manifest, text, interface: known, words: new Float32Array(words), tables, maps };
}

/** Reads `environment.json` of `luthier environment --layout cube`: the bytes of its two cubes, by their content. */
export async function readEnvironment(url, file) {
  const { textures } = await json(url, file);
  const cube = async (content) => {
    const entry = textures?.find((texture) => texture.content === content && texture.layout === "cube");
    if (!entry) throw new Error(`${url} names no cube of the ${content}: make it with luthier environment --layout cube`);
    return file(new URL(entry.path, url), "arraybuffer");
  };
  const [environment, irradiance] = await Promise.all(["environment", "irradiance"].map(cube));
  return { environment, irradiance };
}

async function json(url, file) {
  const text = await file(url, "text");
  try {
    return JSON.parse(text);
  } catch (error) {
    throw new Error(`${url} is no JSON: ${error.message}`);
  }
}

/** What keeps a manifest from being drawn with, and how to bake anew. */
function problem(manifest, { host, name, target }) {
  if (manifest.schema !== SCHEMA) {
    return typeof manifest.schema === "number"
      ? `the manifest has schema ${manifest.schema}, and this version of ${name} reads ${SCHEMA}: bake again with the luthier of the package's version`
      : "this is no manifest of luthier: it has no schema";
  }
  if (!manifest.shaders.some((shader) => isBaked(shader, target))) {
    const has = [...new Set(manifest.shaders.map((shader) => `${shader.target} (${shader.form})`))].join(", ");
    return `the bake has no baked shader in ${target}, only ${has}: bake with --target ${target}`;
  }
  if (!manifest.functions?.includes("surface")) return "the shader takes no normals and maps of a renderer: bake with --functions surface";
  const { prefix } = manifest.names ?? {};
  if (prefix) return `the names of its shader begin with ${prefix}_: bake without --prefix`;
  const steps = manifest.bindings.find(({ resource }) => resource === "buffer<vec4<u32>>");
  return steps && `${steps.name} is in whole numbers, which ${host} does not filter: bake with --layout filtered`;
}

const isBaked = (shader, target) => shader.target === target && shader.form === "baked";

/** One map of each texture. Materials share textures. */
function distinctMaps({ materials }) {
  return [...new Map(materials.flatMap(({ maps }) => maps.map((map) => [mapKey(map), map])))];
}

async function each(list, load) {
  return new Map(await Promise.all(list.map(load)));
}
