// Tests of luthier-babylon in Chromium with the software driver, by the WebGL 2 engine and the WebGPU engine: node test.mjs OUT [NAME...]. Pictures are left in
// OUT. Names are those of balls, `lights`, `moved`, `sixty` and `refused`; by default all are run.
// - Balls against `luthier preview`: plain and textured materials, a film and a patina under one lamp, near a lamp, in an environment and in even light; in
//   left-handed and right-handed scenes.
// - Three kinds of lamps with shadows, against sums of single ones. Fog, a tone curve, instances, skins and morph targets.
// - Sixty materials, five of them with textures: one program.
// - Wrong bakes are named.
// Needs a Vulkan driver and `npm ci` in this folder. The environment variable LUTHIER names the program that bakes; by default cargo builds it. CHROMIUM
// names the browser.

import { readFile, writeFile } from "node:fs/promises";
import path from "node:path";
import { difference } from "../web/difference.mjs";
import { BALL, DARK, LAMP, check, compare, file, finish, luthier, out, paints, preview, show } from "../web/workshop.mjs";

/** A page of this folder with a bake and a description; its figures. */
const page = (html, ...rest) => show(path.join(import.meta.dirname, html), ...rest);

const only = process.argv.slice(3);
const wanted = (name) => !only.length || only.includes(name);

const BAKED = ["--target", "wgsl,glsl-es300", "--form", "baked", "--quiet", "--functions"];
const RENDERERS = ["webgl", "webgpu"];

const BAKES = {
  plain: ["materials/polished-gold.toml", "materials/red-lacquer.toml", "materials/copper-patina.toml", ...BAKED, "surface,environment,albedo"],
  board: ["materials/textured", "--no-fit", ...BAKED, "surface"],
  film: ["materials/papers/granier-film.toml", ...BAKED, "surface"],
  // A limit on the error chooses texels of 10 bits.
  packed: ["materials/polished-gold.toml", "--no-fit", "--max-abs", "3e-3", ...BAKED, "surface"],
};
const made = new Map();

/** The folder of a bake, which is made once. */
function baked(name) {
  const folder = file(name);
  if (!made.has(name)) made.set(name, luthier("bake", ...BAKES[name], "--out", folder).then(() => folder));
  return made.get(name);
}

async function balls() {
  await luthier("environment", "--sky", "strip-studio", "--layout", "cube", "--out", file("studio"));

  const far = { lights: [{ direction: [0.5, 0.7, 0.6], irradiance: LAMP }] };
  const near = { lights: [{ position: [1, 1.5, 2], irradiance: LAMP }] };
  const studio = { lights: [], slope_variance: 0, environment: "studio/environment.json" };
  const [from, at, around] = [["--light", "0.5,0.7,0.6"], ["--point-light", "1,1.5,2"], ["--sky", "strip-studio"]];
  const cases = [
    ["gold", "polished-gold", "plain", far, [...from, ...DARK]],
    ["packed-gold", "polished-gold", "packed", far, [...from, ...DARK]],
    ["lacquer", "red-lacquer", "plain", far, [...from, ...DARK]],
    ["near-lacquer", "red-lacquer", "plain", near, [...at, ...DARK]],
    ["lit-lacquer", "red-lacquer", "plain", studio, around],
    ["right-handed-lacquer", "red-lacquer", "plain", { ...studio, handed: "right" }, around],
    ["even-lacquer", "red-lacquer", "plain", { lights: [{ radiance: [0.5, 0.5, 0.5] }] }, ["--environment", file("grey.hdr")]],
    ["patina", "copper-patina", "plain", far, [...from, ...DARK]],
    ["film", "granier-film", "film", far, [...from, ...DARK]],
    ["brass", "worn-brass", "board", far, [...from, ...DARK]],
    ["right-handed-brass", "worn-brass", "board", { ...far, handed: "right" }, [...from, ...DARK]],
    ["tile", "celadon-tile", "board", far, [...from, ...DARK]],
  ];
  const chosen = cases.filter(([name]) => wanted(name));
  for (const [name, material, bake, , options] of chosen) {
    await preview(material, await baked(bake), file(`${name}-preview.png`), options);
  }
  const list = chosen.map(([name, material, bake, lit]) => ({ ...BALL, ...lit, name, material, bake }));
  // A tone curve of Babylon.js; without it the pictures are others.
  if (wanted("toned")) list.push({ ...BALL, ...far, name: "toned", material: "red-lacquer", bake: "plain", tone: "TONEMAPPING_ACES" });
  if (!list.length) return;
  for (const renderer of RENDERERS) {
    const pictures = JSON.parse(await page("test.html", out, { renderer, scene: "balls", list }, `balls-${renderer}`));
    for (const [name, url] of Object.entries(pictures)) await writeFile(file(`${name}-${renderer}.png`), Buffer.from(url.split(",")[1], "base64"));
  }
  const picture = (name, renderer) => file(`${name}-${renderer}.png`);
  for (const [name, , , , options] of chosen) {
    for (const renderer of RENDERERS) {
      await compare(name, renderer, picture(name, "preview"), picture(name, renderer), options);
    }
  }
  if (wanted("toned") && wanted("lacquer")) {
    const [same, other] = [await difference(...RENDERERS.map((renderer) => picture("toned", renderer))), await difference(picture("toned", "webgl"), picture("lacquer", "webgl"))];
    check(same.p99 <= 1 && other.median > 5, `a tone curve: ${same.p99} of 255 between the engines (99 %), ${other.median} against none (median)`);
  }
  if (wanted("packed-gold")) {
    const manifest = await readFile(path.join(await baked("packed"), "manifest.json"), "utf8");
    check(manifest.includes('"format": "rgb10a2unorm"'), "a bake has texels of 10 bits");
  }
}

