// Tests of the addon in Godot 4 (its three renderers) and, where there is one, in Godot 3.6: node test.mjs OUT [RENDERER...], of
// forward, mobile, compatibility and godot3. Pictures are left in OUT.
// - Balls against `luthier preview`: plain and textured materials under a lamp far away, near a lamp, and under two lamps.
// - Lamps with shadows, against sums of single ones.
// - Materials saved as resources draw the same picture.
// - Wrong bakes are named.
// The environment variable LUTHIER names the program that bakes; by default cargo builds it. GODOT names Godot 4 (4.3 or later), GODOT3 Godot 3.6. Needs
// xvfb-run, and OpenGL and Vulkan drivers.

import { execFile } from "node:child_process";
import { cp, mkdir, readFile, rm, truncate, writeFile } from "node:fs/promises";
import path from "node:path";
import { promisify } from "node:util";
import { crc32, deflateSync } from "node:zlib";
import { difference } from "../web/difference.mjs";
import { BALL, DARK, LAMP, call, check, compare, file, finish, luthier, preview } from "../web/workshop.mjs";

const here = import.meta.dirname;
const { GODOT = "godot", GODOT3 } = process.env;
const ALL = {
  "Godot 4 Forward+": { name: "forward", program: GODOT, options: ["--rendering-method", "forward_plus"], project: file("project") },
  "Godot 4 Mobile": { name: "mobile", program: GODOT, options: ["--rendering-method", "mobile"], project: file("project") },
  "Godot 4 Compatibility": { name: "compatibility", program: GODOT, options: ["--rendering-method", "gl_compatibility"], project: file("project") },
  ...(GODOT3 && { "Godot 3.6": { name: "godot3", program: GODOT3, options: ["--video-driver", "GLES3"], project: file("project3") } }),
};
const wanted = process.argv.slice(3);
const RENDERERS = Object.fromEntries(Object.entries(ALL).filter(([, { name }]) => !wanted.length || wanted.includes(name)));

/** Copies of this folder as a project for either version: Godot writes into the folder of a project. */
async function projects() {
  const [four, three] = ["project", "project3"].map(file);
  for (const folder of [four, three]) {
    await rm(folder, { recursive: true, force: true });
    await cp(path.join(here, "addons"), path.join(folder, "addons"), { recursive: true });
  }
  for (const name of ["project.godot", "test.gd"]) await cp(path.join(here, name), path.join(four, name));
  for (const name of ["project.godot", "test.gd"]) await cp(path.join(here, "godot3", name), path.join(three, name));
  await cp(path.join(here, "godot3/luthier_bake.gd"), path.join(three, "addons/luthier/luthier_bake.gd"));
  // Registers the classes of scripts, as the editor does.
  await call(GODOT, ["--headless", "--path", four, "--import"]);
}

/** What a renderer says while it does what `test.gd` does with a list. */
async function draw(renderer, list) {
  const { program, options, project } = RENDERERS[renderer];
  const scenes = file(`${RENDERERS[renderer].name}.json`);
  await writeFile(scenes, JSON.stringify(list, null, 1));
  const args = ["-a", program, ...options, "--audio-driver", "Dummy", "--path", project, "--script", "test.gd", "--", scenes];
  const { stdout, stderr } = await promisify(execFile)("xvfb-run", args, { maxBuffer: 1 << 26 }).catch((error) => error);
  return `${stdout}${stderr}`;
}

