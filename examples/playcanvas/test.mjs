// Tests of luthier-playcanvas in Chromium with the software driver, on the devices of WebGL 2 and WebGPU: node test.mjs OUT. Pictures are left in OUT.
// - Balls against `luthier preview`: plain and textured materials under one lamp, near a lamp, in an environment and in even light. A tone curve.
// - Chalk against PlayCanvas' own white: the units of lamps and of ambient light.
// - Three kinds of lamps with shadows, in clusters and, in WebGL, without, against sums of single ones. Fog.
// - Instances, a skin and a morph target.
// - Sixty materials, five of them with textures: one program.
// - Wrong bakes are named.
// Needs a Vulkan driver and `npm ci` in this folder. The environment variable LUTHIER names the program that bakes; by default cargo builds it. CHROMIUM
// names the browser.

import { readFile, writeFile } from "node:fs/promises";
import path from "node:path";
import { difference } from "../web/difference.mjs";
import { BALL, DARK, LAMP, check, compare, file, finish, luthier, paints, preview, show } from "../web/workshop.mjs";

/** A page of this folder with a bake and a description; its figures. */
const page = (html, ...rest) => show(path.join(import.meta.dirname, html), ...rest);

const BAKED = ["--target", "wgsl,glsl-es300", "--form", "baked", "--quiet", "--functions"];
const DEVICES = ["webgl2", "webgpu"];

/** White that scatters all directions alike. */
const ALBEDO = 0.8;
const CHALK = `schema = 1
name = "chalk"
description = "A white diffuse surface."
references = []

[[layer]]
type = "diffuse"
albedo = [${ALBEDO}, ${ALBEDO}, ${ALBEDO}]
`;

async function balls() {
  const [plain, lit, board, packed, film] = ["plain", "lit", "board", "packed", "film"].map(file);
  await luthier("bake", ...["polished-gold", "red-lacquer", "copper-patina"].map((name) => `materials/${name}.toml`), "--out", plain, ...BAKED, "surface");
  await luthier("bake", "materials/red-lacquer.toml", "--out", lit, ...BAKED, "surface,environment,albedo");
  await luthier("bake", "materials/textured", "--no-fit", "--out", board, ...BAKED, "surface");
  await luthier("bake", "materials/papers/granier-film.toml", "--out", film, ...BAKED, "surface");
  // A limit on the error chooses texels of 10 bits.
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
    ["lit-lacquer", "red-lacquer", lit, { lights: [], slope_variance: 0, environment: "studio/environment.json" }, ["--sky", "strip-studio"]],
    ["even-lacquer", "red-lacquer", lit, { lights: [], ambient: [0.5, 0.5, 0.5] }, ["--environment", file("grey.hdr")]],
    ["patina", "copper-patina", plain, far, [...from, ...DARK]],
    ["film", "granier-film", film, far, [...from, ...DARK]],
    ["brass", "worn-brass", board, far, [...from, ...DARK]],
    ["brass-tangents", "worn-brass", board, { ...far, tangents: true }, [...from, ...DARK]],
    ["tile", "celadon-tile", board, far, [...from, ...DARK]],
  ];
  for (const [name, material, bake, scene, options] of cases) {
    const expected = file(`${name}-preview.png`);
    await preview(material, bake, expected, options);
    for (const device of DEVICES) {
      await page("index.html", bake, { ...BALL, ...scene, device, material }, `${name}-${device}`);
      await compare(name, device, expected, file(`${name}-${device}.png`), options);
    }
  }

  // A tone curve of PlayCanvas, on both devices; without it the pictures are others.
  const toned = (device) => file(`toned-${device}.png`);
  for (const device of DEVICES) await page("index.html", plain, { ...BALL, ...far, device, material: "red-lacquer", tone: "TONEMAP_ACES" }, `toned-${device}`);
  const [same, other] = [await difference(...DEVICES.map(toned)), await difference(toned("webgl2"), file("lacquer-webgl2.png"))];
  check(same.p99 <= 1 && other.median > 5, `a tone curve: ${same.p99} of 255 between the devices (99 %), ${other.median} against none (median)`);
  return plain;
}

