// Renders white furnaces in three.js and Babylon.js with their own split-sum table and with tables of luthier, and compares the pixels
// with quadrature and with bilinear reads of the tables: node furnace.mjs TABLES OUT [SHOTS]
// TABLES is a folder with the files that furnace.sh makes. OUT gets the figures as JSON; a Markdown table goes to standard output.
// SHOTS gets pictures. The environment variable CHROMIUM names the browser.

import { existsSync, mkdirSync, readFileSync, writeFileSync } from "node:fs";
import path from "node:path";
import { fileURLToPath } from "node:url";

import { sheen, splitSum } from "./albedo.mjs";
import { render } from "./browser.mjs";
import { dds, exr, readKtx2 } from "./containers.mjs";
import { fromHalf, halfBytes, toHalf } from "./half.mjs";
import { decodePng, encodePng } from "./png.mjs";
import { decodeRgbd, encodeRgbd } from "./rgbd.mjs";

const [tables, out, shots] = process.argv.slice(2);
if (!out) {
  console.error("usage: node furnace.mjs TABLES OUT [SHOTS]");
  process.exit(2);
}
const here = path.dirname(fileURLToPath(import.meta.url));
const npm = path.join(here, "node_modules");
const version = (name) => JSON.parse(readFileSync(path.join(npm, name, "package.json"), "utf8")).version;

// Off the nodes of any table of a power of two, but for the ends.
const COSINES = Array.from({ length: 60 }, (_, i) => 0.05 + (0.95 * i) / 59);
const ROUGHNESSES = Array.from({ length: 20 }, (_, i) => 0.05 * (i + 1));

/** Least roughness of three.js: lights_physical_fragment.glsl.js. */
const THREE_MIN_ROUGHNESS = 0.045;

/** Largest difference that a driver's filter may have from exact weights. */
const MAX_READ = 1e-3;

// ---- exact values, by the formula of each engine ----

const F0 = { white: 1, grey: 0.5, black: 0 };

/** What an engine makes of the albedo and the bias of a metal. */
const SHOWN = {
  three(measure, { albedo, bias }) {
    const f0 = F0[measure.split(" ")[0]];
    const single = f0 * (albedo - bias) + bias;
    if (measure.endsWith("one bounce")) return single;
    // Fdez-Agüera 2019, as the shader has it.
    const average = f0 + (1 - f0) * 0.047619;
    return single + (single * average * (1 - albedo)) / (1 - (1 - albedo) * average);
  },
  babylon(measure, { albedo, bias }) {
    const f0 = F0[measure.split(" ")[0]];
    const single = f0 * (albedo - bias) + bias;
    return measure.endsWith("one bounce") ? single : single * (1 + f0 * (1 / albedo - 1));
  },
};

/** Roughness that an engine makes of another. */
const ROUGHENED = { three: (roughness) => Math.max(roughness, THREE_MIN_ROUGHNESS), babylon: (roughness) => roughness };

/** What an engine should show. */
function expected(engine, measure, cos, roughness) {
  if (measure === "sheen") return exactSheen(cos, roughness ** 2);
  return SHOWN[engine](measure, exact(cos, ROUGHENED[engine](roughness) ** 2));
}

const known = (f) => {
  const values = new Map();
  return (cos, alpha) => {
    const key = `${cos} ${alpha}`;
    if (!values.has(key)) values.set(key, f(cos, alpha));
    return values.get(key);
  };
};
const exact = known(splitSum);
const exactSheen = known(sheen);

// ---- tables of luthier, in the form that each engine takes ----

mkdirSync(out, { recursive: true });
const made = (name, bytes) => {
  writeFileSync(path.join(out, name), bytes);
  return `/made/${name}`;
};
const read = (name) => readFileSync(path.join(tables, name));
const own = Object.fromEntries(
  read("own.jsonl")
    .toString()
    .trim()
    .split("\n")
    .map(JSON.parse)
    .map((facts) => [`${facts.engine} ${facts.table}`, facts]),
);

/** The table that an engine ships, and how many bytes its package has for it. */
function shipped(name) {
  const { file, size, channels, shipped } = own[name];
  return { bytes: shipped, table: table(readFileSync(file), size, channels) };
}

/** A table of half floats: the values of a texel. */
function table(bytes, [width, height], channels) {
  const at = (x, y) => Array.from({ length: channels }, (_, i) => fromHalf(bytes.readUInt16LE(2 * (channels * (y * width + x) + i))));
  return { size: [width, height], at };
}

