// Chunks of PlayCanvas in WGSL, for the WebGPU device: those of src/glsl.js. PlayCanvas numbers the bindings.

import { fill, wgslAround, withOwnSamplers } from "luthier-web";

const sampler = (texture) => `${texture}Sampler`;

/** The front end of a bake: what is known before the loop over the lights begins. It is the same for all materials of the bake. */
function frontEnd(bake) {
  const { surface } = bake;
  const text = withOwnSamplers(bake.text, sampler);
  const at = (i, vector) => `uniform.luthier_values[${2 + 3 * i + vector}]`;
  const names = {
    kind: (i) => `u32(${at(i, 1)}.z)`,
    rows: (i) => `mat3x3f(vec3f(${at(i, 0)}.xy, 0.0), vec3f(${at(i, 0)}.zw, 0.0), vec3f(${at(i, 1)}.xy, 1.0))`,
    factor: (i) => `${at(i, 2)}.xyz`,
    base: "uniform.luthier_values[1]",
    sample: (i, at) => `textureSample(luthier_map_${i}, ${sampler(`luthier_map_${i}`)}, ${at})`,
  };
  // A texture that is read texel by texel has no sampler.
  const texture = (name, type = "texture_2d") =>
    text.includes(sampler(name)) || name.startsWith("luthier_map_") ? `var ${name}: ${type}<f32>;\nvar ${sampler(name)}: sampler;` : `var ${name}: ${type}<uff>;`;
  const cubes = bake.functions.includes("luthier_environment") ? ["luthier_environment_map", "luthier_irradiance_map"] : [];
  const textures = [
    ...[...bake.tables.keys()].map((name) => texture(name)),
    ...Array.from({ length: surface.width }, (_, i) => texture(`luthier_map_${i}`)),
    ...cubes.map((name) => texture(name, "texture_cube")),
  ];
  return /* wgsl */ `
#ifdef FORWARD_PASS
// Material, variance of slopes, and whether there is light from all around; the base; and of each map its rows, kind and factor.
uniform luthier_values: array<vec4f, ${2 + 3 * surface.width}>;
${textures.join("\n")}
var<storage, read> luthier_materials: array<vec4f>;
${text}
${wgslAround(bake)}
// Ambient light of PlayCanvas, as radiance.
var<private> luthier_even: vec3f;
#endif

fn evaluateFrontend() {
  litArgs_opacity = 1.0;
  #ifdef FORWARD_PASS
  let material = u32(uniform.luthier_values[0].x);
  let variance = uniform.luthier_values[0].y;
  let distance = distance(uniform.view_position, vPositionW);
  #ifdef VARYING_VUV0
  let uv = vUv0;
  #else
  let uv = vec2f(0.0);
  #endif
  // No normal is seen from behind.
  let normal = normalize(dVertexNormalW + max(0.02 - dot(dVertexNormalW, dViewDirW), 0.0) * dViewDirW);
  var tangent = vec4f(0.0);
  #ifdef LIT_TANGENTS
  tangent = vec4f(dTangentW, select(1.0, -1.0, dot(cross(normal, dTangentW), dBinormalW) < 0.0));
  #endif
  luthier_frame = luthier_make_frame(normal, tangent, vPositionW, uv);
  ${fill(surface, names)}
  luthier_prepared = luthier_prepare_at(luthier_here, material, dViewDirW * luthier_frame);
  litArgs_worldNormal = normal;
  litArgs_ao = 1.0;
  litArgs_specularity = vec3f(1.0);
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
      ? `fn getLightSpecular(h: vec3f, reflDir: vec3f, worldNormal: vec3f, viewDir: vec3f, lightDirNorm: vec3f, gloss: f32, tbn: mat3x3f) -> mat3x3f {
  return mat3x3f(${["vec3f(1.0, 0.0, 0.0)", "vec3f(0.0, 1.0, 0.0)", "vec3f(0.0, 0.0, 1.0)"].map(lit).join(", ")});
}
`
      : `fn getLightSpecular(h: vec3f, reflDir: vec3f, worldNormal: vec3f, viewDir: vec3f, lightDirNorm: vec3f, gloss: f32, tbn: mat3x3f) -> vec3f {
  return ${lit("vec3f(1.0)")};
}
`,
    // The cosine and Fresnel's share are in the factor.
    fresnelSchlickPS: "fn getFresnel(cosTheta: f32, gloss: f32, specularity: vec3f) -> vec3f { return vec3f(1.0); }\n",
    lightDiffuseLambertPS: "fn getLightDiffuse(worldNormal: vec3f, viewDir: vec3f, lightDirNorm: vec3f) -> f32 { return 1.0; }\n",
    // Lights with an area have no light on these materials.
    ltcPS: engine.get("ltcPS").replace(/dLTCSpecFres = [^;]+;/, "dLTCSpecFres = vec3f(0.0);"),
    ambientPS: engine.get("ambientPS").replaceAll("dDiffuseLight", "luthier_even"),
    combinePS: `fn combineColor(albedo: vec3f, sheenSpecularity: vec3f, clearcoatSpecularity: f32) -> vec3f {
  var sum = dSpecularLight;
  ${has("luthier_albedo") ? `sum += litArgs_ao * luthier_ambient(${Math.PI} * luthier_even);` : ""}
  ${has("luthier_environment") ? "if (uniform.luthier_values[0].z > 0.0) { sum += litArgs_ao * luthier_environment(luthier_prepared, luthier_frame, 0.0); }" : ""}
  return luthier_bounded(sum);
}
`,
  };
}
