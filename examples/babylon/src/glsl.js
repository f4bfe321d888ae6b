// A bake in the shader of PBRMaterial, in GLSL ES 3.00: code by the points where Babylon.js takes it.

import { glslAround } from "luthier-web";

export const VERTEX = {
  CUSTOM_VERTEX_DEFINITIONS: `
#ifdef TANGENT
varying vec4 luthier_v_tangent;
#endif
`,
  // A mirrored part has its bitangents on the other side.
  CUSTOM_VERTEX_MAIN_END: `
#ifdef TANGENT
mat3 luthier_world = mat3(finalWorld);
luthier_v_tangent = vec4(luthier_world * tangentUpdated.xyz, tangentUpdated.w * sign(determinant(luthier_world)));
#endif
`,
};

const NAMES = {
  kind: (i) => `uint(luthier_maps[${4 * i + 3}].w)`,
  rows: (i) => `mat3(luthier_maps[${4 * i}].xyz, luthier_maps[${4 * i + 1}].xyz, luthier_maps[${4 * i + 2}].xyz)`,
  factor: (i) => `luthier_maps[${4 * i + 3}].xyz`,
  base: "luthier_map_base",
};

/** Uniforms for engines without uniform buffers. */
export const uniforms = (ubo) => ubo.map(({ name, type, arraySize }) => `uniform ${type} ${name}${arraySize ? `[${arraySize}]` : ""};`).join("\n");

export function fragment(bake) {
  const { text, functions, surface: { width } } = bake;
  const has = (name) => functions.includes(name);
  const maps = Array.from({ length: width }, (_, i) => `uniform sampler2D luthier_map_${i};`);
  return {
    CUSTOM_FRAGMENT_DEFINITIONS: `
${text}
${maps.join("\n")}
#ifdef TANGENT
varying vec4 luthier_v_tangent;
#endif
${glslAround(bake, NAMES)}

vec3 luthier_lamp(preLightingInfo info, vec3 color) { return luthier_lit(info.attenuation * color, info.L); }

// The colours of a hemisphere are radiances.
vec3 luthier_hemisphere(preLightingInfo info, vec3 sky, vec3 ground) {
  return ${has("luthier_albedo") ? "luthier_ambient(PI * mix(ground, sky, info.NdotL))" : "vec3(0.0)"};
}
`,
    CUSTOM_FRAGMENT_BEFORE_LIGHTS: `
{
  uint luthier_number = uint(luthier_material.x);
  // No normal is seen from behind.
  vec3 luthier_normal = normalize(normalW + max(0.02 - dot(normalW, viewDirectionW), 0.0) * viewDirectionW);
  vec4 luthier_tangent = vec4(0.0);
  #ifdef TANGENT
  luthier_tangent = luthier_v_tangent;
  #endif
  luthier_frame = luthier_make_frame(luthier_normal, luthier_tangent, vPositionW, vMainUV1);
  luthier_fill(luthier_number, vMainUV1, length(vEyePosition.xyz - vPositionW), luthier_material.y);
  luthier_prepared = luthier_prepare_at(luthier_here, luthier_number, viewDirectionW * luthier_frame);
}
`,
    // The loop over the lights is that of PBRMaterial.
    "!computeDiffuseLighting\\(preInfo,": "luthier_lamp(preInfo,",
    "!computeHemisphericDiffuseLighting\\(preInfo,": "luthier_hemisphere(preInfo,",
    "!computeAreaDiffuseLighting\\(preInfo,": "vec3(0.0) * (",
    CUSTOM_FRAGMENT_BEFORE_FOG: `
vec3 luthier_radiance = diffuseBase * vLightingIntensity.x;
${has("luthier_environment") ? `if (luthier_material.z > 0.0) {
  mat3 luthier_turned = mat3(1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, luthier_material.w);
  luthier_radiance += luthier_environment(luthier_prepared, luthier_turned * luthier_frame, 0.0) * vLightingIntensity.z;
}` : ""}
finalColor.rgb = luthier_bounded(luthier_radiance) + finalEmissive;
`,
  };
}