/** Texels in RGBD as the engine expands them. */
function expanded(codes, width) {
  return (x, y) => decodeRgbd(codes.subarray(4 * (y * width + x))).map((value) => fromHalf(toHalf(value)));
}

const square = readKtx2(read("bevy.ktx2"));
const [width, height] = square.size;
const scaleAndBias = table(square.texels, square.size, 2).at;

/** Cosine across and roughness down becomes roughness across and cosine down. */
function transposed() {
  const words = [];
  for (let y = 0; y < width; y++) for (let x = 0; x < height; x++) words.push(...scaleAndBias(y, x).map(toHalf));
  return halfBytes(words);
}

/** Bias, albedo and sheen, row of the least roughness first. */
function babylonTexels() {
  const texels = [];
  for (let y = 0; y < height; y++) {
    for (let x = 0; x < width; x++) {
      const [scale, bias] = scaleAndBias(x, y);
      texels.push([bias, scale + bias, sheen((x + 0.5) / width, ((y + 0.5) / height) ** 2)]);
    }
  }
  return texels;
}

/** Rows from the bottom: the engine's loader of EXR takes the last one first, whatever it is told. */
function upsideDown(bytes, stride) {
  const rows = Array.from({ length: bytes.length / stride }, (_, row) => bytes.subarray(row * stride, (row + 1) * stride));
  return Buffer.concat(rows.reverse());
}

const texels = babylonTexels();
const rgba = halfBytes(texels.flatMap(([r, g, b]) => [toHalf(r), toHalf(g), toHalf(b), toHalf(1)]));
const rgbd = encodeRgbd(texels);
const png = encodePng(width, height, rgbd);
const boxed = { dds: dds(width, height, rgba), exr: exr(width, height, upsideDown(rgba, width * 8)) };

// The module as it is, where it has what the renderer imports, but for the folder that its own imports start from; else its words in
// a module that has.
const written = read("DFGLUTData.js").toString();
const words = written.match(/0x[0-9a-f]{4}\b/g);

/** A file of a build of three.js with the words of another table of the same size. */
function rebuilt(name) {
  const build = readFileSync(path.join(npm, "three/build", name), "utf8");
  const literal = /(const DATA = new Uint16Array\( \[)[^\]]*(\] \))/g;
  if (build.match(literal)?.length !== 1) throw new Error(`${name} has its table otherwise than expected`);
  const text = build.replace(literal, `$1${words.join(", ")}$2`).replaceAll("'./three.core.js'", "'/npm/three/build/three.core.js'");
  return made(name, text);
}
const isModule = /export function getDFGLUT/.test(written);
const adapter = `import { DFG_LUT_DATA } from "/tables/DFGLUTData.js";
import { DataTexture } from "/npm/three/src/textures/DataTexture.js";
import { RGFormat, HalfFloatType, LinearFilter } from "/npm/three/src/constants.js";
const table = new DataTexture(DFG_LUT_DATA, 16, 16, RGFormat, HalfFloatType);
table.minFilter = table.magFilter = LinearFilter;
table.needsUpdate = true;
export const getDFGLUT = () => table;
`;
const module = made("three-module.js", isModule ? written.replaceAll("../../", "/npm/three/src/") : adapter);

// ---- what is rendered ----

