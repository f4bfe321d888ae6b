// Asks Khronos' validator about glTF files. Fails where one has an error or a warning; materials without a mesh are told as unused, which is no fault.
//   node validate.mjs FILE...
import { readFile } from "node:fs/promises";
import { dirname, join } from "node:path";
import { validateBytes } from "gltf-validator";

let failed = 0;
for (const path of process.argv.slice(2)) {
  const folder = dirname(path);
  const report = await validateBytes(new Uint8Array(await readFile(path)), {
    uri: path,
    externalResourceFunction: async (uri) => new Uint8Array(await readFile(join(folder, decodeURIComponent(uri)))),
  });
  const { numErrors, numWarnings, messages } = report.issues;
  for (const { severity, code, message, pointer } of messages) {
    if (severity < 2) console.error(`${path}: ${code} at ${pointer}: ${message}`);
  }
  console.log(`${path}: ${report.info.materialCount} materials, ${numErrors} errors, ${numWarnings} warnings`);
  failed += numErrors + numWarnings;
}
process.exit(failed > 0 || process.argv.length < 3 ? 1 : 0);
