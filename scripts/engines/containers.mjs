// Containers of textures: the KTX2 that luthier writes, and DDS, which Babylon.js loads.

const KTX2 = Buffer.from([0xab, 0x4b, 0x54, 0x58, 0x20, 0x32, 0x30, 0xbb, 0x0d, 0x0a, 0x1a, 0x0a]);
const VK_FORMAT_R16G16_SFLOAT = 83;

/** Texels of the first level of a KTX2 file of two half floats, without zstd. */
export function readKtx2(bytes) {
  if (!KTX2.equals(bytes.subarray(0, 12))) throw new Error("no KTX2");
  const [format, , width, height] = [12, 16, 20, 24].map((at) => bytes.readUInt32LE(at));
  if (format !== VK_FORMAT_R16G16_SFLOAT || bytes.readUInt32LE(44) !== 0) throw new Error("only R16G16_SFLOAT, not compressed");
  const at = Number(bytes.readBigUInt64LE(80));
  return { size: [width, height], texels: bytes.subarray(at, at + width * height * 4) };
}

const DXGI_FORMAT_R16G16B16A16_FLOAT = 10;

/** A DDS file of four half floats, with the DX10 header. */
export function dds(width, height, texels) {
  const head = Buffer.alloc(148);
  head.write("DDS ", 0, "latin1");
  // Size of the header; flags: caps, height, width, pitch, pixel format.
  [124, 0x100f, height, width, width * 8].forEach((value, i) => head.writeUInt32LE(value, 4 + 4 * i));
  head.writeUInt32LE(1, 28);
  head.writeUInt32LE(32, 76);
  head.writeUInt32LE(4, 80);
  head.write("DX10", 84, "latin1");
  head.writeUInt32LE(0x1000, 108);
  // Format, a two-dimensional texture, one of it.
  [DXGI_FORMAT_R16G16B16A16_FLOAT, 3, 0, 1, 0].forEach((value, i) => head.writeUInt32LE(value, 128 + 4 * i));
  return Buffer.concat([head, texels]);
}

/** An OpenEXR file of half floats, without compression: `texels` are of four channels, of which it has the first three. */
export function exr(width, height, texels) {
  const attribute = (name, kind, body) => {
    const size = Buffer.alloc(4);
    size.writeUInt32LE(body.length);
    return Buffer.concat([Buffer.from(`${name}\0${kind}\0`, "latin1"), size, body]);
  };
  const ints = (...values) => {
    const bytes = Buffer.alloc(4 * values.length);
    values.forEach((value, i) => bytes.writeInt32LE(value, 4 * i));
    return bytes;
  };
  const floats = (...values) => {
    const bytes = Buffer.alloc(4 * values.length);
    values.forEach((value, i) => bytes.writeFloatLE(value, 4 * i));
    return bytes;
  };
  // Half floats, in the order of their names.
  const channels = Buffer.concat(["B", "G", "R"].map((name) => Buffer.concat([Buffer.from(`${name}\0`, "latin1"), ints(1, 0, 1, 1)])));
  const box = ints(0, 0, width - 1, height - 1);
  const head = Buffer.concat([
    ints(20000630, 2),
    attribute("channels", "chlist", Buffer.concat([channels, Buffer.alloc(1)])),
    attribute("compression", "compression", Buffer.alloc(1)),
    attribute("dataWindow", "box2i", box),
    attribute("displayWindow", "box2i", box),
    attribute("lineOrder", "lineOrder", Buffer.alloc(1)),
    attribute("pixelAspectRatio", "float", floats(1)),
    attribute("screenWindowCenter", "v2f", floats(0, 0)),
    attribute("screenWindowWidth", "float", floats(1)),
    Buffer.alloc(1),
  ]);
  const line = 8 + width * 6;
  const offsets = Buffer.alloc(8 * height);
  const lines = Buffer.alloc(line * height);
  for (let y = 0; y < height; y++) {
    offsets.writeBigUInt64LE(BigInt(head.length + offsets.length + y * line), 8 * y);
    lines.writeInt32LE(y, y * line);
    lines.writeInt32LE(width * 6, y * line + 4);
    for (let channel = 0; channel < 3; channel++) {
      for (let x = 0; x < width; x++) {
        const word = texels.readUInt16LE(2 * (4 * (y * width + x) + 2 - channel));
        lines.writeUInt16LE(word, y * line + 8 + 2 * (channel * width + x));
      }
    }
  }
  return Buffer.concat([head, offsets, lines]);
}
