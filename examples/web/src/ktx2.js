// KTX2 files of `luthier bake` and `luthier environment`: raw texels, plain or compressed with zstd.

const ZSTD = 2;

/** Size and levels of a file; each level is an ArrayBuffer of its texels, those of a cube face by face. `unzstd(bytes, length)` is a decoder of zstd. */
export async function readKtx2(file, unzstd) {
  const view = new DataView(file);
  if (file.byteLength < 104 || view.getUint32(0, false) !== 0xab4b5458) throw new Error("this is no KTX2 file");
  const long = (at) => Number(view.getBigUint64(at, true));
  const isCompressed = view.getUint32(44, true) === ZSTD;
  const levels = [];
  for (let level = 0; level < Math.max(view.getUint32(40, true), 1); level++) {
    const [offset, length, whole] = [0, 8, 16].map((at) => long(80 + 24 * level + at));
    const texels = file.slice(offset, offset + length);
    levels.push(isCompressed ? (await unzstd(new Uint8Array(texels), whole)).slice().buffer : texels);
  }
  return { width: view.getUint32(20, true), height: view.getUint32(24, true), levels };
}

/** Texels of 10, 10, 10 and 2 bits as half floats, RGBA, for hosts without such texels. A half float is off by a quarter of their step at most. */
export function toHalfFloats(texels) {
  const words = new Uint32Array(texels);
  const halves = new Uint16Array(4 * words.length);
  words.forEach((word, i) => {
    for (let channel = 0; channel < 3; channel++) halves[4 * i + channel] = half(((word >>> (10 * channel)) & 1023) / 1023);
    halves[4 * i + 3] = half((word >>> 30) / 3);
  });
  return halves;
}

const float = new Float32Array(1);
const bits = new Uint32Array(float.buffer);

/** The half float of a number that is 0, or from 2^-14 up to 1. */
function half(value) {
  float[0] = value;
  // Half a step is added, so that bits that are cut off round.
  return value && ((bits[0] + 0x1000) >>> 13) - (112 << 10);
}