/** A normal map of dents, and a material with it: a varnish over brushed gold, whose tangents turn. */
async function dented() {
  const folder = file("dented");
  await mkdir(folder, { recursive: true });
  const size = 128;
  const turn = (2 * Math.PI) / size;
  const picture = (texel) => Buffer.concat(Array.from({ length: size }, (_, y) => Buffer.from([0, ...Array.from({ length: size }, (_, x) => texel(x * turn, y * turn)).flat()])));
  const byte = (value) => Math.round(255 * (0.5 + 0.5 * value));
  const dent = (x, y) => {
    const normal = [0.15 * Math.sin(4 * x) * Math.cos(3 * y), 0.3 * Math.cos(4 * x) * Math.sin(3 * y), 1];
    return normal.map((value) => byte(value / Math.hypot(...normal)));
  };
  const tangent = (x, y) => [byte(Math.cos(y + Math.sin(x))), byte(Math.sin(y + Math.sin(x))), 0];
  await writeFile(path.join(folder, "dents.png"), png(size, picture(dent)));
  await writeFile(path.join(folder, "turns.png"), png(size, picture(tangent)));
  const material = path.join(folder, "dented-gold.toml");
  await writeFile(
    material,
    `schema = 1
name = "dented-gold"
description = "A varnish over brushed gold, with dents."
references = []

[[layer]]
type = "dielectric"
ior = 1.5
alpha = 0.15
maps = { normal = "dents.png" }

[[layer]]
type = "conductor"
ior = "au"
alpha_x = 0.4
alpha_y = 0.15
maps = { tangent = "turns.png" }
`,
  );
  return material;
}

/** A PNG of rows of RGB, each behind its filter. */
function png(size, rows) {
  const chunk = (name, data) => {
    const body = Buffer.concat([Buffer.from(name), data]);
    const ends = [data.length, crc32(body)].map((number) => Buffer.from(Uint32Array.of(number).buffer).reverse());
    return Buffer.concat([ends[0], body, ends[1]]);
  };
  const head = Buffer.from([0, 0, 0, size, 0, 0, 0, size, 8, 2, 0, 0, 0]);
  return Buffer.concat([Buffer.from("\x89PNG\r\n\x1a\n", "latin1"), chunk("IHDR", head), chunk("IDAT", deflateSync(rows)), chunk("IEND", Buffer.alloc(0))]);
}

const BAKE = ["--target", "wgsl,glsl-es300", "--form", "baked", "--quiet", "--functions", "surface"];

const SCENE = { ...BALL, kind: "picture", tangents: true };

/** Materials, lamps, and what `preview` is told of them. */
async function cases() {
  const [plain, board, film, dents, packed] = ["plain", "board", "film", "dents", "packed"].map(file);
  await luthier("bake", "materials/polished-gold.toml", "materials/red-lacquer.toml", "materials/copper-patina.toml", "materials/car-paint.toml", "--out", plain, ...BAKE);
  await luthier("bake", "materials/textured", "--no-fit", "--out", board, ...BAKE);
  await luthier("bake", "materials/papers/granier-film.toml", "--out", film, ...BAKE);
  await luthier("bake", await dented(), "--no-fit", "--no-zstd", "--out", dents, ...BAKE);
  // A limit on the error chooses texels that Godot does not have.
  await luthier("bake", "materials/polished-gold.toml", "--no-fit", "--max-abs", "3e-3", "--out", packed, ...BAKE);
  check((await readFile(path.join(packed, "manifest.json"), "utf8")).includes('"format": "rgb10a2unorm"'), "a bake has texels of 10 bits");

  const far = { direction: [0.5, 0.7, 0.6], irradiance: LAMP };
  const side = { direction: [-1, 0.3, 0.2], irradiance: LAMP };
  const near = { position: [1, 1.5, 2], irradiance: LAMP };
  const all = [
    ["gold", "polished-gold", plain, [far]],
    ["packed-gold", "polished-gold", packed, [far]],
    ["lacquer", "red-lacquer", plain, [far]],
    ["near-lacquer", "red-lacquer", plain, [near]],
    ["twice-lit-lacquer", "red-lacquer", plain, [far, side]],
    ["patina", "copper-patina", plain, [far]],
    ["car-paint", "car-paint", plain, [far]],
    ["film", "granier-film", film, [far]],
    ["brass", "worn-brass", board, [far]],
    ["tile", "celadon-tile", board, [far]],
    ["dents", "dented-gold", dents, [far]],
    ["near-dents", "dented-gold", dents, [near]],
    ["lacquer-without-tangents", "red-lacquer", plain, [far], { tangents: false }],
  ];
  for (const [name, material, bake, lights] of all) {
    const lamps = lights.map(({ direction, position }) => (position ? `--point-light=${position}` : `--light=${direction}`));
    await preview(material, bake, file(`${name}-preview.png`), [...lamps, ...DARK]);
  }
  return all;
}

