// Balls of two bakes in one WGSL module: each bake has a prefix, and numbers of bindings of its own (`luthier bake --prefix --first-binding`). No library.

import { readKtx2 } from "./src/ktx2.js";

const FORMATS = { r16float: [2, "r16float"], rg16float: [4, "rg16float"], rgba16float: [8, "rgba16float"], rgba8unorm: [4, "rgba8unorm"], rgb10a2unorm: [4, "rgb10a2unorm"], rg11b10ufloat: [4, "rg11b10ufloat"] };

/** The text of a bake, the entries of its bind group, and its number of a material. */
async function open(device, folder, material) {
  const load = async (path) => {
    const answer = await fetch(new URL(path, folder));
    if (!answer.ok) throw new Error(`${answer.url}: ${answer.status}`);
    return answer;
  };
  const manifest = await (await load("manifest.json")).json();
  const shader = manifest.shaders.find(({ target, form }) => target === "wgsl" && form === "baked");
  const text = await (await load(shader.file.path)).text();
  const { prefix } = manifest.names;
  const resources = manifest.bindings.filter(({ name }) => shader.interface.bindings.includes(name));
  const entries = resources.map(async ({ binding, name, resource }) => {
    if (resource === "sampler") return { binding, resource: device.createSampler({ magFilter: "linear", minFilter: "linear" }) };
    if (resource === "buffer") {
      const words = await (await load(manifest.material_buffer.path)).arrayBuffer();
      const buffer = device.createBuffer({ size: words.byteLength, usage: GPUBufferUsage.STORAGE | GPUBufferUsage.COPY_DST });
      device.queue.writeBuffer(buffer, 0, words);
      return { binding, resource: { buffer } };
    }
    const table = manifest.tables.find(({ kind }) => name === `${prefix}_${kind}`);
    const { width, height, levels } = await readKtx2(await (await load(table.texture.path)).arrayBuffer());
    const [bytes, format] = FORMATS[table.format];
    const texture = device.createTexture({ size: [width, height], format, usage: GPUTextureUsage.TEXTURE_BINDING | GPUTextureUsage.COPY_DST });
    device.queue.writeTexture({ texture }, levels[0], { bytesPerRow: width * bytes }, [width, height]);
    return { binding, resource: texture.createView() };
  });
  return { text, entries: await Promise.all(entries), prefix, number: manifest.materials.findIndex(({ name }) => name === material) };
}

/** What a material sends to the eye, by the functions of its bake. */
const shown = ({ prefix, number }, slope_variance) => /* wgsl */ `
fn show_${prefix}(wi: vec3<f32>, wo: vec3<f32>) -> vec3<f32> {
  var here = ${prefix}_place();
  here.slope_variance = ${slope_variance};
  return ${prefix}_light(${prefix}_prepare_at(here, ${number}u, wo), wi);
}
`;

/** The ball of `luthier preview --shape sphere` under one lamp; `which` chooses the bake. */
const program = ({ size, fov_y_deg, eye_distance, light, irradiance, slope_variance }, [first, second]) => /* wgsl */ `
${shown(first, slope_variance)}${shown(second, slope_variance)}
@group(1) @binding(0) var<uniform> which: u32;

@vertex
fn corner(@builtin(vertex_index) i: u32) -> @builtin(position) vec4<f32> {
  return vec4<f32>(f32(i % 2u) * 4.0 - 1.0, f32(i / 2u) * 4.0 - 1.0, 0.0, 1.0);
}

@fragment
fn ball(@builtin(position) pixel: vec4<f32>) -> @location(0) vec4<f32> {
  let at = (2.0 * pixel.xy / ${size}.0 - 1.0) * ${Math.tan((fov_y_deg * Math.PI) / 360)};
  let ray = normalize(vec3<f32>(at.x, -at.y, -1.0));
  let eye = vec3<f32>(0.0, 0.0, ${eye_distance}.0);
  let middle = -dot(ray, eye);
  let inside = 1.0 - (dot(eye, eye) - middle * middle);
  if (inside <= 0.0) { return vec4<f32>(0.0, 0.0, 0.0, 1.0); }
  let normal = eye + (middle - sqrt(inside)) * ray;
  let tangent = normalize(cross(vec3<f32>(0.0, 1.0, 0.0), normal));
  let frame = mat3x3<f32>(tangent, cross(normal, tangent), normal);
  let wi = normalize(vec3<f32>(${light})) * frame;
  let wo = -ray * frame;
  var value: vec3<f32>;
  if (which == 0u) { value = show_${first.prefix}(wi, wo); } else { value = show_${second.prefix}(wi, wo); }
  return vec4<f32>(vec3<f32>(${irradiance}) * value, 1.0);
}`;

async function main({ bakes, show, ...scene }) {
  const device = await (await navigator.gpu?.requestAdapter())?.requestDevice();
  if (!device) throw new Error("this browser has no WebGPU");
  const errors = [];
  device.addEventListener("uncapturederror", ({ error }) => errors.push(error.message));
  const packages = await Promise.all(bakes.map(({ folder, material }) => open(device, new URL(`/bake/${folder}/`, location), material)));
  const module = device.createShaderModule({ code: [...packages.map(({ text }) => text), program(scene, packages)].join("\n") });
  const { messages } = await module.getCompilationInfo();
  const bad = messages.find(({ type }) => type === "error");
  if (bad) throw new Error(`the program, line ${bad.lineNum}: ${bad.message}`);

  const format = "rgba8unorm-srgb";
  const pipeline = await device.createRenderPipelineAsync({ layout: "auto", vertex: { module }, fragment: { module, targets: [{ format }] } });
  const which = device.createBuffer({ size: 4, usage: GPUBufferUsage.UNIFORM | GPUBufferUsage.COPY_DST });
  device.queue.writeBuffer(which, 0, new Uint32Array([show]));
  const { size } = scene;
  const target = device.createTexture({ size: [size, size], format, usage: GPUTextureUsage.RENDER_ATTACHMENT | GPUTextureUsage.COPY_SRC });
  const read = device.createBuffer({ size: 4 * size * size, usage: GPUBufferUsage.MAP_READ | GPUBufferUsage.COPY_DST });
  const encoder = device.createCommandEncoder();
  const pass = encoder.beginRenderPass({ colorAttachments: [{ view: target.createView(), loadOp: "clear", storeOp: "store" }] });
  pass.setPipeline(pipeline);
  pass.setBindGroup(0, device.createBindGroup({ layout: pipeline.getBindGroupLayout(0), entries: packages.flatMap(({ entries }) => entries) }));
  pass.setBindGroup(1, device.createBindGroup({ layout: pipeline.getBindGroupLayout(1), entries: [{ binding: 0, resource: { buffer: which } }] }));
  pass.draw(3);
  pass.end();
  encoder.copyTextureToBuffer({ texture: target }, { buffer: read, bytesPerRow: 4 * size }, [size, size]);
  device.queue.submit([encoder.finish()]);
  await read.mapAsync(GPUMapMode.READ);
  if (errors.length) throw new Error(errors[0]);

  const canvas = document.createElement("canvas");
  canvas.width = canvas.height = size;
  canvas.getContext("2d").putImageData(new ImageData(new Uint8ClampedArray(read.getMappedRange()), size), 0, 0);
  return { picture: canvas.toDataURL("image/png"), driver: "WebGPU" };
}

const answer = await fetch("/scene.json").then((scene) => scene.json()).then(main).catch((error) => ({ error: String(error.stack ?? error) }));
await fetch("/save", { method: "POST", body: JSON.stringify(answer) });
