// GLSL ES 3.00 between the text of a bake and a renderer.

import { fill } from "./surface.js";

/**
 * Variables and functions behind the text of a bake. `luthier_make_frame(normal, tangent, position, uv)` is the local frame of a pixel.
 * `luthier_fill(material, uv, distance, variance)` fills `luthier_here`, the place, from the maps. Behind `luthier_prepared = luthier_prepare_at(luthier_here, ...)`
 * the light of a lamp is `luthier_lit(color, direction)`, and that of an even irradiance `luthier_ambient(irradiance)`, where the bake has `albedo`. The uniforms
 * of the maps are those of `Surface.uniformsOf`, under the names of `names`.
 */
export function glslAround({ functions, surface }, names) {
  const has = (name) => functions.includes(name);
  return /* glsl */ `
LuthierPlace luthier_here;
vec4 luthier_base;
mat3 luthier_frame;
LuthierPrepared luthier_prepared;

vec3 luthier_unit_normal(vec3 t) {
  vec3 n = 2.0 * t - 1.0;
  return normalize(vec3(n.xy, max(n.z, 0.001)));
}

// Slopes add up.
vec3 luthier_lean(vec3 own, vec3 film) {
  return normalize(vec3(film.xy * own.z + own.xy * film.z, film.z * own.z));
}

void luthier_texel(uint material, uint kind, float distance, vec3 t) {
  ${surface.lines.texel}
}

// What the maps say of the place.
void luthier_fill(uint material, vec2 uv, float distance, float variance) {
  ${fill(surface, { sample: (i, at) => `texture(luthier_map_${i}, ${at})`, ...names })}
}

// Tangent, bitangent and normal; bitangents are against v. Without a tangent of the geometry it follows u.
mat3 luthier_make_frame(vec3 normal, vec4 given, vec3 position, vec2 uv) {
  vec3 p0 = dFdx(position), p1 = dFdy(position);
  vec2 t0 = dFdx(uv), t1 = dFdy(uv);
  vec3 e0 = cross(p1, normal), e1 = cross(normal, p0);
  float side = dot(p0, e0) < 0.0 ? -1.0 : 1.0;
  vec3 along = side * (e0 * t0.x + e1 * t1.x);
  float w = side * dot(cross(normal, along), e0 * t0.y + e1 * t1.y) > 0.0 ? -1.0 : 1.0;
  if (given.w != 0.0) {
    along = given.xyz;
    w = sign(given.w);
  }
  along -= normal * dot(normal, along);
  vec3 across = cross(normal, abs(normal.x) > 0.9 ? vec3(0.0, 0.0, 1.0) : vec3(1.0, 0.0, 0.0));
  vec3 tangent = normalize(dot(along, along) > 1e-30 ? along : across);
  return mat3(tangent, cross(normal, tangent) * w, normal);
}

vec3 luthier_lit(vec3 color, vec3 direction) {
  if (color == vec3(0.0)) return vec3(0.0);
  return ${has("luthier_light_lit") ? "luthier_light_lit(luthier_prepared, direction * luthier_frame, color)" : "color * luthier_light(luthier_prepared, direction * luthier_frame)"};
}
${has("luthier_albedo") ? `\nvec3 luthier_ambient(vec3 irradiance) { return irradiance / ${Math.PI} * luthier_albedo(luthier_prepared); }` : ""}`;
}
