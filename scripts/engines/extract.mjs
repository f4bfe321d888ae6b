// Writes the tables that engines ship in packages of npm into files that `luthier audit` reads:
//   npm ci --prefix scripts/engines --ignore-scripts
//   node scripts/engines/extract.mjs OUTDIR
// It prints one line of JSON for each table:
//   {engine, version, table, source, shipped, size, channels, samples, holds, file, audit}
// `file` is the path of the raw texels, rows from the top, little-endian. `luthier audit ...audit` judges them; `audit` is null where
// no model of the audit says what the table holds. `shipped` is the count of bytes that the package has for the table.
// No browser and no network.

import { mkdirSync, readFileSync, writeFileSync } from "node:fs";
import path from "node:path";

import { floatBytes, halfBytes, toHalf } from "./half.mjs";
import { decodePng } from "./png.mjs";
import { decodeRgbd } from "./rgbd.mjs";

const folder = process.argv[2];
if (!folder) {
  console.error("usage: node extract.mjs OUTDIR");
  process.exit(2);
}
mkdirSync(folder, { recursive: true });
const packages = new URL("node_modules/", import.meta.url);

/** Version of a package. */
function version(name) {
  return JSON.parse(readFileSync(new URL(`${name}/package.json`, packages), "utf8")).version;
}

/** Writes the texels of a table, and prints what they are. */
function table({ name, bytes, judged, ...facts }) {
  const file = path.join(folder, `${name}.bin`);
  writeFileSync(file, bytes);
  const [width, height] = facts.size;
  const raw = ["--size", `${width}x${height}`, "--channels", `${facts.channels}`, "--samples", facts.samples];
  console.log(JSON.stringify({ ...facts, file, audit: judged && [file, ...raw, ...judged] }));
}

// three.js, the split sum: half floats in a module.
{
  const source = "src/renderers/shaders/DFGLUTData.js";
  const { getDFGLUT } = await import(`three/${source}`);
  const { data, width, height } = getDFGLUT().image;
  const facts = { engine: "three.js", version: version("three"), table: "dfg", source, shipped: data.byteLength };
  table({
    name: "three-dfg",
    bytes: halfBytes(data),
    ...facts,
    size: [width, height],
    channels: 2,
    samples: "half",
    holds: "scale, bias",
    judged: ["--preset", "three"],
  });
}

// three.js, linearly transformed cosines of GGX: numbers in decimals, of which the renderer makes 32-bit or half floats.
{
  const source = "examples/jsm/lights/RectAreaLightTexturesLib.js";
  const { RectAreaLightTexturesLib } = await import(`three/${source}`);
  const { LTC_FLOAT_1, LTC_FLOAT_2 } = RectAreaLightTexturesLib.init();
  const shared = { engine: "three.js", version: version("three"), source, channels: 4, samples: "float" };
  const image = ({ data, width, height }) => ({ bytes: floatBytes(data), shipped: data.byteLength, size: [width, height] });
  const matrix = { ...shared, ...image(LTC_FLOAT_1.image), holds: "inverse matrix: m00, m02, m20, m22" };
  table({ name: "three-ltc-1", ...matrix, table: "ltc matrix", judged: null });
  const norm = { ...shared, ...image(LTC_FLOAT_2.image), holds: "albedo, bias, 0, sphere's form factor" };
  const judged = ["--model", "ggx-correlated", "--axes", "roughness,sqrt_one_minus_cos_theta", "--nodes", "ends"];
  table({ name: "three-ltc-2", ...norm, table: "ltc norm", judged: [...judged, "--values", "albedo,bias", "--channel", "r,g"] });
}

// Babylon.js: PNG with RGBD, which it expands to half floats when it starts.
{
  const source = "Misc/brdfTextureTools.js";
  const text = readFileSync(new URL(`@babylonjs/core/${source}`, packages), "utf8");
  const shared = { engine: "Babylon.js", version: version("@babylonjs/core"), source, channels: 3, samples: "half" };
  const image = (constant) => {
    const found = text.match(new RegExp(`${constant} = "data:image/png;base64,([^"]*)"`));
    if (!found) throw new Error(`${source} has no ${constant}`);
    const png = Buffer.from(found[1], "base64");
    const { width, height, channels, texels } = decodePng(png);
    const words = [];
    for (let at = 0; at < texels.length; at += channels) {
      const divisor = channels === 4 ? texels[at + 3] : 255;
      words.push(...decodeRgbd([...texels.subarray(at, at + 3), divisor]).map(toHalf));
    }
    return { bytes: halfBytes(words), shipped: png.length, size: [width, height] };
  };
  table({
    name: "babylon-dfg",
    ...shared,
    table: "dfg",
    ...image("_environmentBRDFBase64Texture"),
    holds: "bias, albedo, sheen",
    judged: ["--preset", "babylon", "--channel", "r,g"],
  });
  table({
    name: "babylon-openpbr",
    ...shared,
    table: "openpbr",
    ...image("_openPBREnvironmentBRDFBase64Texture"),
    holds: "bias, albedo, 16 times the term of F82",
    judged: ["--preset", "babylon", "--channel", "r,g"],
  });
  const fuzz = { ...shared, ...image("_environmentFuzzBRDFBase64Texture"), holds: "linearly transformed cosines of sheen" };
  table({ name: "babylon-fuzz", ...fuzz, table: "fuzz", judged: null });
}
