// Textures of WebGL 2 in the formats that bakes have. The page of `luthier gallery --html` and the example `examples/plain-webgl` share this file.

/** Formats of the manifest in the words of WebGL: internal format, format, type, and the array that holds texels. */
export const textureFormats = gl => ({
  rgba8unorm: [gl.RGBA8, gl.RGBA, gl.UNSIGNED_BYTE, Uint8Array],
  rgb10a2unorm: [gl.RGB10_A2, gl.RGBA, gl.UNSIGNED_INT_2_10_10_10_REV, Uint32Array],
  rg11b10ufloat: [gl.R11F_G11F_B10F, gl.RGB, gl.UNSIGNED_INT_10F_11F_11F_REV, Uint32Array],
  r16float: [gl.R16F, gl.RED, gl.HALF_FLOAT, Uint16Array],
  rg16float: [gl.RG16F, gl.RG, gl.HALF_FLOAT, Uint16Array],
  rgba16float: [gl.RGBA16F, gl.RGBA, gl.HALF_FLOAT, Uint16Array],
  r32float: [gl.R32F, gl.RED, gl.FLOAT, Float32Array],
  rgba32float: [gl.RGBA32F, gl.RGBA, gl.FLOAT, Float32Array],
  "rgba16float-steps": [gl.RGBA32UI, gl.RGBA_INTEGER, gl.UNSIGNED_INT, Uint32Array],
});

/**
 * A texture of one level, which ends at its edges. Texels are an array or an ArrayBuffer, or null for none yet. Tables are filtered where WebGL filters
 * their format; of 32-bit floats and whole numbers, which it does not, shaders read single texels.
 */
export function makeTexture(gl, { format, width, height, texels, filter }) {
  const formats = textureFormats(gl);
  if (!(format in formats)) throw new Error(`WebGL 2 has no ${format} without an extension`);
  const [internal, layout, type, Texels] = formats[format];
  const texture = gl.createTexture();
  gl.bindTexture(gl.TEXTURE_2D, texture);
  gl.pixelStorei(gl.UNPACK_ALIGNMENT, 1);
  gl.texImage2D(gl.TEXTURE_2D, 0, internal, width, height, 0, layout, type, texels && new Texels(texels));
  const filtered = filter ?? ([gl.FLOAT, gl.UNSIGNED_INT].includes(type) ? gl.NEAREST : gl.LINEAR);
  for (const name of [gl.TEXTURE_MIN_FILTER, gl.TEXTURE_MAG_FILTER]) gl.texParameteri(gl.TEXTURE_2D, name, filtered);
  for (const name of [gl.TEXTURE_WRAP_S, gl.TEXTURE_WRAP_T]) gl.texParameteri(gl.TEXTURE_2D, name, gl.CLAMP_TO_EDGE);
  return texture;
}