const three = (entry, more = {}) => ({ three: `/npm/three/${entry}`, ...more });
const sources = "src/Three.js";
const babylon = { "@babylonjs/core/": "/npm/@babylonjs/core/" };
const replaceByLuthier = { "/npm/three/src/renderers/shaders/DFGLUTData.js": module };
const runs = [
  {
    engine: "three",
    name: "own",
    texels: "2 half",
    imports: three(sources),
    ...shipped("three.js dfg"),
  },
  {
    engine: "three",
    name: "preset three",
    texels: "2 half",
    bytes: 2 * words.length,
    imports: three(sources, replaceByLuthier),
    table: table(halfBytes(words.map(Number)), [16, 16], 2),
  },
  {
    engine: "three",
    name: "preset bevy, transposed",
    texels: "2 half",
    bytes: width * height * 4,
    imports: three("build/three.module.js"),
    replace: { url: made("three-large.bin", transposed()), size: [height, width] },
    table: table(transposed(), [height, width], 2),
  },
  {
    engine: "three",
    name: "own, WebGPURenderer",
    texels: "2 half",
    imports: three("build/three.webgpu.js"),
    ...shipped("three.js dfg"),
  },
  {
    engine: "three",
    name: "preset three, WebGPURenderer",
    texels: "2 half",
    bytes: 2 * words.length,
    imports: three("build/three.webgpu.js", { "/npm/three/build/three.tsl.js": rebuilt("three.tsl.js") }),
    table: table(halfBytes(words.map(Number)), [16, 16], 2),
  },
  {
    engine: "babylon",
    name: "own",
    texels: "RGBD in PNG",
    imports: babylon,
    ...shipped("Babylon.js dfg"),
  },
  {
    engine: "babylon",
    name: "preset bevy and sheen",
    texels: "4 half",
    bytes: rgba.length,
    imports: babylon,
    replace: { kind: "half", size: [width, height], url: made("babylon.bin", rgba) },
    table: table(rgba, [width, height], 4),
  },
  ...["dds", "exr"].map((ending) => ({
    engine: "babylon",
    name: `the same as ${ending.toUpperCase()}`,
    texels: ending === "dds" ? "4 half" : "3 half",
    bytes: boxed[ending].length,
    imports: babylon,
    replace: { kind: "file", url: made(`babylon.${ending}`, boxed[ending]) },
    table: table(rgba, [width, height], 4),
  })),
  {
    engine: "babylon",
    name: "the same in 8 bits",
    texels: "RGBD in PNG",
    bytes: png.length,
    imports: babylon,
    replace: { kind: "rgbd", url: made("babylon.png", png) },
    table: { size: [width, height], at: expanded(rgbd, width) },
  },
  ...preset(),
];

/** The preset of Babylon.js, where luthier bakes it: the container is told by its first bytes. */
function preset() {
  if (!existsSync(path.join(tables, "babylon"))) return [];
  const bytes = read("babylon");
  const run = { engine: "babylon", name: "preset babylon", bytes: bytes.length, imports: babylon };
  if (bytes.toString("latin1", 1, 4) === "PNG") {
    const { width, height, texels } = decodePng(bytes);
    const replace = { kind: "rgbd", url: made("preset.png", bytes) };
    return [{ ...run, texels: "RGBD in PNG", replace, table: { size: [width, height], at: expanded(texels, width) } }];
  }
  const isDds = bytes.toString("latin1", 0, 4) === "DDS ";
  const [name, size] = isDds ? ["preset.dds", [16, 12].map((at) => bytes.readUInt32LE(at))] : ["preset.bin", [256, 256]];
  const texels = bytes.subarray(bytes.length - size[0] * size[1] * 8);
  const replace = { kind: isDds ? "file" : "half", size, url: made(name, bytes) };
  return [{ ...run, texels: "4 half", replace, table: table(texels, size, 4) }];
}

const NAMES = { three: ["three.js", "three"], babylon: ["Babylon.js", "@babylonjs/core"] };

const jobs = runs.map(({ engine, imports, replace }, id) => ({
  imports,
  script: `/pages/${engine}.js`,
  job: { id, replace, roughnesses: ROUGHNESSES, cosines: COSINES },
}));
const folders = { "/npm/": npm, "/pages/": path.join(here, "pages"), "/tables/": tables, "/made/": out };
const answers = await render(jobs, folders);

// ---- figures ----

/** Largest and mean error of a measure, and where the largest is. */
function compare(engine, measure, values) {
  let [max, sum, at] = [0, 0, null];
  ROUGHNESSES.forEach((roughness, y) =>
    COSINES.forEach((cos, x) => {
      const error = values[y][x] - expected(engine, measure, cos, roughness);
      sum += Math.abs(error);
      if (!(Math.abs(error) <= max)) [max, at] = [Math.abs(error), { cos, roughness, value: values[y][x], exact: values[y][x] - error }];
    }),
  );
  return { max, mean: sum / (ROUGHNESSES.length * COSINES.length), at };
}

