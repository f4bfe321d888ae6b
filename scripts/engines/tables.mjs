// Audits the tables that engines ship, and prints docs/pages/engine-tables.md:
//   node extract.mjs DIR > DIR/list && node tables.mjs DIR/list > docs/pages/engine-tables.md
// A list has one line of JSON for each table, as extract.mjs prints them. LUTHIER names the program.
// Beside each table stands what `luthier table` bakes in the same layout, where there is a preset.

import { execFileSync, spawnSync } from "node:child_process";
import { mkdtempSync, readFileSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import path from "node:path";

const luthier = process.env.LUTHIER ?? "luthier";
const tables = process.argv.slice(2).flatMap((file) =>
  readFileSync(file, "utf8").split("\n").filter(Boolean).map((line) => JSON.parse(line)));
const work = mkdtempSync(path.join(tmpdir(), "engine-tables-"));

/** The outcome of an audit. It exits with 1 where the error is beyond its limit, which is no failure here. */
function audit(args) {
  const limits = ["--min-cos", "0.01", "--min-alpha", "0.01"];
  const { stdout, stderr, status } = spawnSync(luthier, ["audit", ...args, ...limits, "--json"], { encoding: "utf8" });
  if (status > 1) throw new Error(stderr);
  return JSON.parse(stdout);
}

const scientific = (x) => (x === undefined || x === null ? "–" : x.toExponential(1));
const bytes = (n) => (n < 1024 ? `${n} B` : `${(n / 1024).toFixed(1)} KiB`);
const place = (stats) => `${stats.worst.at[0].toFixed(3)}, ${stats.worst.at[1].toFixed(3)}`;

console.log(`# Tables that engines ship, audited

Made by \`scripts/engine-tables.sh\`. Each table is read as its engine reads it, and judged by \`luthier audit\`: bilinear, 8-bit weights, over
cos_theta and alpha from 0.01 on, against quadrature. *Mistake* is what the audit finds: the table as its engine reads it differs from the
function in this way. *Left* is the largest error after the mistake is taken into account. *Ours* is the largest error of the table that \`luthier
table dfg --preset\` bakes in the same layout and size, in the channels that the audit judges: what the layout leaves.

| engine | table | texels | bytes shipped | largest error | at cos_theta, alpha | rms | mistake | left | ours |
|---|---|---|--:|--:|---|--:|---|--:|--:|`);
const notes = [];
for (const table of tables) {
  const name = `${table.engine} ${table.version}`;
  const size = `${table.size.join(" x ")}, ${table.samples}`;
  if (!table.audit) {
    notes.push(`- ${name}, ${table.table} (${size}): ${table.holds}. The audit has no model of it.`);
    continue;
  }
  const { audit: found, line } = audit(table.audit);
  const { stated, remaining } = found;
  const preset = table.audit[table.audit.indexOf("--preset") + 1];
  let ours = "–";
  if (table.audit.includes("--preset") && table.table === "dfg" && !table.other) {
    const args = ["table", "dfg", "--preset", preset, "-o", path.join(work, preset), "--json"];
    const { stdout, status } = spawnSync(luthier, args, { encoding: "utf8" });
    const judged = ["scale", "bias", "albedo"];
    const channels = status === 0 ? JSON.parse(stdout).channels.filter(({ value }) => judged.includes(value)) : [];
    if (channels.length > 0) ours = scientific(Math.max(...channels.map((channel) => channel.max_abs_err)));
  }
  const mistake = line.replace("fits better as: ", "");
  console.log(`| ${name} | ${table.table} | ${size} | ${bytes(table.shipped)} | ${scientific(stated.max_abs_err)} | ${place(stated)} | ${
    scientific(stated.rms_err)} | ${mistake === "as stated" ? "none" : mistake} | ${
    scientific(remaining?.max_abs_err)} | ${ours} |`);
}
rmSync(work, { recursive: true });
console.log(`\nSources: ${[...new Set(tables.map((t) => `${t.engine} ${t.version}: ${t.source}`))].join("; ")}.`);
if (notes.length > 0) console.log(`\n${notes.join("\n")}`);
