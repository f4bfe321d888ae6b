// A material of a bake for WebGPURenderer: the WGSL of the bake, called by the loop over the lights that three.js has.

import { Material, Matrix3, Vector3, Vector4 } from "three";
import { CodeNode, LightingModel, LightingNode, NodeMaterial, StorageBufferAttribute } from "three/webgpu";
import {
  cameraViewMatrix, determinant, materialReference, modelViewMatrix, modelWorldMatrix, normalView, positionView, positionViewDirection, reference, sign, storage,
  tangentGeometry, tangentLocal, texture, uniform, uv, varying, vec2, vec3, vec4, wgslFn,
} from "three/tsl";
import { fill, wgslAround, withOwnSamplers } from "luthier-web";

export class LuthierNodeMaterial extends NodeMaterial {
  static get type() {
    return "LuthierNodeMaterial";
  }

  constructor(bake, name, { slopeVariance = 0, ...parameters } = {}) {
    super();
    const { number, entry } = bake.find(name);
    this.name = name;
    this.lights = true;
    // Lights are all that is seen. A material with a node also has its uniforms written for each frame.
    this.colorNode = vec3(0);
    /** Variance of the slopes of the normals that a pixel sees, along either axis: it widens highlights, as the size of a lamp does. */
    this.slopeVariance = slopeVariance;
    /** What the nodes of the bake read of this material. */
    const { kinds, rows, factors, base } = bake.surface.uniformsOf(entry);
    this.luthier = {
      bake,
      number,
      textures: bake.texturesOf(entry),
      kinds,
      rows: rows.map((columns) => new Matrix3().fromArray(columns)),
      factors: factors.map((factor) => new Vector3(...factor)),
      base: new Vector4(...base),
    };
    this.setValues(parameters);
  }

  /** Another material with the bake's nodes. */
  clone() {
    const { bake, number } = this.luthier;
    return Material.prototype.copy.call(bake.material(bake.names[number], { slopeVariance: this.slopeVariance }), this);
  }

  get isLuthierNodeMaterial() {
    return true;
  }

  /** All materials of a bake have the same nodes. */
  customProgramCacheKey() {
    return `luthier ${nodesOf(this.luthier.bake).id}`;
  }

  setup(builder) {
    if (!builder.renderer.backend.isWebGPUBackend) throw new Error("LuthierNodeMaterial needs WebGPU. In WebGL take LuthierMaterial and WebGLRenderer");
    super.setup(builder);
  }

  setupLightingModel() {
    return new LuthierLighting(nodesOf(this.luthier.bake));
  }

  setupEnvironment() {
    const { environment } = nodesOf(this.luthier.bake);
    return environment && new LuthierEnvironmentNode(environment);
  }
}

/** The light that a material reflects: prepared for the eye once, then asked for each light. */
class LuthierLighting extends LightingModel {
  constructor(nodes) {
    super();
    this.nodes = nodes;
  }

  start(builder) {
    const { geometry } = builder;
    this.nodes.prepare(geometry.hasAttribute("uv"), geometry.hasAttribute("tangent")).toVar();
    super.start(builder);
  }

  direct({ lightDirection, lightColor, reflectedLight }) {
    reflectedLight.directSpecular.addAssign(this.nodes.light(lightDirection, lightColor));
  }

  indirect({ context: { irradiance, reflectedLight } }) {
    if (this.nodes.ambient) reflectedLight.indirectDiffuse.addAssign(this.nodes.ambient(irradiance));
  }

  finish({ context: { outgoingLight } }) {
    outgoingLight.assign(this.nodes.bounded(outgoingLight));
  }
}

/** Light from all around. */
class LuthierEnvironmentNode extends LightingNode {
  constructor(environment) {
    super();
    this.environment = environment;
  }

  setup({ context: { reflectedLight } }) {
    reflectedLight.indirectSpecular.addAssign(this.environment());
  }
}

/** The text of a bake, with the textures and the buffer that it reads under the names that it calls them by. */
class BakeCode extends CodeNode {
  constructor(code, globals) {
    super(code, [], "wgsl");
    this.globals = globals;
  }

  generate(builder) {
    for (const node of this.globals) node.build(builder, "property");
    return super.generate(builder);
  }
}

const made = new WeakMap();

/** The nodes of a bake, the same for all its materials. */
function nodesOf(bake) {
  if (!made.has(bake)) made.set(bake, makeNodes(bake));
  return made.get(bake);
}

let count = 0;