async function balls(renderer, all) {
  const picture = (name) => file(`${name}-${RENDERERS[renderer].name}.png`);
  // Where there are fewer bits than a picture of 8 bits needs, it is drawn in half floats.
  const hdr = renderer.endsWith("Mobile");
  const list = all.map(([name, material, bake, lights, more]) => ({ ...SCENE, bake, material, lights, hdr, picture: picture(name), ...more }));
  const [, , plain] = all[0];
  list.push({ ...list[2], kind: "lamps", hdr: true });
  if (renderer !== "Godot 3.6") list.push({ ...list[8], kind: "saved", folder: path.join(RENDERERS[renderer].project, "saved"), picture: picture("saved-brass") });
  const said = await draw(renderer, list);
  console.log(said.match(/driver: .*/)?.[0]);
  for (const [name] of all) await compare(name, renderer, file(`${name}-preview.png`), picture(name));
  const { off, ...lamps } = JSON.parse(said.match(/lamps: (.*)/)[1]);
  for (const [kind, [lit, shadowed]] of Object.entries(lamps)) {
    check(lit > 1000 && shadowed > 100, `a ${kind} lamp by ${renderer}: ${lit} pixels lit, ${shadowed} of them in its shadow`);
  }
  check(off < 0.01, `three lamps by ${renderer} are the sum of single ones: ${(100 * off).toFixed(2)} % off (99 % of the pixels)`);
  if (renderer === "Godot 3.6") return;
  const { most } = await difference(picture("brass"), picture("saved-brass"));
  check(/saved: OK/.test(said) && most === 0, `a material saved as a resource by ${renderer}: ${most} of 255 off`);
}

/** Bakes that the addon refuses, and a word of the reason. */
async function wrong() {
  const all = [];
  const add = async (word, options, change) => {
    const bake = file(`wrong-${all.length}`);
    await rm(bake, { recursive: true, force: true });
    await luthier("bake", "materials/polished-gold.toml", "--no-fit", "--quiet", "--out", bake, ...options);
    await change?.(bake);
    all.push([word, bake]);
  };
  const manifest = (change) => async (bake) => {
    const manifest = path.join(bake, "manifest.json");
    await writeFile(manifest, change(await readFile(manifest, "utf8")));
  };
  const surface = ["--functions", "surface"];
  await add("--functions surface", []);
  await add("--target glsl-es300", ["--target", "wgsl", ...surface]);
  await add("without --prefix", ["--prefix", "gold", ...surface]);
  await add("schema 5", surface, manifest((text) => text.replace('"schema": 4', '"schema": 5')));
  await add("no JSON", surface, manifest((text) => text.slice(1)));
  await add("no whole KTX2 file", surface, (bake) => truncate(path.join(bake, "tables/fresnel.ktx2"), 120));
  await add("not the size", surface, (bake) => truncate(path.join(bake, "materials.bin"), 16));
  await add("no manifest.json", surface, (bake) => rm(path.join(bake, "manifest.json")));
  return all;
}

async function refusals(renderer, all) {
  const said = await draw(renderer, all.map(([, bake]) => ({ ...SCENE, bake, material: "polished-gold", lights: [], picture: file("wrong.png"), hdr: false })));
  for (const [word, bake] of all) {
    const reason = said.split("\n").find((line) => line.includes("ERROR: ") && line.includes(bake)) ?? "nothing";
    check(reason.includes(word), `a bake is refused by ${renderer}: ${reason.replace(/.*ERROR: /, "")}`);
  }
}

await projects();
const all = await cases();
for (const renderer of Object.keys(RENDERERS)) await balls(renderer, all);
const faulty = await wrong();
for (const renderer of Object.keys(RENDERERS).filter((name) => /Compatibility|3.6/.test(name))) await refusals(renderer, faulty);
finish();
