// Two bakes with prefixes in one program of WebGPU, in Chromium with the software driver: node test.mjs OUT. Each ball is that of `luthier preview`.
// Needs a Vulkan driver. The environment variable LUTHIER names the program that bakes; by default cargo builds it. CHROMIUM names the browser.

import { execFile } from "node:child_process";
import { mkdir, writeFile } from "node:fs/promises";
import path from "node:path";
import { promisify } from "node:util";
import { difference } from "./difference.mjs";

const here = import.meta.dirname;
const root = path.join(here, "../..");
const out = process.argv[2] && path.resolve(process.argv[2]);
if (!out) {
  console.error("usage: node test.mjs OUT");
  process.exit(2);
}
await mkdir(out, { recursive: true });

const call = async (program, args) => (await promisify(execFile)(program, args, { cwd: root, maxBuffer: 1 << 26 })).stdout;
const CARGO = ["run", "--locked", "--quiet", "-p", "luthier-cli", "--bin", "luthier", "--"];
const luthier = (...args) => (process.env.LUTHIER ? call(process.env.LUTHIER, args) : call("cargo", [...CARGO, ...args]));

const file = (name) => path.join(out, name);
const bakes = [
  { folder: "car", material: "red-lacquer", from: "materials/red-lacquer.toml", first: 0 },
  { folder: "room", material: "polished-gold", from: "materials/polished-gold.toml", first: 16 },
];
for (const { folder, from, first } of bakes) {
  const names = ["--prefix", folder, "--first-binding", String(first)];
  await luthier("bake", from, "--no-fit", "--no-zstd", "--layout", "filtered", "--functions", "surface", "--target", "wgsl", "--form", "baked", "--quiet", ...names, "--out", file(folder));
}

// The camera and the lamp of `preview --shape sphere`; its lamps have a size. Behind them there is nothing.
const LAMP = [1.75, 1.7, 1.62];
const scene = { size: 256, fov_y_deg: (360 / Math.PI) * Math.atan(1.22 / 7), eye_distance: 7, light: [0.5, 0.7, 0.6], irradiance: LAMP, slope_variance: 0.05 ** 2 / 8 };
const preview = ["--shape", "sphere", "--size", "256", "--samples", "1", "--tone", "none", "--light", "0.5,0.7,0.6", "--light-color", LAMP.join(), "--background"];
await writeFile(file("black.hdr"), Buffer.concat([Buffer.from("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 2\n"), Buffer.alloc(8)]));

let failed = false;
for (const [show, { folder, material }] of bakes.entries()) {
  await luthier("preview", material, "--out", file(folder), "-o", file(`${folder}-preview.png`), ...preview, "--environment", file("black.hdr"), "--environment-samples", "1");
  await writeFile(file(`${folder}.json`), JSON.stringify({ ...scene, bakes: bakes.map(({ folder, material }) => ({ folder, material })), show }));
  await call("node", [path.join(here, "../browser.mjs"), path.join(here, "packages.html"), out, file(`${folder}.json`), file(`${folder}.png`)]);
  const { median, p95, p99, most, pixels } = await difference(file(`${folder}-preview.png`), file(`${folder}.png`));
  const holds = median <= 2 && p95 <= 3;
  console.log(`${holds ? "holds" : "FAILS"}: ${material} in ${folder} by WebGPU against preview: median ${median} of 255, 95 % within ${p95}, 99 % within ${p99}, largest ${most}, ${pixels} pixels`);
  failed ||= !holds;
}
process.exit(failed ? 1 : 0);
