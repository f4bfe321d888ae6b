// Textures of PlayCanvas: tables and cubes of KTX2 files, whose texels are uploaded as they are, and maps of pictures.

import {
  ADDRESS_CLAMP_TO_EDGE, ADDRESS_REPEAT, FILTER_LINEAR, FILTER_LINEAR_MIPMAP_LINEAR, FILTER_NEAREST, PIXELFORMAT_111110F, PIXELFORMAT_R16F, PIXELFORMAT_R32F, PIXELFORMAT_RG16F,
  PIXELFORMAT_RGB10A2, PIXELFORMAT_RGBA16F, PIXELFORMAT_RGBA32F, PIXELFORMAT_RGBA8, PIXELFORMAT_SRGBA8, Texture,
} from "playcanvas";
import { decompress } from "fzstd";
import { readKtx2 } from "luthier-web";

/** Formats of the manifest in the words of PlayCanvas, and the array that holds texels. */
const FORMATS = {
  r16float: [PIXELFORMAT_R16F, Uint16Array],
  rg16float: [PIXELFORMAT_RG16F, Uint16Array],
  rgba16float: [PIXELFORMAT_RGBA16F, Uint16Array],
  rgba8unorm: [PIXELFORMAT_RGBA8, Uint8Array],
  rgb10a2unorm: [PIXELFORMAT_RGB10A2, Uint32Array],
  rg11b10ufloat: [PIXELFORMAT_111110F, Uint32Array],
  r32float: [PIXELFORMAT_R32F, Float32Array],
  rgba32float: [PIXELFORMAT_RGBA32F, Float32Array],
};

const unzstd = (bytes, length) => decompress(bytes, new Uint8Array(length));
const CLAMPED = { addressU: ADDRESS_CLAMP_TO_EDGE, addressV: ADDRESS_CLAMP_TO_EDGE };

/** The texture of a table. 32-bit floats are read texel by texel. */
export async function tableTexture(device, name, file, format) {
  if (!(format in FORMATS)) throw new Error(`PlayCanvas has no texels of ${format}: bake with --no-search, or ask for another format in the material file`);
  const { width, height, levels } = await readKtx2(file, unzstd);
  const [known, Texels] = FORMATS[format];
  const filter = Texels === Float32Array ? FILTER_NEAREST : FILTER_LINEAR;
  return new Texture(device, { name, width, height, format: known, mipmaps: false, minFilter: filter, magFilter: filter, ...CLAMPED, levels: [new Texels(levels[0])] });
}

/** The material buffer as a texture, because GLSL ES 3.00 has no storage buffers. */
export function wordsTexture(device, { width, height }, words) {
  return Texture.createDataTexture2D(device, "luthier_materials", width, height, PIXELFORMAT_RGBA32F, [words]);
}

/** The texture of a cube of half floats with all its levels. */
export async function cubeTexture(device, name, file) {
  const { width, height, levels } = await readKtx2(file, unzstd);
  const faces = levels.map((level) => {
    const texels = new Uint16Array(level);
    const length = texels.length / 6;
    return Array.from({ length: 6 }, (_, face) => texels.slice(face * length, (face + 1) * length));
  });
  // PlayCanvas wants levels down to one texel. The shader reads none beyond those of the file.
  for (let size = width >> faces.length; faces.length > 1 && size > 0; size >>= 1) faces.push(faces.at(-1).map((texels) => texels.slice(0, 4 * size * size)));
  return cube(device, name, width, height, faces);
}

/** A cube without light, of one texel a face. */
export function blackCube(device, name) {
  return cube(device, name, 1, 1, [Array.from({ length: 6 }, () => new Uint16Array(4))]);
}

function cube(device, name, width, height, levels) {
  const mipmaps = levels.length > 1;
  const minFilter = mipmaps ? FILTER_LINEAR_MIPMAP_LINEAR : FILTER_LINEAR;
  return new Texture(device, { name, cubemap: true, width, height, format: PIXELFORMAT_RGBA16F, mipmaps, numLevels: levels.length, minFilter, magFilter: FILTER_LINEAR, ...CLAMPED, levels });
}

/** The texture of a map: its first row is at v = 0, and its numbers are those of the file. The browser reads 16 bits as 8. */
export async function mapTexture(device, url, { slot, srgb }, mipmaps) {
  const response = await fetch(url);
  if (!response.ok) throw new Error(`${url}: ${response.status} ${response.statusText}`);
  const picture = await createImageBitmap(await response.blob(), { premultiplyAlpha: "none", colorSpaceConversion: "none" });
  const isCells = slot === "flake-normal";
  const texture = new Texture(device, {
    name: url.pathname.split("/").at(-1),
    width: picture.width,
    height: picture.height,
    format: srgb ? PIXELFORMAT_SRGBA8 : PIXELFORMAT_RGBA8,
    mipmaps: mipmaps && !isCells,
    minFilter: isCells ? FILTER_NEAREST : mipmaps ? FILTER_LINEAR_MIPMAP_LINEAR : FILTER_LINEAR,
    magFilter: isCells ? FILTER_NEAREST : FILTER_LINEAR,
    addressU: ADDRESS_REPEAT,
    addressV: ADDRESS_REPEAT,
  });
  texture.setSource(picture);
  return texture;
}

/** One texel in place of the map that a material lacks. */
export function whiteTexture(device) {
  return new Texture(device, { name: "luthier_white", width: 1, height: 1, format: PIXELFORMAT_RGBA8, mipmaps: false, minFilter: FILTER_LINEAR, levels: [new Uint8Array(4).fill(255)] });
}
