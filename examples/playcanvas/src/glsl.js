// Chunks of PlayCanvas in GLSL ES 3.00, for the WebGL 2 device. The loop over the lights, shadows, fog and tone curve are those of PlayCanvas.

import { glslAround } from "luthier-web";

/** The front end of a bake: what is known before the loop over the lights begins. It is the same for all materials of the bake. */
function frontEnd(bake) {
  const { text, surface } = bake;
  const at = (i, vector) => `luthier_values[${2 + 3 * i + vector}]`;
  const names = {
    kind: (i) => `uint(${at(i, 1)}.z)`,
    rows: (i) => `mat3(vec3(${at(i, 0)}.xy, 0.0), vec3(${at(i, 0)}.zw, 0.0), vec3(${at(i, 1)}.xy, 1.0))`,
    factor: (i) => `${at(i, 2)}.xyz`,
    base: "luthier_values[1]",
  };
  const maps = Array.from({ length: surface.width }, (_, i) => `uniform sampler2D luthier_map_${i};`).join("\n");
  return /* glsl */ `
#ifdef FORWARD_PASS
${text}
// Material, variance of slopes, and whether there is light from all around; the base; and of each map its rows, kind and factor.
uniform vec4 luthier_values[${2 + 3 * surface.width}];
${maps}
${glslAround(bake, names)}
// Ambient light of PlayCanvas, as radiance.
vec3 luthier_even;
#endif

void evaluateFrontend() {
  litArgs_opacity = 1.0;
  #ifdef FORWARD_PASS
  uint material = uint(luthier_values[0].x);
  #ifdef VARYING_VUV0
  vec2 uv = vUv0;
  #else
  vec2 uv = vec2(0.0);
  #endif
  // No normal is seen from behind.
  vec3 normal = normalize(dVertexNormalW + max(0.02 - dot(dVertexNormalW, dViewDirW), 0.0) * dViewDirW);
  vec4 tangent = vec4(0.0);
  #ifdef LIT_TANGENTS
  tangent = vec4(dTangentW, dot(cross(normal, dTangentW), dBinormalW) < 0.0 ? -1.0 : 1.0);
  #endif
  luthier_frame = luthier_make_frame(normal, tangent, vPositionW, uv);
  luthier_fill(material, uv, distance(view_position, vPositionW), luthier_values[0].y);
  luthier_prepared = luthier_prepare_at(luthier_here, material, dViewDirW * luthier_frame);
  litArgs_worldNormal = normal;
  litArgs_ao = 1.0;
  litArgs_specularity = vec3(1.0);
  #endif
}
`;
}

/** Chunks in place of those of the engine, by their names. `engine` has the engine's. */
export function chunks(bake, engine) {
  const has = (name) => bake.functions.includes(name);
  const lit = (color) => `${Math.PI} * luthier_lit(${color}, -lightDirNorm)`;
  return {
    stdDeclarationPS: '#include "litShaderArgsPS"\n',
    stdFrontEndPS: frontEnd(bake),
    // The factor of a light, and of its colour. A fluorescent base has a matrix in its place.
    lightSpecularGGXPS: has("luthier_light_lit")
      ? `mat3 getLightSpecular(vec3 h, vec3 reflDir, vec3 worldNormal, vec3 viewDir, vec3 lightDirNorm, float gloss, mat3 tbn) {
  return mat3(${["vec3(1.0, 0.0, 0.0)", "vec3(0.0, 1.0, 0.0)", "vec3(0.0, 0.0, 1.0)"].map(lit).join(", ")});
}
`
      : `vec3 getLightSpecular(vec3 h, vec3 reflDir, vec3 worldNormal, vec3 viewDir, vec3 lightDirNorm, float gloss, mat3 tbn) {
  return ${lit("vec3(1.0)")};
}
`,
    // The cosine and Fresnel's share are in the factor.
    fresnelSchlickPS: "vec3 getFresnel(float cosTheta, float gloss, vec3 specularity) { return vec3(1.0); }\n",
    lightDiffuseLambertPS: "float getLightDiffuse(vec3 worldNormal, vec3 viewDir, vec3 lightDirNorm) { return 1.0; }\n",
    // Lights with an area have no light on these materials.
    ltcPS: engine.get("ltcPS").replace(/dLTCSpecFres = [^;]+;/, "dLTCSpecFres = vec3(0.0);"),
    ambientPS: engine.get("ambientPS").replaceAll("dDiffuseLight", "luthier_even"),
    combinePS: `vec3 combineColor(vec3 albedo, vec3 sheenSpecularity, float clearcoatSpecularity) {
  vec3 sum = dSpecularLight;
  ${has("luthier_albedo") ? `sum += litArgs_ao * luthier_ambient(${Math.PI} * luthier_even);` : ""}
  ${has("luthier_environment") ? "if (luthier_values[0].z > 0.0) sum += litArgs_ao * luthier_environment(luthier_prepared, luthier_frame, 0.0);" : ""}
  return luthier_bounded(sum);
}
`,
  };
}
