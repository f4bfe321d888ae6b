// A material of a bake: PlayCanvas' standard material with another front end, and other light of its lamps.

import { SHADERLANGUAGE_GLSL, SHADERLANGUAGE_WGSL, ShaderChunks, SPECOCC_NONE, StandardMaterial } from "playcanvas";
import { mapKey } from "luthier-web";
import * as glsl from "./glsl.js";
import * as wgsl from "./wgsl.js";

export class LuthierMaterial extends StandardMaterial {
  #bake;
  #values;

  constructor(bake, name, { slopeVariance = 0 } = {}) {
    super();
    const { number, entry } = bake.find(name);
    this.name = name;
    this.#bake = bake;
    this.shaderChunksVersion = "2.23";
    const chunks = this.getShaderChunks(textOf(bake).language);
    for (const [chunk, text] of Object.entries(textOf(bake).chunks)) chunks.set(chunk, text);
    // The tangents of a geometry come with GGX, and its texture coordinates with a map.
    Object.assign(this, { enableGGXSpecular: true, diffuseMap: bake.white, useSkybox: false, occludeSpecular: SPECOCC_NONE });

    this.#values = valuesOf(bake, number, entry);
    this.setParameter("luthier_values[0]", this.#values);
    this.slopeVariance = slopeVariance;
    for (const [texture, value] of bake.resources) this.setParameter(texture, value);
    const maps = bake.surface.mapsOf(entry);
    for (let i = 0; i < bake.surface.width; i++) this.setParameter(`luthier_map_${i}`, maps[i] ? bake.maps.get(mapKey(maps[i])) : bake.white);
    this.update();
    bake.materials.add(this);
    this.setEnvironment(bake.environment);
  }

  /** Another material of the bake's program. */
  clone() {
    return this.#bake.material(this.#bake.names[this.#values[0]]).copy(this);
  }

  /** Takes the settings of another material of the bake. */
  copy(source) {
    super.copy(source);
    this.#values.set(source.#values);
    this.setParameter("luthier_values[0]", this.#values);
    return this;
  }

  destroy() {
    this.#bake.materials.delete(this);
    super.destroy();
  }

  get isLuthierMaterial() {
    return true;
  }

  /** Variance of the slopes of the normals that a pixel sees, along either axis: it widens highlights, as the size of a lamp does. */
  get slopeVariance() {
    return this.#values[1];
  }

  set slopeVariance(variance) {
    this.#values[1] = variance;
  }

  /** Light from all around: the cubes of the bake; null for none. */
  setEnvironment(cubes) {
    this.#values[2] = Number(Boolean(cubes));
    if (!cubes) return;
    this.setParameter("luthier_environment_map", cubes.environment);
    this.setParameter("luthier_irradiance_map", cubes.irradiance);
  }
}

/** What src/glsl.js calls `luthier_values`. */
function valuesOf({ surface }, number, entry) {
  const { kinds, rows, factors, base } = surface.uniformsOf(entry);
  const maps = kinds.flatMap((kind, i) => {
    const [a, d, , b, e, , c, f] = rows[i];
    return [a, d, b, e, c, f, kind, 0, ...factors[i], 0];
  });
  return Float32Array.from([number, 0, 0, 0, ...base, ...maps]);
}

const texts = new WeakMap();

/** The chunks of a bake, the same for all its materials. */
function textOf(bake) {
  if (!texts.has(bake)) {
    const { isWebGPU } = bake.device;
    const language = isWebGPU ? SHADERLANGUAGE_WGSL : SHADERLANGUAGE_GLSL;
    const { chunks } = isWebGPU ? wgsl : glsl;
    texts.set(bake, { language, chunks: chunks(bake, ShaderChunks.get(bake.device, language)) });
  }
  return texts.get(bake);
}
