// RGBD, in which Babylon.js ships its tables: rgb = pow(c, 2.2) / a.

/** Values of a texel. */
export function decodeRgbd([r, g, b, a]) {
  return [r, g, b].map((code) => (code / 255) ** 2.2 / (a / 255));
}

/** Codes of texels of three channels: of all divisors the one whose worst channel errs least. */
export function encodeRgbd(texels) {
  const bytes = new Uint8Array(texels.length * 4);
  texels.forEach((texel, i) => {
    let least = Infinity;
    for (let a = 255; a > 0; a--) {
      const divisor = a / 255;
      const code = texel.map((value) => Math.min(255, Math.round(255 * (value * divisor) ** (1 / 2.2))));
      const worst = Math.max(...code.map((c, channel) => Math.abs((c / 255) ** 2.2 / divisor - texel[channel])));
      if (worst < least) {
        least = worst;
        bytes.set([...code, a], 4 * i);
      }
    }
  });
  return bytes;
}
