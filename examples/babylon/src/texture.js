// Files of a bake and of an environment as textures of Babylon.js.

import { StorageBuffer } from "@babylonjs/core/Buffers/storageBuffer.js";
import { Constants } from "@babylonjs/core/Engines/constants.js";
import { RawCubeTexture } from "@babylonjs/core/Materials/Textures/rawCubeTexture.js";
import { RawTexture } from "@babylonjs/core/Materials/Textures/rawTexture.js";
import { Texture } from "@babylonjs/core/Materials/Textures/texture.js";
import { readKtx2 } from "luthier-web";
import { ZSTDDecoder } from "zstddec";

const { TEXTUREFORMAT_R: R, TEXTUREFORMAT_RG: RG, TEXTUREFORMAT_RGB: RGB, TEXTUREFORMAT_RGBA: RGBA } = Constants;
const { TEXTURETYPE_HALF_FLOAT: HALF, TEXTURETYPE_FLOAT: FLOAT, TEXTURETYPE_UNSIGNED_BYTE: BYTE } = Constants;

/** Formats of the manifest in the words of Babylon.js: channels, type, and the array that holds texels. */
const FORMATS = {
  r16float: [R, HALF, Uint16Array],
  rg16float: [RG, HALF, Uint16Array],
  rgba16float: [RGBA, HALF, Uint16Array],
  rgba8unorm: [RGBA, BYTE, Uint8Array],
  rgb10a2unorm: [RGBA, Constants.TEXTURETYPE_UNSIGNED_INT_2_10_10_10_REV, Uint32Array],
  rg11b10ufloat: [RGB, Constants.TEXTURETYPE_UNSIGNED_INT_10F_11F_11F_REV, Uint32Array],
  r32float: [R, FLOAT, Float32Array],
  rgba32float: [RGBA, FLOAT, Float32Array],
};

/** The texture of a table, which ends at its edges. 32-bit floats are read texel by texel. */
export async function tableTexture(file, format, scene) {
  if (!(format in FORMATS)) throw new Error(`Babylon.js has no texels of ${format}: bake with --no-search, or ask for another format in the material file`);
  const { width, height, levels } = await readKtx2(file, unzstd);
  const [channels, type, Texels] = FORMATS[format];
  // In WebGPU three channels of a word count as four.
  const known = channels === RGB && scene.getEngine().isWebGPU ? RGBA : channels;
  return raw(new Texels(levels[0]), width, height, known, type, scene);
}

/** The material buffer: a texture where GLSL ES 3.00 has no storage buffers. */
export function wordsOf({ manifest, words }, scene) {
  const engine = scene.getEngine();
  if (engine.isWebGPU) {
    const buffer = new StorageBuffer(engine, words.byteLength, Constants.BUFFER_CREATIONFLAG_READWRITE);
    buffer.update(words);
    return buffer;
  }
  const { width, height } = manifest.material_texture;
  return raw(words, width, height, RGBA, FLOAT, scene);
}

function raw(texels, width, height, channels, type, scene) {
  const filter = type === FLOAT ? Texture.NEAREST_SAMPLINGMODE : Texture.BILINEAR_SAMPLINGMODE;
  const texture = new RawTexture(texels, width, height, channels, scene, false, false, filter, type);
  texture.wrapU = texture.wrapV = Texture.CLAMP_ADDRESSMODE;
  return texture;
}

/** The texture of a map: its first row is at v = 0, and its numbers are those of the file. The browser reads 16 bits as 8. */
export function mapTexture(url, { slot, srgb }, scene, mipmaps) {
  const isCells = slot === "flake-normal";
  const noMipmap = isCells || !mipmaps;
  const filtered = noMipmap ? Texture.BILINEAR_SAMPLINGMODE : Texture.TRILINEAR_SAMPLINGMODE;
  const samplingMode = isCells ? Texture.NEAREST_SAMPLINGMODE : filtered;
  return new Promise((resolve, reject) => {
    const onError = (message, error) => reject(new Error(`${url}: ${message ?? error?.message}`));
    const texture = new Texture(url, scene, { noMipmap, invertY: false, samplingMode, useSRGBBuffer: Boolean(srgb), onLoad: () => resolve(texture), onError });
  });
}

/** The texture of a cube of half floats with all its levels. */
export async function cubeTexture(file, scene) {
  const { width, levels } = await readKtx2(file, unzstd);
  const texture = new RawCubeTexture(scene, null, width, RGBA, HALF, levels.length > 1, false, Texture.TRILINEAR_SAMPLINGMODE);
  const internal = texture.getInternalTexture();
  for (let level = 0; width >> level > 0; level++) {
    // Textures have levels down to one texel. No shader reads those that the file lacks.
    const texels = levels[level] ? new Uint16Array(levels[level]) : new Uint16Array(24 * (width >> level) ** 2);
    const length = texels.length / 6;
    for (let face = 0; face < 6; face++) {
      scene.getEngine()._uploadArrayBufferViewToTexture(internal, texels.subarray(face * length, (face + 1) * length), face, level);
    }
    if (levels.length === 1) break;
  }
  texture.gammaSpace = false;
  return texture;
}

export const whiteTexel = (scene) => raw(new Uint8Array(4).fill(255), 1, 1, RGBA, BYTE, scene);

/** A cube without light. */
export function blackCube(scene) {
  const face = new Uint16Array(4);
  return new RawCubeTexture(scene, Array(6).fill(face), 1, RGBA, HALF, false, false, Texture.BILINEAR_SAMPLINGMODE);
}

let decoder;

async function unzstd(bytes, length) {
  decoder ??= new ZSTDDecoder();
  await decoder.init();
  return decoder.decode(bytes, length);
}
