// Two bakes with prefixes in one program of WebGPU, in Chromium with the software driver: node test.mjs OUT. Each ball is that of `luthier preview`.
// Needs a Vulkan driver. The environment variable LUTHIER names the program that bakes; by default cargo builds it. CHROMIUM names the browser.

import path from "node:path";
import { BALL, DARK, LAMP, compare, file, finish, luthier, out, preview, show } from "./workshop.mjs";

const bakes = [
  { folder: "car", material: "red-lacquer", from: "materials/red-lacquer.toml", first: 0 },
  { folder: "room", material: "polished-gold", from: "materials/polished-gold.toml", first: 16 },
];
for (const { folder, from, first } of bakes) {
  const names = ["--prefix", folder, "--first-binding", String(first)];
  await luthier("bake", from, "--no-fit", "--no-zstd", "--layout", "filtered", "--functions", "surface", "--target", "wgsl", "--form", "baked", "--quiet", ...names, "--out", file(folder));
}

const scene = { ...BALL, light: [0.5, 0.7, 0.6], irradiance: LAMP, bakes: bakes.map(({ folder, material }) => ({ folder, material })) };
for (const [which, { folder, material }] of bakes.entries()) {
  await preview(material, file(folder), file(`${folder}-preview.png`), ["--light", scene.light.join(), ...DARK]);
  await show(path.join(import.meta.dirname, "packages.html"), out, { ...scene, show: which }, folder);
  await compare(`${material} in ${folder}`, "WebGPU", file(`${folder}-preview.png`), file(`${folder}.png`));
}
finish();
