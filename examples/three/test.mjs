// Tests of luthier-three in Chromium with the software driver, by WebGL 2 and by WebGPU: node test.mjs OUT. Pictures are left in OUT.
// - Balls against `luthier preview`: a plain and a textured material under one lamp, near a lamp, in an environment and in even light.
// - Three kinds of lamps with shadows, against sums of single ones. Fog, a tone curve, instances, skins and morph targets.
// - Sixty materials, five of them with textures: one program.
// - Wrong bakes are named.
// Needs a Vulkan driver and `npm ci` in this folder. The environment variable LUTHIER names the program that bakes; by default cargo builds it. CHROMIUM
// names the browser.

import { execFile } from "node:child_process";
import { mkdir, readFile, stat, writeFile } from "node:fs/promises";
import path from "node:path";
import { promisify } from "node:util";
import { difference, isLit } from "../web/difference.mjs";

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
const failures = [];
const check = (holds, words) => {
  console.log(`${holds ? "holds" : "FAILS"}: ${words}`);
  if (!holds) failures.push(words);
};

/** A page of this folder with a bake and a description; its figures. */
async function page(html, bake, description, name) {
  const scene = path.join(out, `${name}.json`);
  await writeFile(scene, JSON.stringify(description));
  return call("node", [path.join(root, "examples/browser.mjs"), path.join(here, html), bake, scene, path.join(out, `${name}.png`)]);
}

const BAKED = ["--target", "wgsl,glsl-es300", "--form", "baked", "--quiet", "--functions"];
const RENDERERS = ["webgl", "webgpu"];

/** The camera of `preview --shape sphere`, 7 away, and its lamps, which have a size. */
const LAMP = [1.75, 1.7, 1.62];
const BALL = { size: 256, fov_y_deg: (360 / Math.PI) * Math.atan(1.22 / 7), eye_distance: 7, slope_variance: 0.05 ** 2 / 8, background: [0, 0, 0] };
const PREVIEW = ["--shape", "sphere", "--size", "256", "--samples", "1", "--tone", "none", "--light-color", LAMP.join(), "--background"];
const DARK = ["--environment", path.join(out, "black.hdr"), "--environment-samples", "1"];

async function balls() {
  // Two texels of no light, and of a radiance of one half.
  const even = (byte) => Buffer.concat([Buffer.from("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 2\n"), Buffer.alloc(8, byte)]);
  await writeFile(path.join(out, "black.hdr"), even(0));
  await writeFile(path.join(out, "grey.hdr"), even(128));
  const plain = path.join(out, "plain");
  const board = path.join(out, "board");
  const packed = path.join(out, "packed");
  const film = path.join(out, "film");
  await luthier("bake", "materials/polished-gold.toml", "materials/red-lacquer.toml", "materials/copper-patina.toml", "--out", plain, ...BAKED, "surface,environment,albedo");
  await luthier("bake", "materials/textured", "--no-fit", "--out", board, ...BAKED, "surface");
  await luthier("bake", "materials/papers/granier-film.toml", "--out", film, ...BAKED, "surface");
  // A limit on the error chooses texels that three.js does not have.
  await luthier("bake", "materials/polished-gold.toml", "--no-fit", "--max-abs", "3e-3", "--out", packed, ...BAKED, "surface");
  check((await readFile(path.join(packed, "manifest.json"), "utf8")).includes('"format": "rgb10a2unorm"'), "a bake has texels of 10 bits");
  await luthier("environment", "--sky", "strip-studio", "--layout", "cube", "--out", path.join(out, "studio"));

  const far = { lights: [{ direction: [0.5, 0.7, 0.6], irradiance: LAMP }] };
  const near = { lights: [{ position: [1, 1.5, 2], irradiance: LAMP }] };
  const [from, at] = [["--light", "0.5,0.7,0.6"], ["--point-light", "1,1.5,2"]];
  const cases = [
    ["gold", "polished-gold", plain, far, [...from, ...DARK]],
    ["packed-gold", "polished-gold", packed, far, [...from, ...DARK]],
    ["lacquer", "red-lacquer", plain, far, [...from, ...DARK]],
    ["near-lacquer", "red-lacquer", plain, near, [...at, ...DARK]],
    ["lit-lacquer", "red-lacquer", plain, { lights: [], slope_variance: 0, environment: "studio/environment.json" }, ["--sky", "strip-studio"]],
    ["even-lacquer", "red-lacquer", plain, { lights: [{ radiance: [0.5, 0.5, 0.5] }] }, ["--environment", path.join(out, "grey.hdr")]],
    ["patina", "copper-patina", plain, far, [...from, ...DARK]],
    ["film", "granier-film", film, far, [...from, ...DARK]],
    ["brass", "worn-brass", board, far, [...from, ...DARK]],
    ["tile", "celadon-tile", board, far, [...from, ...DARK]],
  ];
  for (const [name, material, bake, lit, options] of cases) {
    const expected = path.join(out, `${name}-preview.png`);
    await luthier("preview", material, "--out", bake, "-o", expected, ...PREVIEW, ...options);
    for (const renderer of RENDERERS) {
      await page("index.html", bake, { ...BALL, ...lit, renderer, material }, `${name}-${renderer}`);
      // Behind the ball there is the environment in one, and nothing in the other.
      const shown = options.includes("--environment-samples") ? undefined : (_, pixel) => isLit(pixel);
      const { median, p95, p99, most, pixels } = await difference(expected, path.join(out, `${name}-${renderer}.png`), shown);
      // A texture that is misread makes 5 or more in the 95 %.
      check(median <= 2 && p95 <= 3, `${name} by ${renderer} against preview: median ${median} of 255, 95 % within ${p95}, 99 % within ${p99}, largest ${most}, ${pixels} pixels`);
    }
  }

  // A tone curve of three.js, by its two renderers; without it the pictures are others.
  const toned = (renderer) => path.join(out, `toned-${renderer}.png`);
  for (const renderer of RENDERERS) {
    await page("index.html", plain, { ...BALL, ...far, renderer, material: "red-lacquer", tone: "ACESFilmicToneMapping" }, `toned-${renderer}`);
  }
  const [same, other] = [await difference(...RENDERERS.map(toned)), await difference(toned("webgl"), path.join(out, "lacquer-webgl.png"))];
  check(same.p99 <= 1 && other.median > 5, `a tone curve: ${same.p99} of 255 between the renderers (99 %), ${other.median} against none (median)`);
  return plain;
}

