// What `luthier bake --no-zstd` wrote, as textures of WebGL 2.

import { makeTexture } from "./textures.js";

export class Bake {
  /** Reads the manifest of the folder at `url` (which ends in a slash), and the shader, the tables and the materials it names. */
  static async open(url, gl) {
    const manifest = await (await get(new URL("manifest.json", url))).json();
    if (manifest.schema !== 4) throw new Error(`this program reads schema 4 of the manifest, not ${manifest.schema}`);
    const bake = new Bake();
    bake.materials = manifest.materials.map((material) => material.name);

    const shader = manifest.shaders.find(({ target, form }) => target === "glsl-es300" && form === "baked");
    bake.glsl = await (await get(new URL(shader.file.path, url))).text();

    /** Textures by the names of the shader's samplers. */
    bake.textures = new Map();
    for (const { name, resource } of manifest.bindings) {
      // A table with steps is a buffer elsewhere, and a texture of whole numbers here.
      if (resource !== "texture_2d<f32>" && resource !== "buffer<vec4<u32>>") continue;
      const table = manifest.tables.find(({ kind }) => name === `luthier_${kind}`);
      const file = await (await get(new URL(table.texture.path, url))).arrayBuffer();
      bake.textures.set(name, makeTexture(gl, { format: table.format, ...level(file) }));
    }

    const texels = await (await get(new URL(manifest.material_buffer.path, url))).arrayBuffer();
    const { width, height } = manifest.material_texture;
    bake.textures.set("luthier_materials", makeTexture(gl, { format: "rgba32float", width, height, texels }));
    return bake;
  }

  /** Number of a material in the shader. */
  number(name) {
    const number = this.materials.indexOf(name);
    if (number < 0) throw new Error(`no material ${name} in the bake`);
    return number;
  }
}

/** Size and texels of a KTX2 file of one level without supercompression. */
function level(file) {
  const view = new DataView(file);
  const long = (at) => Number(view.getBigUint64(at, true));
  if (view.getUint32(44, true) !== 0) throw new Error("supercompressed texels: bake with --no-zstd");
  const [offset, length] = [long(80), long(88)];
  return { width: view.getUint32(20, true), height: view.getUint32(24, true), texels: file.slice(offset, offset + length) };
}

async function get(url) {
  const response = await fetch(url);
  if (!response.ok) throw new Error(`${url}: ${response.status}`);
  return response;
}
