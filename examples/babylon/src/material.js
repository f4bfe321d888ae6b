// A material of a bake: a PBRMaterial whose light is that of the bake. Lights with their falloff, shadows, fog, image processing, instances, skins and morph
// targets are those of Babylon.js.

import { MaterialPluginBase } from "@babylonjs/core/Materials/materialPluginBase.js";
import { PBRMaterial } from "@babylonjs/core/Materials/PBR/pbrMaterial.js";
import { ShaderLanguage } from "@babylonjs/core/Materials/shaderLanguage.js";
import * as glsl from "./glsl.js";
import * as wgsl from "./wgsl.js";

/** Settings of a PBRMaterial that a clone takes over. */
const SETTINGS = ["alpha", "alphaMode", "backFaceCulling", "cullBackFaces", "directIntensity", "disableDepthWrite", "emissiveColor", "environmentIntensity", "fogEnabled",
  "forceNormalForward", "maxSimultaneousLights", "sideOrientation", "transparencyMode", "twoSidedLighting", "usePhysicalLightFalloff", "useGLTFLightFalloff", "wireframe", "zOffset"];

export class LuthierMaterial extends PBRMaterial {
  constructor(bake, name, { slopeVariance = 0 } = {}) {
    super(name, bake.scene);
    const { number, entry } = bake.find(name);
    const { kinds, rows, factors, base } = bake.surface.uniformsOf(entry);
    /** Variance of the slopes of the normals that a pixel sees, along either axis: it widens highlights, as the size of a lamp does. */
    this.slopeVariance = slopeVariance;
    /** What the shader reads of this material. */
    this.luthier = { bake, number, base, textures: bake.texturesOf(entry), maps: kinds.flatMap((kind, i) => packed(rows[i], factors[i], kind)) };
    // The split sums of PBRMaterial are not read.
    this.environmentBRDFTexture = null;
    new LuthierPlugin(this);
  }

  getClassName() {
    return "LuthierMaterial";
  }

  /** Another material of the bake's program. */
  clone(name) {
    const { bake, number } = this.luthier;
    const copy = bake.material(bake.names[number], { slopeVariance: this.slopeVariance });
    for (const setting of SETTINGS) copy[setting] = this[setting];
    copy.name = copy.id = name;
    return copy;
  }

  /** Light from all around is that of the bake. */
  _getReflectionTexture() {
    return null;
  }
}

/** Four words of a map: the columns of its matrix, and its factor with its kind. */
function packed(columns, factor, kind) {
  return [0, 3, 6].flatMap((at) => [...columns.slice(at, at + 3), 0]).concat(factor, kind);
}

/** Puts the shader of a bake into that of PBRMaterial. */
class LuthierPlugin extends MaterialPluginBase {
  constructor(material) {
    super(material, "Luthier", 200, { LUTHIER_BAKE: 0 }, true, true);
    this.doNotSerialize = true;
  }

  getClassName() {
    return "LuthierPlugin";
  }

  /** The shader of a bake is in one language. */
  isCompatible(language) {
    return (language === ShaderLanguage.WGSL) === this._material.getScene().getEngine().isWebGPU;
  }

  getCustomCode(stage, language) {
    const code = language === ShaderLanguage.WGSL ? wgsl : glsl;
    return stage === "vertex" ? code.VERTEX : code.fragment(this._material.luthier.bake);
  }

  getUniforms(language) {
    const { width } = this._material.luthier.bake.surface;
    const ubo = [{ name: "luthier_material", size: 4, type: "vec4" }, { name: "luthier_map_base", size: 4, type: "vec4" }];
    if (width) ubo.push({ name: "luthier_maps", size: 4, type: "vec4", arraySize: 4 * width });
    return { ubo, fragment: (language === ShaderLanguage.WGSL ? wgsl : glsl).uniforms(ubo) };
  }

  getSamplers(samplers) {
    samplers.push(...Object.keys(this.#textures()));
  }

  prepareDefinesBeforeAttributes(defines) {
    defines._needUVs = defines.MAINUV1 = true;
  }

  prepareDefines(defines) {
    defines.LUTHIER_BAKE = this._material.luthier.bake.program;
    // Lights are taken as a whole.
    defines.SPECULARTERM = false;
  }

  bindForSubMesh(uniforms, scene, engine) {
    const { slopeVariance, luthier: { bake, number, base, maps } } = this._material;
    // Surroundings are right-handed.
    uniforms.updateFloat4("luthier_material", number, slopeVariance, Number(Boolean(bake.environment)), scene.useRightHandedSystem ? 1 : -1);
    uniforms.updateFloat4("luthier_map_base", ...base);
    if (maps.length) uniforms.updateArray("luthier_maps", maps);
    for (const [name, texture] of Object.entries(this.#textures())) uniforms.setTexture(name, texture);
    if (engine.isWebGPU) engine.setStorageBuffer("luthier_materials", bake.materials);
  }

  getActiveTextures(textures) {
    textures.push(...this._material.luthier.textures);
  }

  hasTexture(texture) {
    return this._material.luthier.textures.includes(texture);
  }

  /** Textures by the names that the shader calls them by. */
  #textures() {
    const { bake, textures } = this._material.luthier;
    const named = Object.fromEntries(bake.tables);
    if (!bake.scene.getEngine().isWebGPU) named.luthier_materials = bake.materials;
    for (let i = 0; i < bake.surface.width; i++) named[`luthier_map_${i}`] = textures[i] ?? bake.unused;
    if (bake.functions.includes("luthier_environment")) {
      named.luthier_environment_map = bake.environment?.environment ?? bake.black;
      named.luthier_irradiance_map = bake.environment?.irradiance ?? bake.black;
    }
    return named;
  }
}