function makeNodes(bake) {
  const { width } = bake.surface;
  const has = (name) => bake.functions.includes(name);
  const places = Array.from({ length: width }, (_, i) => i);
  const cubes = has("luthier_environment") ? ["luthier_environment_map", "luthier_irradiance_map"] : [];
  const code = new BakeCode(wgsl(bake), [
    ...[...bake.tables].map(([name, table]) => texture(table).setName(name)),
    storage(new StorageBufferAttribute(bake.words, 4), "vec4", bake.words.length / 4).toReadOnly().setName("luthier_materials"),
    ...places.map((i) => materialReference(`luthier.textures.${i}`, "texture").setName(`luthier_map_${i}`)),
    ...cubes.map((name) => reference("value", "cubeTexture", bake.environmentUniforms[name]).setName(name)),
  ]);
  // A value of the material that is drawn.
  const own = (start, type, value) => uniform(start, type).onObjectUpdate(({ material }) => value(material));
  const numbers = {
    material: own(0, "uint", ({ luthier }) => luthier.number),
    variance: own(0, "float", ({ slopeVariance }) => slopeVariance),
    base: own(new Vector4(), "vec4", ({ luthier }) => luthier.base),
    ...Object.assign({}, ...places.map((i) => ({
      [`kind_${i}`]: own(0, "uint", ({ luthier }) => luthier.kinds[i]),
      [`rows_${i}`]: own(new Matrix3(), "mat3", ({ luthier }) => luthier.rows[i]),
      [`factor_${i}`]: own(new Vector3(1, 1, 1), "vec3", ({ luthier }) => luthier.factors[i]),
    }))),
  };
  const names = {
    kind: (i) => `kind_${i}`,
    rows: (i) => `rows_${i}`,
    factor: (i) => `factor_${i}`,
    base: "base",
    sample: (i, at) => `textureSample(luthier_map_${i}, luthier_map_${i}_sampler, ${at})`,
  };
  const fn = (text) => wgslFn(text, [code]);
  const prepare = fn(`fn luthier_start(material: u32, variance: f32, base: vec4<f32>,
    ${places.map((i) => `kind_${i}: u32, rows_${i}: mat3x3<f32>, factor_${i}: vec3<f32>, `).join("")}
    uv: vec2<f32>, wo: vec3<f32>, given_normal: vec3<f32>, tangent: vec4<f32>, position: vec3<f32>) -> f32 {
  // No normal is seen from behind.
  let normal = normalize(given_normal + max(0.02 - dot(given_normal, wo), 0.0) * wo);
  let distance = length(position);
  luthier_frame = luthier_make_frame(normal, tangent, position, uv);
  ${fill(bake.surface, names)}
  luthier_prepared = luthier_prepare_at(luthier_here, material, wo * luthier_frame);
  return 0.0;
}`);
  const light = fn("fn luthier_direct(color: vec3<f32>, direction: vec3<f32>) -> vec3<f32> { return luthier_lit(color, direction); }");
  const bounded = fn("fn luthier_sum(radiance: vec3<f32>) -> vec3<f32> { return luthier_bounded(radiance); }");
  const ambient = has("luthier_albedo") && fn("fn luthier_indirect(irradiance: vec3<f32>) -> vec3<f32> { return luthier_ambient(irradiance); }");
  const around = cubes.length && fn(`fn luthier_around(view: mat4x4<f32>, is_there: u32) -> vec3<f32> {
  if (is_there == 0u) { return vec3<f32>(0.0); }
  let world = transpose(mat3x3<f32>(view[0].xyz, view[1].xyz, view[2].xyz));
  return luthier_environment(luthier_prepared, world * luthier_frame, 0.0);
}`);
  const isThere = uniform(0, "uint").onRenderUpdate(() => Number(bake.environmentUniforms.luthier_has_environment.value));
  return {
    id: count++,
    prepare: (hasUv, hasTangent) => prepare({
      ...numbers,
      uv: hasUv ? uv() : vec2(0),
      wo: positionViewDirection,
      given_normal: normalView,
      tangent: hasTangent ? viewTangent() : vec4(0),
      position: positionView,
    }),
    light: (direction, color) => light({ direction, color }),
    bounded: (radiance) => bounded({ radiance }),
    ambient: ambient && ((irradiance) => ambient({ irradiance })),
    environment: around && (() => around({ view: cameraViewMatrix, is_there: isThere })),
  };
}

/** The tangent of the geometry. A mirrored part has its bitangents on the other side. */
function viewTangent() {
  const along = modelViewMatrix.mul(vec4(tangentLocal, 0)).xyz;
  return varying(vec4(along, tangentGeometry.w.mul(sign(determinant(modelWorldMatrix)))), "luthier_v_tangent");
}

/** The text of the bake without its bindings, which three.js writes, and what stands between it and three.js. */
function wgsl(bake) {
  return withOwnSamplers(bake.text, (texture) => `${texture}_sampler`).replace(/\bluthier_materials\[/g, "luthier_materials.value[") + wgslAround(bake);
}
