// KTX2 files of `luthier bake` and `luthier environment` as textures of three.js.

import {
  CompressedCubeTexture, DataTexture, FloatType, HalfFloatType, LinearFilter, LinearMipmapLinearFilter, NearestFilter, NearestMipmapNearestFilter, RedFormat, RGBAFormat,
  RGBFormat, RGFormat, UnsignedByteType, UnsignedInt101111Type,
} from "three";
import { ZSTDDecoder } from "three/addons/libs/zstddec.module.js";
import { readKtx2, toHalfFloats } from "luthier-web";

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
  const { width, height, levels } = await readKtx2(file, unzstd);
  let [texels, known] = [levels[0], format];
  // three.js has no such texels.
  if (format === "rgb10a2unorm") [texels, known] = [toHalfFloats(texels).buffer, "rgba16float"];
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
  const { width, height, levels } = await readKtx2(file, unzstd);
  const faces = Array.from({ length: 6 }, (_, face) => ({
    width,
    height,
    mipmaps: levels.map((texels, level) => {
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

let decoder;

async function unzstd(bytes, length) {
  decoder ??= new ZSTDDecoder();
  await decoder.init();
  return decoder.decode(bytes, length);
}
