// Reads the folder of a bake. What three.js draws with decides the language of the shader and the class of the materials: src/index.js and src/webgpu.js.

import { FileLoader, ImageBitmapLoader, LinearFilter, LinearMipmapLinearFilter, Loader, RepeatWrapping, SRGBColorSpace, Texture } from "three";
import { LuthierBake } from "./bake.js";
import { cubeTexture, tableTexture, unfiltered } from "./ktx2.js";

/** The version of the manifest that this package reads. */
const SCHEMA = 4;

/** Loads a file of JSON and the files that it names, which are beside it. */
class FolderLoader extends Loader {
  load(url, onLoad, onProgress, onError) {
    this.loadAsync(url).then(onLoad, onError ?? console.error);
  }

  base(url) {
    return new URL(url, new URL(this.path || ".", document.baseURI));
  }

  file(url, type) {
    const loader = new FileLoader(this.manager).setResponseType(type).setRequestHeader(this.requestHeader).setWithCredentials(this.withCredentials);
    return loader.loadAsync(url.href);
  }

  async json(url) {
    const text = await this.file(url, "text");
    try {
      return JSON.parse(text);
    } catch (error) {
      throw new Error(`${url} is no JSON: ${error.message}`);
    }
  }
}

/** Loads `manifest.json` of a bake, and the shader, tables and maps that it names. A subclass says for which renderer. */
export class BakeLoader extends FolderLoader {
  /** Whether maps get mipmaps. `luthier preview` reads level 0 alone. */
  mipmaps = true;

  async loadAsync(url) {
    const base = this.base(url);
    const manifest = await this.json(base);
    const bad = problem(manifest, this.target);
    if (bad) throw new Error(`${base}: ${bad}`);
    const file = (path, type = "arraybuffer") => this.file(new URL(path, base), type);

    const { file: shader, interface: known } = manifest.shaders.find((shader) => isBaked(shader, this.target));
    const [text, words] = await Promise.all([file(shader.path, "text"), file(manifest.material_buffer.path)]);
    const tables = await each(manifest.bindings.filter(({ resource }) => resource === "texture_2d<f32>"), async ({ name }) => {
      const { texture, format } = manifest.tables.find(({ kind }) => name === `luthier_${kind}`);
      return [name, await tableTexture(await file(texture.path), format)];
    });
    const maps = await each(distinctMaps(manifest), async ([key, map]) => [key, await this.#map(new URL(map.file.path, base), map)]);
    return new LuthierBake({ manifest, text, interface: known, words: new Float32Array(words), tables, maps, Material: this.Material });
  }

  /** The texture of a map: its first row is at v = 0, and its numbers are those of the file. The browser reads 16 bits as 8. */
  async #map(url, { slot, srgb }) {
    const loader = new ImageBitmapLoader(this.manager).setOptions({ premultiplyAlpha: "none", colorSpaceConversion: "none" });
    const texture = new Texture(await loader.loadAsync(url.href));
    if (srgb) texture.colorSpace = SRGBColorSpace;
    texture.flipY = false;
    texture.wrapS = texture.wrapT = RepeatWrapping;
    const isCells = slot === "flake-normal";
    texture.generateMipmaps = this.mipmaps && !isCells;
    texture.magFilter = LinearFilter;
    texture.minFilter = texture.generateMipmaps ? LinearMipmapLinearFilter : LinearFilter;
    if (isCells) unfiltered(texture);
    texture.needsUpdate = true;
    return texture;
  }
}

/** Loads `environment.json` of the command `luthier environment --layout cube`: the two cubes of a surrounding. */
export class LuthierEnvironmentLoader extends FolderLoader {
  async loadAsync(url) {
    const base = this.base(url);
    const { textures } = await this.json(base);
    const cube = async (content) => {
      const entry = textures?.find((texture) => texture.content === content && texture.layout === "cube");
      if (!entry) throw new Error(`${base} names no cube of the ${content}: make it with luthier environment --layout cube`);
      return cubeTexture(await this.file(new URL(entry.path, base), "arraybuffer"));
    };
    const [environment, irradiance] = await Promise.all(["environment", "irradiance"].map(cube));
    return { environment, irradiance };
  }
}

/** What keeps a manifest from being drawn with, and how to bake anew. */
function problem(manifest, target) {
  if (manifest.schema !== SCHEMA) {
    return typeof manifest.schema === "number"
      ? `the manifest has schema ${manifest.schema}, and this version of luthier-three reads ${SCHEMA}: bake again with the luthier of the package's version`
      : "this is no manifest of luthier: it has no schema";
  }
  if (!manifest.shaders.some((shader) => isBaked(shader, target))) {
    const has = [...new Set(manifest.shaders.map((shader) => `${shader.target} (${shader.form})`))].join(", ");
    return `the bake has no baked shader in ${target}, only ${has}: bake with --target ${target}`;
  }
  if (!manifest.functions?.includes("surface")) return "the shader takes no normals and maps of a renderer: bake with --functions surface";
  const steps = manifest.bindings.find(({ resource }) => resource === "buffer<vec4<u32>>");
  return steps && `${steps.name} is in whole numbers, which three.js does not filter: bake with --layout filtered`;
}

const isBaked = (shader, target) => shader.target === target && shader.form === "baked";

/** One map of each file, by its path and whether it is sRGB. Materials share textures. */
function distinctMaps({ materials }) {
  return [...new Map(materials.flatMap(({ maps }) => maps.map((map) => [LuthierBake.mapKey(map), map])))];
}

async function each(list, load) {
  return new Map(await Promise.all(list.map(load)));
}
