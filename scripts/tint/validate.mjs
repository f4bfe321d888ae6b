// Compiles WGSL files with Tint (Dawn, its null backend): node validate.mjs FILE...
// Prints what Tint says and exits with 1 if any file has an error.
import { readFileSync } from 'node:fs';
import { create } from 'webgpu';

// Dawn lives as long as this object.
const gpu = create(['backend=null']);
const adapter = await gpu.requestAdapter();
const device = await adapter.requestDevice();
let failed = 0;
for (const file of process.argv.slice(2)) {
  device.pushErrorScope('validation');
  const module = device.createShaderModule({ code: readFileSync(file, 'utf8') });
  const { messages } = await module.getCompilationInfo();
  const error = await device.popErrorScope();
  for (const m of messages) console.log(`${file}:${m.lineNum}:${m.linePos}: ${m.type}: ${m.message}`);
  if (error || messages.some((m) => m.type === 'error')) failed += 1;
}
console.log(`tint: ${process.argv.length - 2 - failed} passed, ${failed} failed`);
// Dawn's threads do not end by themselves.
process.exit(failed ? 1 : 0);
