// A material of a bake for WebGLRenderer: lights, shadows, fog and tone curve are those of three.js.

import { DataTexture, FloatType, Material, RGBAFormat, ShaderMaterial, UniformsLib, UniformsUtils } from "three";
import { glslAround } from "luthier-web";

export class LuthierMaterial extends ShaderMaterial {
  #clone;

  constructor(bake, name, { slopeVariance = 0, ...parameters } = {}) {
    super({ lights: true, fog: true, defines: { USE_TANGENT: "" }, ...programOf(bake) });
    const { number, entry } = bake.find(name);
    const { kinds, rows, factors, base } = bake.surface.uniformsOf(entry);
    this.type = "LuthierMaterial";
    this.name = name;
    this.uniforms = {
      ...UniformsUtils.merge([UniformsLib.lights, UniformsLib.fog]),
      ...bake.environmentUniforms,
      ...tablesOf(bake),
      luthier_material: { value: number },
      luthier_slope_variance: { value: slopeVariance },
      luthier_map_kinds: { value: kinds },
      luthier_map_rows: { value: rows.flat() },
      luthier_map_factors: { value: factors.flat() },
      luthier_map_base: { value: base },
    };
    bake.texturesOf(entry).forEach((texture, i) => (this.uniforms[`luthier_map_${i}`] = { value: texture }));
    // Tangents of geometries without any; the shader makes some of the texture coordinates.
    this.defaultAttributeValues = { ...this.defaultAttributeValues, tangent: [0, 0, 0, 0] };
    this.setValues(parameters);
    this.#clone = () => bake.material(name, { slopeVariance: this.slopeVariance });
  }

  /** Another material of the bake's program. */
  clone() {
    return Material.prototype.copy.call(this.#clone(), this);
  }

  get isLuthierMaterial() {
    return true;
  }

  /** Variance of the slopes of the normals that a pixel sees, along either axis: it widens highlights, as the size of a lamp does. */
  get slopeVariance() {
    return this.uniforms.luthier_slope_variance.value;
  }

  set slopeVariance(variance) {
    this.uniforms.luthier_slope_variance.value = variance;
  }
}

const tables = new WeakMap();

/** Uniforms of the tables and of the material buffer: a texture, because GLSL ES 3.00 has no storage buffers. */
function tablesOf(bake) {
  if (!tables.has(bake)) {
    const { width, height } = bake.manifest.material_texture;
    const words = new DataTexture(bake.words, width, height, RGBAFormat, FloatType);
    words.needsUpdate = true;
    const uniforms = Object.fromEntries([...bake.tables].map(([name, texture]) => [name, { value: texture }]));
    tables.set(bake, { ...uniforms, luthier_materials: { value: words } });
  }
  return tables.get(bake);
}

const programs = new WeakMap();

/** The shaders of a bake, the same for all its materials. */
function programOf(bake) {
  if (!programs.has(bake)) programs.set(bake, { vertexShader: VERTEX, fragmentShader: fragment(bake) });
  return programs.get(bake);
}

const VERTEX = /* glsl */ `
varying vec3 vViewPosition;
varying vec4 luthier_v_tangent;
varying vec2 luthier_v_uv;
#include <common>
#include <batching_pars_vertex>
#include <fog_pars_vertex>
#include <normal_pars_vertex>
#include <morphtarget_pars_vertex>
#include <skinning_pars_vertex>
#include <shadowmap_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <clipping_planes_pars_vertex>

void main() {
  #include <batching_vertex>
  #include <beginnormal_vertex>
  #include <morphinstance_vertex>
  #include <morphnormal_vertex>
  #include <skinbase_vertex>
  #include <skinnormal_vertex>
  #include <defaultnormal_vertex>
  #include <normal_vertex>
  #include <begin_vertex>
  #include <morphtarget_vertex>
  #include <skinning_vertex>
  #include <project_vertex>
  #include <logdepthbuf_vertex>
  #include <clipping_planes_vertex>
  vViewPosition = -mvPosition.xyz;
  // A mirrored part has its bitangents on the other side.
  luthier_v_tangent = vec4(transformedTangent, tangent.w * sign(determinant(mat3(modelMatrix))));
  luthier_v_uv = uv;
  #include <worldpos_vertex>
  #include <shadowmap_vertex>
  #include <fog_vertex>
}`;

/** How the shader names what `uniformsOf` has. */
const NAMES = {
  kind: (i) => `luthier_map_kinds[${i}]`,
  rows: (i) => `luthier_map_rows[${i}]`,
  factor: (i) => `luthier_map_factors[${i}]`,
  base: "luthier_map_base",
};

function fragment(bake) {
  const { text, functions, surface: { width } } = bake;
  const has = (name) => functions.includes(name);
  const samplers = Array.from({ length: width }, (_, i) => `uniform sampler2D luthier_map_${i};`).join("\n");
  return /* glsl */ `
varying vec3 vViewPosition;
varying vec4 luthier_v_tangent;
varying vec2 luthier_v_uv;
#include <common>
#include <fog_pars_fragment>
#include <lights_pars_begin>
#include <normal_pars_fragment>
#include <shadowmap_pars_fragment>
#include <logdepthbuf_pars_fragment>
#include <clipping_planes_pars_fragment>
${text}
uniform uint luthier_material;
uniform float luthier_slope_variance;
uniform bool luthier_has_environment;
uniform vec4 luthier_map_base;
${width ? `uniform uint luthier_map_kinds[${width}];\nuniform mat3 luthier_map_rows[${width}];\nuniform vec3 luthier_map_factors[${width}];` : ""}
${samplers}
${glslAround(bake, NAMES)}

// The loop over the lights is that of three.js.
#define RE_Direct(light, position, normal, view, coat_normal, material, reflected) reflected += luthier_lit(light.color, light.direction)
${has("luthier_albedo") ? "#define RE_IndirectDiffuse" : ""}

void main() {
  #include <clipping_planes_fragment>
  #include <logdepthbuf_fragment>
  vec3 luthier_wo = isOrthographic ? vec3(0.0, 0.0, 1.0) : normalize(vViewPosition);
  vec3 normal = normalize(vNormal);
  #ifdef DOUBLE_SIDED
  normal *= gl_FrontFacing ? 1.0 : -1.0;
  #endif
  // No normal is seen from behind.
  normal = normalize(normal + max(0.02 - dot(normal, luthier_wo), 0.0) * luthier_wo);
  luthier_frame = luthier_make_frame(normal, luthier_v_tangent, -vViewPosition, luthier_v_uv);
  luthier_fill(luthier_material, luthier_v_uv, length(vViewPosition), luthier_slope_variance);
  luthier_prepared = luthier_prepare_at(luthier_here, luthier_material, luthier_wo * luthier_frame);
  vec3 reflectedLight = vec3(0.0);
  #include <lights_fragment_begin>
  ${has("luthier_albedo") ? "reflectedLight += luthier_ambient(irradiance);" : ""}
  ${has("luthier_environment") ? "if (luthier_has_environment) reflectedLight += luthier_environment(luthier_prepared, transpose(mat3(viewMatrix)) * luthier_frame, 0.0);" : ""}
  gl_FragColor = vec4(luthier_bounded(reflectedLight), 1.0);
  #include <tonemapping_fragment>
  #include <colorspace_fragment>
  #include <fog_fragment>
}`;
}
