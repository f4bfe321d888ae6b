// What the tests of hosts share: a folder for pictures, the first argument of the test; the program that bakes; lines that hold or fail; the ball of
// `luthier preview`; and materials of a set. The environment variable LUTHIER names the program; by default cargo builds it.

import { execFile } from "node:child_process";
import { mkdir, writeFile } from "node:fs/promises";
import path from "node:path";
import { promisify } from "node:util";
import { difference, isLit } from "./difference.mjs";

/** The repository, and the folder of the pictures. */
export const root = path.join(import.meta.dirname, "../..");
export const out = process.argv[2] && path.resolve(process.argv[2]);
if (!out) {
  console.error(`usage: node ${path.relative(process.cwd(), process.argv[1])} OUT`);
  process.exit(2);
}
await mkdir(out, { recursive: true });

/** A path in that folder. */
export const file = (name) => path.join(out, name);

/** What a program says. */
export const call = async (program, args) => (await promisify(execFile)(program, args, { cwd: root, maxBuffer: 1 << 26 })).stdout;
const CARGO = ["run", "--locked", "--quiet", "-p", "luthier-cli", "--bin", "luthier", "--"];
export const luthier = (...args) => (process.env.LUTHIER ? call(process.env.LUTHIER, args) : call("cargo", [...CARGO, ...args]));

/** The figures of a page, an HTML file, with a bake and a description. The picture has the name. */
export async function show(html, bake, description, name) {
  await writeFile(file(`${name}.json`), JSON.stringify(description));
  return call("node", [path.join(root, "examples/browser.mjs"), html, bake, file(`${name}.json`), file(`${name}.png`)]);
}

const failures = [];
export function check(holds, words) {
  console.log(`${holds ? "holds" : "FAILS"}: ${words}`);
  if (!holds) failures.push(words);
}

/** Ends the test: with 1 where a line failed. */
export function finish() {
  if (failures.length) console.error(`${failures.length} failed:\n${failures.join("\n")}`);
  process.exit(failures.length ? 1 : 0);
}

/** The camera of `preview --shape sphere`, 7 away, and its lamps, which have a size. */
export const LAMP = [1.75, 1.7, 1.62];
export const BALL = { size: 256, fov_y_deg: (360 / Math.PI) * Math.atan(1.22 / 7), eye_distance: 7, slope_variance: 0.05 ** 2 / 8, background: [0, 0, 0] };
const PREVIEW = ["--shape", "sphere", "--size", "256", "--samples", "1", "--tone", "none", "--light-color", LAMP.join(), "--background"];

/** Options of `preview` without light from all around. */
export const DARK = ["--environment", file("black.hdr"), "--environment-samples", "1"];

// Two texels of no light, and of a radiance of one half.
const even = (byte) => Buffer.concat([Buffer.from("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 2\n"), Buffer.alloc(8, byte)]);
await writeFile(file("black.hdr"), even(0));
await writeFile(file("grey.hdr"), even(128));

/** The ball of a material by `luthier preview`. */
export const preview = (material, bake, picture, options) => luthier("preview", material, "--out", bake, "-o", picture, ...PREVIEW, ...options);

/** Compares a picture with one of `preview`, whose options decide what is behind the ball. */
export async function compare(name, by, expected, found, options = DARK) {
  // Behind the ball there is the environment in one, and nothing in the other.
  const shown = options.includes("--environment-samples") ? undefined : (_, pixel) => isLit(pixel);
  const { median, p95, p99, most, pixels } = await difference(expected, found, shown);
  // A texture that is misread makes 5 or more in the 95 %.
  check(median <= 2 && p95 <= 3, `${name} by ${by} against preview: median ${median} of 255, 95 % within ${p95}, 99 % within ${p99}, largest ${most}, ${pixels} pixels`);
}

/** A varnish over a metal or a paint. */
const paint = (i) => {
  const hue = (shift) => (0.5 + 0.4 * Math.cos(2 * Math.PI * (i / 55 + shift))).toFixed(3);
  return `schema = 1
name = "paint-${i}"
description = "A varnished paint."
references = []

[[layer]]
type = "dielectric"
ior = 1.5
roughness = ${(0.1 + 0.005 * i).toFixed(3)}

[[layer]]
type = "metallic-roughness"
base_color = [${hue(0)}, ${hue(1 / 3)}, ${hue(2 / 3)}]
metallic = ${i % 2}.0
roughness = ${(0.3 + 0.01 * i).toFixed(2)}
`;
};

/** A folder of 55 material files. */
export async function paints() {
  await mkdir(file("paints"), { recursive: true });
  for (let i = 0; i < 55; i++) await writeFile(file(`paints/paint-${i}.toml`), paint(i));
  return file("paints");
}