async function units() {
  const bake = file("chalk");
  await writeFile(`${bake}.toml`, CHALK);
  await luthier("bake", `${bake}.toml`, "--out", bake, ...BAKED, "surface,albedo");
  for (const device of DEVICES) {
    const { off, largest } = JSON.parse(await page("test.html", bake, { device, scene: "units", albedo: ALBEDO }, `units-${device}`));
    check(largest > 0.5 && off < 1e-4 * largest, `chalk by ${device} is PlayCanvas' own white: 99 % within ${(off / largest).toExponential(1)} of the brightest`);
  }
}

async function lamps(bake) {
  for (const device of DEVICES) {
    // WebGPU has clusters alone.
    for (const clustered of device === "webgpu" ? [true] : [true, false]) {
      const by = clustered ? `${device} in clusters` : device;
      const { lit, shadowed, sum_off, spot_off, outside_of_cone, programs, fog_off } = JSON.parse(
        await page("test.html", bake, { device, scene: "lights", material: "red-lacquer", floor: "red-lacquer", clustered }, `lights-${device}-${clustered}`),
      );
      for (const kind of Object.keys(lit)) {
        check(lit[kind] > 1000 && shadowed[kind] > 300, `a ${kind} lamp by ${by}: ${lit[kind]} pixels lit, ${shadowed[kind]} of them in its shadow`);
      }
      check(sum_off < 1e-5, `three lamps by ${by} are the sum of single ones: ${sum_off.toExponential(1)} of the brightest off`);
      check(spot_off < 1e-3 && outside_of_cone > 1000, `a spot by ${by} is a lamp within its cone: 95 % within ${spot_off.toExponential(1)}, ${outside_of_cone} pixels outside`);
      check(fog_off < 1e-3, `thick fog by ${by} has its colour: ${fog_off.toExponential(1)} off`);
      check(programs === 1, `a ball and a floor by ${by}: ${programs} program`);
    }
  }
}

async function moved(bake) {
  for (const device of DEVICES) {
    const { off, lit } = JSON.parse(await page("test.html", bake, { device, scene: "moved" }, `moved-${device}`));
    check(off < 1e-3 && lit > 10000, `instances, a skin and a morph target by ${device} are where meshes are: ${off.toExponential(1)} off, ${lit} pixels`);
  }
}

async function sixty() {
  const bake = file("sixty");
  await luthier("bake", await paints(), "materials/textured", "--no-fit", "--out", bake, ...BAKED, "surface");
  for (const device of DEVICES) {
    const { materials, programs, first_ms, frame_ms } = JSON.parse(await page("test.html", bake, { device, scene: "set", size: 512 }, `sixty-${device}`));
    check(materials === 60 && programs === 1, `${materials} materials by ${device}, ${programs} program: first frame ${first_ms} ms, then ${frame_ms} ms a frame of 512 x 512`);
  }
}

/** Bakes that the loader refuses, and a word of the reason. */
async function refusals(plain) {
  const bake = file("refused");
  const gold = ["bake", "materials/polished-gold.toml", "--no-fit", "--quiet", "--out", bake];
  const scene = { ...BALL, device: "webgl2", lights: [], material: "polished-gold" };
  const refused = async (word, folder, more) => {
    const said = await page("index.html", folder, { ...scene, ...more }, "refused").then(() => "nothing", ({ stderr }) => stderr);
    check(said.includes(word), `${more?.material ?? more?.environment ?? "a bake"} is refused: ${said.match(/Error: (.*)/)?.[1] ?? said}`);
  };
  const changed = async (word, change) => {
    const manifest = path.join(bake, "manifest.json");
    await writeFile(manifest, change(await readFile(manifest, "utf8")));
    await refused(word, bake);
  };
  await luthier(...gold);
  await refused("--functions surface", bake);
  await luthier(...gold, "--target", "wgsl", "--functions", "surface");
  await refused("--target glsl-es300", bake);
  await changed("schema 5", (manifest) => manifest.replace('"schema": 4', '"schema": 5'));
  await changed("no JSON", (manifest) => manifest.slice(1));
  await luthier(...gold, "--target", "glsl-es300", "--functions", "surface");
  await refused("--target wgsl", bake, { device: "webgpu" });
  await refused("--functions surface,environment", bake, { environment: "studio/environment.json" });
  await refused("has no material lead; it has polished-gold", plain, { material: "lead" });
}

const plain = await balls();
await units();
await lamps(plain);
await moved(plain);
await sixty();
await refusals(plain);
finish();
