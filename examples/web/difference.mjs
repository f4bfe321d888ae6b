// How far two PNG files are apart: node difference.mjs A B [MEDIAN [MOST OF 95 %]] prints it, and fails where a limit is exceeded. Numbers are differences
// of the channel that is farthest, 0 to 255. Pixels that are black in both are left out.

import { readFile } from "node:fs/promises";
import path from "node:path";
import { fileURLToPath } from "node:url";
import { inflateSync } from "node:zlib";

/** Median, 95 %, 99 % and the largest difference, and the number of pixels. `shown` tells of a pixel of each picture whether it counts. */
export async function difference(a, b, shown = (p, q) => isLit(p) || isLit(q)) {
  const [left, right] = await Promise.all([a, b].map(read));
  if (left.width !== right.width || left.height !== right.height) throw new Error(`${a} and ${b} differ in size`);
  const apart = [];
  for (let i = 0; i < left.width * left.height; i++) {
    const [p, q] = [left, right].map(({ texels, channels }) => texels.subarray(channels * i, channels * i + 3));
    if (shown(p, q)) apart.push(Math.max(...[0, 1, 2].map((c) => Math.abs(p[c] - q[c]))));
  }
  if (!apart.length) throw new Error(`${a} and ${b} are black`);
  apart.sort((x, y) => x - y);
  const at = (share) => apart[Math.min(Math.floor(share * apart.length), apart.length - 1)];
  return { pixels: apart.length, median: at(0.5), p95: at(0.95), p99: at(0.99), most: apart.at(-1) };
}

export const isLit = (pixel) => pixel.some((value) => value > 0);

/** Texels of a PNG of 8-bit RGB or RGBA. */
async function read(file) {
  const bytes = await readFile(file);
  const data = [];
  let head;
  for (let at = 8; at < bytes.length; at += 12 + bytes.readUInt32BE(at)) {
    const chunk = bytes.subarray(at + 8, at + 8 + bytes.readUInt32BE(at));
    const name = bytes.toString("latin1", at + 4, at + 8);
    if (name === "IHDR") head = chunk;
    if (name === "IDAT") data.push(chunk);
  }
  const [width, height, channels] = [head.readUInt32BE(0), head.readUInt32BE(4), { 2: 3, 6: 4 }[head[9]]];
  if (head[8] !== 8 || !channels) throw new Error(`${file} is no PNG of 8-bit RGB`);
  const rows = inflateSync(Buffer.concat(data));
  const texels = new Uint8Array(width * height * channels);
  const stride = width * channels;
  for (let y = 0; y < height; y++) {
    const filter = rows[y * (stride + 1)];
    for (let x = 0; x < stride; x++) {
      const left = x >= channels ? texels[y * stride + x - channels] : 0;
      const above = y ? texels[(y - 1) * stride + x] : 0;
      const corner = x >= channels && y ? texels[(y - 1) * stride + x - channels] : 0;
      const guess = [0, left, above, (left + above) >> 1, paeth(left, above, corner)][filter];
      texels[y * stride + x] = rows[y * (stride + 1) + 1 + x] + guess;
    }
  }
  return { width, height, channels, texels };
}

function paeth(left, above, corner) {
  const [a, b, c] = [left, above, corner].map((value) => Math.abs(left + above - corner - value));
  return a <= b && a <= c ? left : b <= c ? above : corner;
}

if (process.argv[1] === fileURLToPath(import.meta.url)) {
  const [a, b, ...limits] = process.argv.slice(2);
  const { pixels, median, p95, p99, most } = await difference(a, b);
  console.log(`${path.basename(b)}: median ${median}, 95 % within ${p95}, 99 % within ${p99}, largest ${most}, of ${pixels} pixels`);
  if (median > Number(limits[0] ?? Infinity) || p95 > Number(limits[1] ?? Infinity)) process.exitCode = 1;
}
