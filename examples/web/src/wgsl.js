// WGSL between the text of a bake and a renderer.

import { fill } from "./surface.js";

/** The text of a bake without its bindings, which the host writes. Each texture is read with a sampler of its own, whose name is `sampler(texture)`. */
export function withOwnSamplers(text, sampler) {
  return text
    .replace(/^@group\(0\) @binding\(\d+\) var.*$/gm, "")
    .replace(/\b(luthier_\w+), luthier_(?:environment_)?sampler\b/g, (_, texture) => `${texture}, ${sampler(texture)}`);
}

/** As `glslAround`, but without `luthier_fill`: its statements are `fill(surface, names)`, where the host has textures. */
export function wgslAround({ functions, surface }) {
  const has = (name) => functions.includes(name);
  return /* wgsl */ `
var<private> luthier_here: LuthierPlace;
var<private> luthier_base: vec4<f32>;
var<private> luthier_frame: mat3x3<f32>;
var<private> luthier_prepared: LuthierPrepared;

fn luthier_unit_normal(t: vec3<f32>) -> vec3<f32> {
  let n = 2.0 * t - 1.0;
  return normalize(vec3(n.xy, max(n.z, 0.001)));
}

// Slopes add up.
fn luthier_lean(own: vec3<f32>, film: vec3<f32>) -> vec3<f32> {
  return normalize(vec3(film.xy * own.z + own.xy * film.z, film.z * own.z));
}

fn luthier_texel(material: u32, kind: u32, distance: f32, t: vec3<f32>) {
  ${surface.lines.texel}
}

// Tangent, bitangent and normal; bitangents are against v. Without a tangent of the geometry it follows u.
fn luthier_make_frame(normal: vec3<f32>, given: vec4<f32>, position: vec3<f32>, uv: vec2<f32>) -> mat3x3<f32> {
  let p0 = dpdx(position);
  let p1 = dpdy(position);
  let t0 = dpdx(uv);
  let t1 = dpdy(uv);
  let e0 = cross(p1, normal);
  let e1 = cross(normal, p0);
  let side = select(1.0, -1.0, dot(p0, e0) < 0.0);
  var along = side * (e0 * t0.x + e1 * t1.x);
  var w = select(1.0, -1.0, side * dot(cross(normal, along), e0 * t0.y + e1 * t1.y) > 0.0);
  if (given.w != 0.0) {
    along = given.xyz;
    w = sign(given.w);
  }
  along -= normal * dot(normal, along);
  let across = cross(normal, select(vec3<f32>(1.0, 0.0, 0.0), vec3<f32>(0.0, 0.0, 1.0), abs(normal.x) > 0.9));
  let tangent = normalize(select(across, along, dot(along, along) > 1e-30));
  return mat3x3<f32>(tangent, cross(normal, tangent) * w, normal);
}

fn luthier_lit(color: vec3<f32>, direction: vec3<f32>) -> vec3<f32> {
  if (all(color == vec3<f32>(0.0))) { return vec3<f32>(0.0); }
  return ${has("luthier_light_lit") ? "luthier_light_lit(luthier_prepared, direction * luthier_frame, color)" : "color * luthier_light(luthier_prepared, direction * luthier_frame)"};
}
${has("luthier_albedo") ? `\nfn luthier_ambient(irradiance: vec3<f32>) -> vec3<f32> { return irradiance / ${Math.PI} * luthier_albedo(luthier_prepared); }` : ""}`;
}