async function lamps(bake) {
  for (const renderer of RENDERERS) {
    const { lit, shadowed, sum_off, spot_off, outside_of_cone, programs, fog_off } = JSON.parse(
      await page("test.html", bake, { renderer, scene: "lights", material: "red-lacquer", floor: "red-lacquer" }, `lights-${renderer}`),
    );
    for (const kind of Object.keys(lit)) {
      check(lit[kind] > 1000 && shadowed[kind] > 300, `a ${kind} lamp by ${renderer}: ${lit[kind]} pixels lit, ${shadowed[kind]} of them in its shadow`);
    }
    check(sum_off < 1e-5, `three lamps by ${renderer} are the sum of single ones: ${sum_off.toExponential(1)} of the brightest off`);
    check(spot_off < 1e-3 && outside_of_cone > 1000, `a spot by ${renderer} is a lamp within its cone: ${spot_off.toExponential(1)} off, ${outside_of_cone} pixels outside`);
    check(fog_off < 1e-3, `thick fog by ${renderer} has its colour: ${fog_off.toExponential(1)} off`);
    // The other renderer counts programs of shadows, too.
    if (renderer === "webgl") check(programs === 1, `a ball and a floor by ${renderer}: ${programs} program`);
  }
}

async function moved(bake) {
  for (const renderer of RENDERERS) {
    const { off, lit } = JSON.parse(await page("test.html", bake, { renderer, scene: "moved" }, `moved-${renderer}`));
    check(off < 1e-3 && lit > 10000, `instances, a skin and a morph target by ${renderer} are where meshes are: ${off.toExponential(1)} off, ${lit} pixels`);
  }
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

async function sixty() {
  const paints = path.join(out, "paints");
  await mkdir(paints, { recursive: true });
  for (let i = 0; i < 55; i++) await writeFile(path.join(paints, `paint-${i}.toml`), paint(i));
  const bake = path.join(out, "sixty");
  await luthier("bake", paints, "materials/textured", "--no-fit", "--out", bake, ...BAKED, "surface");
  const manifest = JSON.parse(await readFile(path.join(bake, "manifest.json")));
  const size = async (files) => (await Promise.all([...new Set(files)].map((file) => stat(path.join(bake, file))))).reduce((sum, { size }) => sum + size, 0);
  const tables = await size([...manifest.tables.map(({ texture }) => texture.path), manifest.material_buffer.path]);
  const maps = await size(manifest.materials.flatMap(({ maps }) => maps.map(({ file }) => file.path)));
  const shader = await size(manifest.shaders.filter(({ target }) => target === "glsl-es300").map(({ file }) => file.path));
  console.log(`sixty materials: ${tables} bytes of tables and numbers, ${shader} of shader (GLSL), ${maps} of maps`);
  for (const renderer of RENDERERS) {
    const { materials, programs, first_ms, frame_ms } = JSON.parse(await page("test.html", bake, { renderer, scene: "set" }, `sixty-${renderer}`));
    check(materials === 60 && programs === 1, `${materials} materials by ${renderer}, ${programs} program: first frame ${first_ms} ms, then ${frame_ms} ms a frame of 512 x 512`);
  }
}

/** Bakes that the loader refuses, and a word of the reason. */
async function refusals() {
  const bake = path.join(out, "refused");
  const lacquer = ["bake", "materials/polished-gold.toml", "--no-fit", "--quiet", "--out", bake];
  const refused = async (word, change = (manifest) => manifest) => {
    const file = path.join(bake, "manifest.json");
    await writeFile(file, change(await readFile(file, "utf8")));
    const said = await page("index.html", bake, { ...BALL, lights: [], material: "polished-gold" }, "refused").then(() => "nothing", ({ stderr }) => stderr);
    check(said.includes(word), `a bake is refused: ${said.match(/Error: (.*)/)?.[1] ?? said}`);
  };
  await luthier(...lacquer);
  await refused("--functions surface");
  await luthier(...lacquer, "--target", "glsl-es300", "--functions", "surface", "--prefix", "gold");
  await refused("without --prefix");
  await luthier(...lacquer, "--target", "wgsl", "--functions", "surface");
  await refused("--target glsl-es300");
  await refused("schema 5", (manifest) => manifest.replace('"schema": 4', '"schema": 5'));
  await refused("no JSON", (manifest) => manifest.slice(1));
}

const plain = await balls();
await lamps(plain);
await moved(plain);
await sixty();
await refusals();
if (failures.length) {
  console.error(`${failures.length} failed:\n${failures.join("\n")}`);
  process.exit(1);
}
