// Half floats, which this JavaScript has no array of.

/** Bits of the half float next to a value of at least 0, ties to even. */
export function toHalf(value) {
  if (!(value >= 0 && value < 65520)) throw new RangeError(`${value} is no half float of at least 0`);
  if (value < 2 ** -14) return roundEven(value * 2 ** 24);
  const exponent = Math.floor(Math.log2(value));
  // The logarithm may round up to a power of two.
  const e = value < 2 ** exponent ? exponent - 1 : exponent;
  return roundEven((value / 2 ** e - 1) * 1024) + ((e + 15) << 10);
}

/** Value of a half float of at least 0. */
export function fromHalf(bits) {
  const e = (bits >> 10) & 31;
  return e === 0 ? (bits & 1023) * 2 ** -24 : (1 + (bits & 1023) / 1024) * 2 ** (e - 15);
}

/** Words of half floats as bytes, little-endian. */
export function halfBytes(words) {
  const bytes = Buffer.alloc(words.length * 2);
  words.forEach((bits, i) => bytes.writeUInt16LE(bits, i * 2));
  return bytes;
}

/** Values as bytes of 32-bit floats, little-endian. */
export function floatBytes(values) {
  const bytes = Buffer.alloc(values.length * 4);
  values.forEach((value, i) => bytes.writeFloatLE(value, i * 4));
  return bytes;
}

function roundEven(value) {
  const down = Math.floor(value);
  const rest = value - down;
  return rest > 0.5 || (rest === 0.5 && down % 2 === 1) ? down + 1 : down;
}
