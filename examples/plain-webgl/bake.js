// What `luthier bake --no-zstd` wrote, as textures of WebGL 2.

/** Formats of the manifest in the words of WebGL: internal format, format, type, and the array that holds texels. */
const formats = (gl) => ({
  rgba8unorm: [gl.RGBA8, gl.RGBA, gl.UNSIGNED_BYTE, Uint8Array],
  rgb10a2unorm: [gl.RGB10_A2, gl.RGBA, gl.UNSIGNED_INT_2_10_10_10_REV, Uint32Array],
  rg11b10ufloat: [gl.R11F_G11F_B10F, gl.RGB, gl.UNSIGNED_INT_10F_11F_11F_REV, Uint32Array],
  r16float: [gl.R16F, gl.RED, gl.HALF_FLOAT, Uint16Array],
  rg16float: [gl.RG16F, gl.RG, gl.HALF_FLOAT, Uint16Array],
  rgba16float: [gl.RGBA16F, gl.RGBA, gl.HALF_FLOAT, Uint16Array],
  r32float: [gl.R32F, gl.RED, gl.FLOAT, Float32Array],
  rgba32float: [gl.RGBA32F, gl.RGBA, gl.FLOAT, Float32Array],
});

export class Bake {
  /** Reads the manifest of the folder at `url` (which ends in a slash), and the shader, the tables and the materials it names. */
  static async open(url, gl) {
    const manifest = await (await get(new URL("manifest.json", url))).json();
    if (manifest.schema !== 3) throw new Error(`this program reads schema 3 of the manifest, not ${manifest.schema}`);
    const bake = new Bake();
    bake.materials = manifest.materials.map((material) => material.name);

    const shader = manifest.shaders.find(({ target, form }) => target === "glsl-es300" && form === "baked");
    bake.glsl = await (await get(new URL(shader.file.path, url))).text();

    /** Textures by the names of the shader's samplers. */
    bake.textures = new Map();
    for (const { name, resource } of manifest.bindings) {
      if (resource !== "texture_2d<f32>") continue;
      const table = manifest.tables.find(({ kind }) => name === `luthier_${kind}`);
      const file = await (await get(new URL(table.texture.path, url))).arrayBuffer();
      bake.textures.set(name, texture(gl, { format: table.format, ...level(file) }));
    }

    const texels = await (await get(new URL(manifest.material_buffer.path, url))).arrayBuffer();
    const { width, height } = manifest.material_texture;
    bake.textures.set("luthier_materials", texture(gl, { format: "rgba32float", width, height, texels }));
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

/** A texture of one level. */
function texture(gl, { format, width, height, texels }) {
  if (!(format in formats(gl))) throw new Error(`WebGL 2 has no ${format} without an extension`);
  const [internal, layout, type, Texels] = formats(gl)[format];
  const texture = gl.createTexture();
  gl.bindTexture(gl.TEXTURE_2D, texture);
  gl.pixelStorei(gl.UNPACK_ALIGNMENT, 1);
  gl.texImage2D(gl.TEXTURE_2D, 0, internal, width, height, 0, layout, type, new Texels(texels));
  // 32-bit floats are not filtered; the shader reads them texel by texel.
  const filter = type === gl.FLOAT ? gl.NEAREST : gl.LINEAR;
  gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, filter);
  gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MAG_FILTER, filter);
  gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_WRAP_S, gl.CLAMP_TO_EDGE);
  gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_WRAP_T, gl.CLAMP_TO_EDGE);
  return texture;
}

async function get(url) {
  const response = await fetch(url);
  if (!response.ok) throw new Error(`${url}: ${response.status}`);
  return response;
}
