// A bake in the shader of PBRMaterial, in WGSL: as glsl.js.

import { fill, wgslAround, withOwnSamplers } from "luthier-web";

export const VERTEX = {
  CUSTOM_VERTEX_DEFINITIONS: `
#ifdef TANGENT
varying luthier_v_tangent: vec4f;
#endif
`,
  CUSTOM_VERTEX_MAIN_END: `
#ifdef TANGENT
let luthier_world = mat3x3f(finalWorld[0].xyz, finalWorld[1].xyz, finalWorld[2].xyz);
vertexOutputs.luthier_v_tangent = vec4f(luthier_world * tangentUpdated.xyz, tangentUpdated.w * sign(determinant(luthier_world)));
#endif
`,
};

const NAMES = {
  kind: (i) => `u32(uniforms.luthier_maps[${4 * i + 3}].w)`,
  rows: (i) => `mat3x3f(uniforms.luthier_maps[${4 * i}].xyz, uniforms.luthier_maps[${4 * i + 1}].xyz, uniforms.luthier_maps[${4 * i + 2}].xyz)`,
  factor: (i) => `uniforms.luthier_maps[${4 * i + 3}].xyz`,
  base: "uniforms.luthier_map_base",
  sample: (i, at) => `textureSample(luthier_map_${i}, luthier_map_${i}Sampler, ${at})`,
};

/** Uniforms are in a buffer. */
export const uniforms = () => undefined;

export function fragment(bake) {
  const { text, tables, functions, surface } = bake;
  const has = (name) => functions.includes(name);
  const texture = (type) => (name) => `var ${name}Sampler: sampler;\nvar ${name}: ${type}<f32>;`;
  const maps = Array.from({ length: surface.width }, (_, i) => `luthier_map_${i}`);
  const cubes = has("luthier_environment") ? ["luthier_environment_map", "luthier_irradiance_map"] : [];
  return {
    CUSTOM_FRAGMENT_DEFINITIONS: `
${[...tables.keys(), ...maps].map(texture("texture_2d")).join("\n")}
${cubes.map(texture("texture_cube")).join("\n")}
var<storage, read> luthier_materials: array<vec4f>;
#ifdef TANGENT
varying luthier_v_tangent: vec4f;
#endif
${withOwnSamplers(text, (name) => `${name}Sampler`)}
${wgslAround(bake)}

fn luthier_lamp(info: preLightingInfo, color: vec3f) -> vec3f { return luthier_lit(info.attenuation * color, info.L); }

// The colours of a hemisphere are radiances.
fn luthier_hemisphere(info: preLightingInfo, sky: vec3f, ground: vec3f) -> vec3f {
  return ${has("luthier_albedo") ? "luthier_ambient(PI * mix(ground, sky, info.NdotL))" : "vec3f(0.0)"};
}
`,
    CUSTOM_FRAGMENT_BEFORE_LIGHTS: `
{
  let material = u32(uniforms.luthier_material.x);
  let variance = uniforms.luthier_material.y;
  let uv = fragmentInputs.vMainUV1;
  let distance = length(scene.vEyePosition.xyz - fragmentInputs.vPositionW);
  // No normal is seen from behind.
  let normal = normalize(normalW + max(0.02 - dot(normalW, viewDirectionW), 0.0) * viewDirectionW);
  var tangent = vec4f(0.0);
  #ifdef TANGENT
  tangent = fragmentInputs.luthier_v_tangent;
  #endif
  luthier_frame = luthier_make_frame(normal, tangent, fragmentInputs.vPositionW, uv);
  ${fill(surface, NAMES)}
  luthier_prepared = luthier_prepare_at(luthier_here, material, viewDirectionW * luthier_frame);
}
`,
    // Babylon.js has a function for numbers under the name of a built-in one, which the bake calls with vectors.
    "!fn saturate\\(x: f32\\) *-> *f32 *\\{[^}]*\\}": " ",
    "!computeDiffuseLighting\\(preInfo,": "luthier_lamp(preInfo,",
    "!computeHemisphericDiffuseLighting\\(preInfo,": "luthier_hemisphere(preInfo,",
    "!computeAreaDiffuseLighting\\(preInfo,": "vec3f(0.0) * (",
    CUSTOM_FRAGMENT_BEFORE_FOG: `
var luthier_radiance = diffuseBase * uniforms.vLightingIntensity.x;
${has("luthier_environment") ? `if (uniforms.luthier_material.z > 0.0) {
  let turned = mat3x3f(1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, uniforms.luthier_material.w);
  luthier_radiance += luthier_environment(luthier_prepared, turned * luthier_frame, 0.0) * uniforms.vLightingIntensity.z;
}` : ""}
finalColor = vec4f(luthier_bounded(luthier_radiance) + finalEmissive, finalColor.a);
`,
  };
}
