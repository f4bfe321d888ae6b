// What `luthier bake` wrote, as uniforms of a material of three.js.

import * as THREE from "three";
import { KTX2Loader } from "three/addons/loaders/KTX2Loader.js";

export class Bake {
  /** Reads the manifest of the folder at `url` (which ends in a slash), and the shader, the tables and the materials it names. */
  static async open(url, renderer) {
    const manifest = await (await get(new URL("manifest.json", url))).json();
    if (manifest.schema !== 4) throw new Error(`this program reads schema 4 of the manifest, not ${manifest.schema}`);
    const bake = new Bake();
    bake.url = url;
    bake.manifest = manifest;
    bake.materials = manifest.materials.map((material) => material.name);

    const shader = manifest.shaders.find(({ target, form }) => target === "glsl-es300" && form === "baked");
    bake.interface = shader.interface;
    bake.glsl = await (await get(new URL(shader.file.path, url))).text();

    // Texels are not in a format of Basis Universal: the loader needs no transcoder, but insists on this call.
    const loader = new KTX2Loader().detectSupport(renderer);
    bake.uniforms = {};
    for (const { name, resource } of manifest.bindings) {
      if (resource === "buffer<vec4<u32>>") throw new Error(`${name} is in whole numbers: bake with --layout filtered`);
      if (resource !== "texture_2d<f32>") continue;
      const table = manifest.tables.find(({ kind }) => name === `luthier_${kind}`);
      const texture = await loader.loadAsync(new URL(table.texture.path, url).href);
      // Raw textures come unfiltered out of the loader.
      texture.minFilter = THREE.LinearFilter;
      texture.magFilter = THREE.LinearFilter;
      bake.uniforms[name] = { value: texture };
    }

    // GLSL ES 3.00 has no storage buffers: the material buffer is a texture, read texel by texel.
    const words = new Float32Array(await (await get(new URL(manifest.material_buffer.path, url))).arrayBuffer());
    const { width, height } = manifest.material_texture;
    const texture = new THREE.DataTexture(words, width, height, THREE.RGBAFormat, THREE.FloatType);
    texture.needsUpdate = true;
    bake.uniforms.luthier_materials = { value: texture };
    return bake;
  }

  /** Number of a material in the shader. */
  number(name) {
    const number = this.materials.indexOf(name);
    if (number < 0) throw new Error(`no material ${name} in the bake`);
    return number;
  }
}

async function get(url) {
  const response = await fetch(url);
  if (!response.ok) throw new Error(`${url}: ${response.status}`);
  return response;
}
