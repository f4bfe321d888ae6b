// Tests of the addon in Godot 4 (its three renderers) and, where there is one, in Godot 3.6: node test.mjs OUT. Pictures are left in OUT.
// - Balls against `luthier preview`: plain and textured materials under a lamp far away, near a lamp, and under two lamps.
// - Lamps with shadows, against sums of single ones.
// - Materials saved as resources draw the same picture.
// - Wrong bakes are named.
// The environment variable LUTHIER names the program that bakes; by default cargo builds it. GODOT names Godot 4 (4.3 or later), GODOT3 Godot 3.6. Needs
// xvfb-run, and OpenGL and Vulkan drivers.

import { execFile } from "node:child_process";
import { cp, mkdir, readFile, rm, writeFile } from "node:fs/promises";
import path from "node:path";
import { promisify } from "node:util";
import { difference } from "../three/difference.mjs";

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

const { GODOT = "godot", GODOT3 } = process.env;
const RENDERERS = {
  "Godot 4 Forward+": { program: GODOT, options: ["--rendering-method", "forward_plus"], project: path.join(out, "project") },
  "Godot 4 Mobile": { program: GODOT, options: ["--rendering-method", "mobile"], project: path.join(out, "project") },
  "Godot 4 Compatibility": { program: GODOT, options: ["--rendering-method", "gl_compatibility"], project: path.join(out, "project") },
  ...(GODOT3 && { "Godot 3.6": { program: GODOT3, options: ["--video-driver", "GLES3"], project: path.join(out, "project3") } }),
};

/** Copies of this folder as a project for either version: Godot writes into the folder of a project. */
async function projects() {
  const [four, three] = ["project", "project3"].map((name) => path.join(out, name));
  for (const folder of [four, three]) {
    await rm(folder, { recursive: true, force: true });
    await cp(path.join(here, "addons"), path.join(folder, "addons"), { recursive: true });
  }
  for (const file of ["project.godot", "test.gd"]) await cp(path.join(here, file), path.join(four, file));
  for (const file of ["project.godot", "test.gd"]) await cp(path.join(here, "godot3", file), path.join(three, file));
  await cp(path.join(here, "godot3/luthier_bake.gd"), path.join(three, "addons/luthier/luthier_bake.gd"));
  // Registers the classes of scripts, as the editor does.
  await call(GODOT, ["--headless", "--path", four, "--import"]);
}

/** What a renderer says while it does what `test.gd` does with a list. */
async function draw(renderer, list) {
  const { program, options, project } = RENDERERS[renderer];
  const file = path.join(out, `${renderer.replace(/\W+/g, "-")}.json`);
  await writeFile(file, JSON.stringify(list, null, 1));
  const args = ["-a", program, ...options, "--audio-driver", "Dummy", "--path", project, "--script", "test.gd", "--", file];
  const { stdout, stderr } = await promisify(execFile)("xvfb-run", args, { maxBuffer: 1 << 26 }).catch((error) => error);
  return `${stdout}${stderr}`;
}
