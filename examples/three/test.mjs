// Tests of luthier-three in Chromium with the software driver, by WebGL 2 and by WebGPU: node test.mjs OUT. Pictures are left in OUT.
// - Balls against `luthier preview`: a plain and a textured material under one lamp, near a lamp, in an environment and in even light.
// - Three kinds of lamps with shadows, against sums of single ones. Fog, a tone curve, instances, skins and morph targets.
// - A car of sixty parts, each with a material of its own, five of them with textures: one program.
// - Wrong bakes are named.
// Needs a Vulkan driver and `npm ci` in this folder. The environment variable LUTHIER names the program that bakes; by default cargo builds it. CHROMIUM
// names the browser.

import { readFile, stat, writeFile } from "node:fs/promises";
import path from "node:path";
import { difference } from "../web/difference.mjs";
import { BALL, DARK, LAMP, check, compare, file, finish, luthier, paints, preview, show } from "../web/workshop.mjs";

/** A page of this folder with a bake and a description; its figures. */
const page = (html, ...rest) => show(path.join(import.meta.dirname, html), ...rest);

const BAKED = ["--target", "wgsl,glsl-es300", "--form", "baked", "--quiet", "--functions"];
const RENDERERS = ["webgl", "webgpu"];

async function balls() {
  const plain = file("plain");
  const board = file("board");
  const packed = file("packed");
  const film = file("film");
  await luthier("bake", "materials/polished-gold.toml", "materials/red-lacquer.toml", "materials/copper-patina.toml", "--out", plain, ...BAKED, "surface,environment,albedo");
  await luthier("bake", "materials/textured", "--no-fit", "--out", board, ...BAKED, "surface");
  await luthier("bake", "materials/papers/granier-film.toml", "--out", film, ...BAKED, "surface");
  // A limit on the error chooses texels that three.js does not have.
  await luthier("bake", "materials/polished-gold.toml", "--no-fit", "--max-abs", "3e-3", "--out", packed, ...BAKED, "surface");
  check((await readFile(path.join(packed, "manifest.json"), "utf8")).includes('"format": "rgb10a2unorm"'), "a bake has texels of 10 bits");
  await luthier("environment", "--sky", "strip-studio", "--layout", "cube", "--out", file("studio"));

  const far = { lights: [{ direction: [0.5, 0.7, 0.6], irradiance: LAMP }] };
  const near = { lights: [{ position: [1, 1.5, 2], irradiance: LAMP }] };
  const [from, at] = [["--light", "0.5,0.7,0.6"], ["--point-light", "1,1.5,2"]];
  const cases = [
    ["gold", "polished-gold", plain, far, [...from, ...DARK]],
    ["packed-gold", "polished-gold", packed, far, [...from, ...DARK]],
    ["lacquer", "red-lacquer", plain, far, [...from, ...DARK]],
    ["near-lacquer", "red-lacquer", plain, near, [...at, ...DARK]],
    ["lit-lacquer", "red-lacquer", plain, { lights: [], slope_variance: 0, environment: "studio/environment.json" }, ["--sky", "strip-studio"]],
    ["even-lacquer", "red-lacquer", plain, { lights: [{ radiance: [0.5, 0.5, 0.5] }] }, ["--environment", file("grey.hdr")]],
    ["patina", "copper-patina", plain, far, [...from, ...DARK]],
    ["film", "granier-film", film, far, [...from, ...DARK]],
    ["brass", "worn-brass", board, far, [...from, ...DARK]],
    ["tile", "celadon-tile", board, far, [...from, ...DARK]],
  ];
  for (const [name, material, bake, lit, options] of cases) {
    const expected = file(`${name}-preview.png`);
    await preview(material, bake, expected, options);
    for (const renderer of RENDERERS) {
      await page("index.html", bake, { ...BALL, ...lit, renderer, material }, `${name}-${renderer}`);
      await compare(name, renderer, expected, file(`${name}-${renderer}.png`), options);
    }
  }

  // A tone curve of three.js, by its two renderers; without it the pictures are others.
  const toned = (renderer) => file(`toned-${renderer}.png`);
  for (const renderer of RENDERERS) {
    await page("index.html", plain, { ...BALL, ...far, renderer, material: "red-lacquer", tone: "ACESFilmicToneMapping" }, `toned-${renderer}`);
  }
  const [same, other] = [await difference(...RENDERERS.map(toned)), await difference(toned("webgl"), file("lacquer-webgl.png"))];
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

async function driven() {
  const bake = file("car");
  await luthier("bake", await paints(), "materials/textured", "--no-fit", "--out", bake, ...BAKED, "surface");
  const manifest = JSON.parse(await readFile(path.join(bake, "manifest.json")));
  const size = async (paths) => (await Promise.all([...new Set(paths)].map((one) => stat(path.join(bake, one))))).reduce((sum, { size }) => sum + size, 0);
  const tables = await size([...manifest.tables.map(({ texture }) => texture.path), manifest.material_buffer.path]);
  const maps = await size(manifest.materials.flatMap(({ maps }) => maps.map((map) => map.file.path)));
  const shader = await size(manifest.shaders.filter(({ target }) => target === "glsl-es300").map((shader) => shader.file.path));
  console.log(`a car of sixty materials: ${tables} bytes of tables and numbers, ${shader} of shader (GLSL), ${maps} of maps`);
  for (const renderer of RENDERERS) {
    const { parts, lit, programs, first_ms, frame_ms } = JSON.parse(await page("test.html", bake, { renderer, scene: "driven" }, `car-${renderer}`));
    check(parts === 60 && lit > 30000 && programs === 1, `a car of ${parts} materials by ${renderer}, ${programs} program, ${lit} pixels: first frame ${first_ms} ms, then ${frame_ms} ms a frame of 512 x 512`);
  }
}

/** Bakes that the loader refuses, and a word of the reason. */
async function refusals() {
  const bake = file("refused");
  const lacquer = ["bake", "materials/polished-gold.toml", "--no-fit", "--quiet", "--out", bake];
  const refused = async (word, change = (manifest) => manifest) => {
    const manifest = path.join(bake, "manifest.json");
    await writeFile(manifest, change(await readFile(manifest, "utf8")));
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
await driven();
await refusals();
finish();