/** Bilinear read at texel centres, clamped at the edges. */
function sample({ size, at }, coordinates) {
  const [x, y] = size.map((count, axis) => {
    const position = Math.min(count - 1, Math.max(0, coordinates[axis] * count - 0.5));
    const low = Math.min(Math.floor(position), count - 2);
    return [low, position - low];
  });
  const rows = [0, 1].map((dy) => [0, 1].map((dx) => at(x[0] + dx, y[0] + dy)));
  const mix = (a, b, weight) => a.map((value, i) => value + (b[i] - value) * weight);
  return mix(mix(...rows[0], x[1]), mix(...rows[1], x[1]), y[1]);
}

/** Largest difference between the pixels and what the engine makes of reads of the table that it was given. */
function differenceFromReads({ engine, table }, values) {
  let largest = 0;
  for (const [measure, rows] of Object.entries(values)) {
    ROUGHNESSES.forEach((roughness, y) =>
      COSINES.forEach((cos, x) => {
        const u = ROUGHENED[engine](roughness);
        const read = sample(table, engine === "three" ? [u, cos] : [cos, u]);
        const [albedo, bias] = engine === "three" ? [read[0] + read[1], read[1]] : [read[1], read[0]];
        const shown = measure === "sheen" ? read[2] : SHOWN[engine](measure, { albedo, bias });
        largest = Math.max(largest, Math.abs(rows[y][x] - shown));
      }),
    );
  }
  return largest;
}

const figures = answers.map((answer, i) => {
  const { engine, name, texels, bytes, table } = runs[i];
  const [title, folder] = NAMES[engine];
  const facts = { engine: title, version: version(folder), table: name, size: table.size, texels, bytes };
  if (answer.error) return { ...facts, error: answer.error };
  const measures = Object.entries(answer.values).map(([measure, values]) => [measure, compare(engine, measure, values)]);
  return { ...facts, reads: differenceFromReads(runs[i], answer.values), measures: Object.fromEntries(measures) };
});
writeFileSync(path.join(out, "furnace.json"), `${JSON.stringify({ presetModule: isModule, figures }, null, 2)}\n`);

const shown = ["white metal, one bounce", "black metal, one bounce", "white metal", "grey metal", "sheen"];
const digits = (figure) => (figure ? `${figure.max.toExponential(1)}, ${figure.mean.toExponential(1)}` : "");
console.log(`| engine | table | size | texels | bytes | picture against reads | ${shown.join(" | ")} |`);
console.log(`|---|---|---|---|---|---|${shown.map(() => "---|").join("")}`);
for (const { engine, version, table, size, texels, bytes, reads, measures, error } of figures) {
  const cells = error ? [error.split("\n")[0]] : [reads.toExponential(1), ...shown.map((measure) => digits(measures[measure]))];
  console.log(`| ${engine} ${version} | ${table} | ${size.join(" x ")} | ${texels} | ${bytes} | ${cells.join(" | ")} |`);
}

/** Measures whose errors are shown: the first that there is. */
const MAPPED = ["white metal, one bounce", "grey metal"];

if (shots) {
  mkdirSync(shots, { recursive: true });
  answers.forEach((answer, i) => {
    if (answer.error) return;
    const { engine, name } = runs[i];
    const file = path.join(shots, `${engine}-${name.toLowerCase().replace(/[^a-z0-9]+/g, "-")}`);
    writeFileSync(`${file}.png`, Buffer.from(answer.picture.split(",")[1], "base64"));
    writeFileSync(`${file}-error.png`, errorMap(engine, answer.values, MAPPED.find((measure) => answer.values[measure])));
  });
}
// A picture that is not what the table says was made with another table.
if (figures.some(({ error, reads }) => error || !(reads <= MAX_READ))) process.exitCode = 1;

/** Picture of the errors of a measure, cosine across and roughness down: grey is none, white and black are 0.01 too much and too little. */
function errorMap(engine, values, measure) {
  const zoom = 8;
  const [w, h] = [COSINES.length * zoom, ROUGHNESSES.length * zoom];
  const picture = new Uint8Array(w * h * 4).fill(255);
  for (let y = 0; y < h; y++) {
    for (let x = 0; x < w; x++) {
      const [row, column] = [Math.floor(y / zoom), Math.floor(x / zoom)];
      const error = values[measure][row][column] - expected(engine, measure, COSINES[column], ROUGHNESSES[row]);
      picture.fill(Math.round(Math.min(255, Math.max(0, 127.5 + (error / 0.01) * 127.5))), 4 * (y * w + x), 4 * (y * w + x) + 3);
    }
  }
  return encodePng(w, h, picture);
}
