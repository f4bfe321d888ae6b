// KTX2 files of `luthier bake` and `luthier environment` as textures of three.js: raw texels, plain or compressed with zstd.

import {
  CompressedCubeTexture, DataTexture, DataUtils, FloatType, HalfFloatType, LinearFilter, LinearMipmapLinearFilter, NearestFilter, NearestMipmapNearestFilter, RedFormat, RGBAFormat,
  RGBFormat, RGFormat, UnsignedByteType, UnsignedInt101111Type,
} from "three";
import { ZSTDDecoder } from "three/addons/libs/zstddec.module.js";

const ZSTD = 2;

/** Formats of the manifest in the words of three.js: format, type, and the array that holds texels. */
const FORMATS = {
  r16float: [RedFormat, HalfFloatType, Uint16Array],
  rg16float: [RGFormat, HalfFloatType, Uint16Array],
  rgba16float: [RGBAFormat, HalfFloatType, Uint16Array],
  rgba8unorm: [RGBAFormat, UnsignedByteType, Uint8Array],
  rg11b10ufloat: [RGBFormat, UnsignedInt101111Type, Uint32Array],
  r32float: [RedFormat, FloatType, Float32Array],
  rgba32float: [RGBAFormat, FloatType, Float32Array],
};

/** The texture of a table, which ends at its edges. */
export async function tableTexture(file, format) {
  const { width, height, levels } = await read(file);
  let [texels, known] = [levels[0].texels, format];
  // three.js has no such texels; a half float is off by a quarter of their step at most.
  if (format === "rgb10a2unorm") [texels, known] = [halves(new Uint32Array(texels)).buffer, "rgba16float"];
  if (!(known in FORMATS)) throw new Error(`three.js has no texels of ${format}: bake with --no-search, or ask for another format in the material file`);
  const [layout, type, Texels] = FORMATS[known];
  const texture = new DataTexture(new Texels(texels), width, height, layout, type);
  texture.minFilter = texture.magFilter = LinearFilter;
  // 32-bit floats are read texel by texel.
  if (type === FloatType) unfiltered(texture);
  texture.unpackAlignment = 1;
  texture.needsUpdate = true;
  return texture;
}

/** Has a texture read without filters. Where both are `NearestFilter`, WebGPURenderer binds no sampler, which the shader has. */
export function unfiltered(texture) {
  texture.magFilter = NearestFilter;
  texture.minFilter = NearestMipmapNearestFilter;
}

/** The texture of a cube of half floats with all its levels. */
export async function cubeTexture(file) {
  const { width, height, levels } = await read(file);
  const faces = Array.from({ length: 6 }, (_, face) => ({
    width,
    height,
    mipmaps: levels.map(({ texels }, level) => {
      const data = new Uint16Array(texels);
      const length = data.length / 6;
      return { data: data.subarray(face * length, (face + 1) * length), width: width >> level, height: height >> level };
    }),
  }));
  const texture = new CompressedCubeTexture(faces, RGBAFormat, HalfFloatType);
  texture.minFilter = levels.length > 1 ? LinearMipmapLinearFilter : LinearFilter;
  texture.magFilter = LinearFilter;
  texture.generateMipmaps = false;
  texture.needsUpdate = true;
  return texture;
}

/** Size and texels of a file. */
async function read(file) {
  const view = new DataView(file);
  if (file.byteLength < 104 || view.getUint32(0, false) !== 0xab4b5458) throw new Error("this is no KTX2 file");
  const long = (at) => Number(view.getBigUint64(at, true));
  const isCompressed = view.getUint32(44, true) === ZSTD;
  const levels = [];
  for (let level = 0; level < Math.max(view.getUint32(40, true), 1); level++) {
    const [offset, length, whole] = [0, 8, 16].map((at) => long(80 + 24 * level + at));
    const texels = file.slice(offset, offset + length);
    levels.push({ texels: isCompressed ? await unpack(texels, whole) : texels });
  }
  return { width: view.getUint32(20, true), height: view.getUint32(24, true), levels };
}

let decoder;

async function unpack(texels, length) {
  decoder ??= new ZSTDDecoder();
  await decoder.init();
  return decoder.decode(new Uint8Array(texels), length).slice().buffer;
}

/** Texels of 10, 10, 10 and 2 bits as half floats. */
function halves(words) {
  const texels = new Uint16Array(4 * words.length);
  words.forEach((word, i) => {
    for (let channel = 0; channel < 3; channel++) texels[4 * i + channel] = DataUtils.toHalfFloat(((word >>> (10 * channel)) & 1023) / 1023);
    texels[4 * i + 3] = DataUtils.toHalfFloat((word >>> 30) / 3);
  });
  return texels;
}