async function lights() {
  const bake = await baked("plain");
  for (const renderer of RENDERERS) {
    const { lit, shadowed, sum_off, inside_of_cone, outside_of_cone, programs, fog_off } = JSON.parse(
      await page("test.html", bake, { renderer, scene: "lights", material: "red-lacquer", floor: "red-lacquer" }, `lights-${renderer}`),
    );
    for (const kind of Object.keys(lit)) {
      check(lit[kind] > 1000 && shadowed[kind] > 300, `a ${kind} lamp by ${renderer}: ${lit[kind]} pixels lit, ${shadowed[kind]} of them in its shadow`);
    }
    check(sum_off < 1e-5, `three lamps by ${renderer} are the sum of single ones: ${sum_off.toExponential(1)} of the brightest off`);
    check(inside_of_cone > 1000 && outside_of_cone > 1000, `a spot by ${renderer} is a lamp within its cone: ${inside_of_cone} pixels inside, ${outside_of_cone} outside`);
    check(fog_off < 1e-3, `thick fog by ${renderer} has its colour: ${fog_off.toExponential(1)} off`);
    check(programs === 1, `a ball and a floor by ${renderer}: ${programs} program`);
  }
}

async function moved() {
  const bake = await baked("plain");
  for (const renderer of RENDERERS) {
    const { off, lit } = JSON.parse(await page("test.html", bake, { renderer, scene: "moved" }, `moved-${renderer}`));
    check(off < 1e-3 && lit > 10000, `instances, a skin and a morph target by ${renderer} are where meshes are: ${off.toExponential(1)} off, ${lit} pixels`);
  }
}

async function sixty() {
  const bake = file("sixty");
  await luthier("bake", await paints(), "materials/textured", "--no-fit", "--out", bake, ...BAKED, "surface");
  for (const renderer of RENDERERS) {
    const { materials, programs, first_ms, frame_ms } = JSON.parse(await page("test.html", bake, { renderer, scene: "set" }, `sixty-${renderer}`));
    check(materials === 60 && programs === 1, `${materials} materials by ${renderer}, ${programs} program: first frame ${first_ms} ms, then ${frame_ms} ms a frame of 512 x 512`);
  }
}

/** Bakes that are refused, and a word of the reason. */
async function refused() {
  const bake = file("refused");
  const gold = ["bake", "materials/polished-gold.toml", "--no-fit", "--quiet", "--out", bake];
  const refuses = async (renderer, word, change = (manifest) => manifest) => {
    const manifest = path.join(bake, "manifest.json");
    await writeFile(manifest, change(await readFile(manifest, "utf8")));
    const said = await page("index.html", bake, { ...BALL, lights: [], renderer, material: "polished-gold" }, "refused").then(() => "nothing", ({ stderr }) => stderr);
    check(said.includes(word), `a bake is refused: ${said.match(/Error: (.*)/)?.[1] ?? said}`);
  };
  await luthier(...gold);
  await refuses("webgl", "--functions surface");
  await luthier(...gold, "--target", "wgsl", "--functions", "surface");
  await refuses("webgl", "--target glsl-es300");
  await luthier(...gold, "--target", "glsl-es300", "--functions", "surface");
  await refuses("webgpu", "--target wgsl");
  await refuses("webgl", "schema 5", (manifest) => manifest.replace('"schema": 4', '"schema": 5'));
  await refuses("webgl", "no JSON", (manifest) => manifest.slice(1));
}

await balls();
for (const part of [lights, moved, sixty, refused]) {
  if (wanted(part.name)) await part();
}
finish();
