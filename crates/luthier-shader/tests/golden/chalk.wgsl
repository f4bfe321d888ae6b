//
// Materials, each a number and a constant:
//   0 chalk, LUTHIER_MATERIAL_CHALK: elek, 1 layer
//
// Model: elek (O. Elek, Layered Materials in Real-Time Rendering, CESCG 2010).
//
// Functions:
//   luthier_eval(material, wi, wo): f cos_theta_i, linear Rec.709; a light adds its irradiance times this
//   luthier_bounded(radiance): a sum over lights within 0..65504, which half floats hold
//   luthier_layer(material, index), luthier_layer_count(material): the layers as records, from the top
// wi points to the light and wo to the eye. Both are unit vectors in the local frame of the surface, away from it. +z is the normal, +x the
// tangent. Values are 0 where either is not above the horizon.
//
// Bindings, group 0:
//   6 luthier_materials: storage buffer, 22 vec4
// luthier_materials is materials.bin of the bake, byte for byte. Numbers from 16 up are yours.

const LUTHIER_MATERIAL_CHALK: u32 = 0u;

@group(0) @binding(6) var<storage, read> luthier_materials: array<vec4<f32>>;

const LUTHIER_MATERIAL_WORDS: u32 = 11u;
const LUTHIER_LAYER_WORDS: u32 = 11u;

/// One layer of a material. Indices are relative to the medium above it; tiles are -1 where there is none.
struct LuthierLayer {
    /// 0 dielectric, 1 conductor, 2 diffuse base.
    kind: u32,
    /// BRDF of a Lambertian base, albedo over pi, RGB.
    lambert: vec3<f32>,
}

/// A whole number n, which the buffer holds as 2^23 + n: its low bits are n.
fn luthier_whole(word: f32) -> u32 {
    return bitcast<u32>(word) & 0x7fffffu;
}

/// Index of the first word of a material in the buffer.
fn luthier_header(material: u32) -> u32 {
    return material * LUTHIER_MATERIAL_WORDS;
}

/// Number of layers of a material.
fn luthier_layer_count(material: u32) -> u32 {
    return luthier_whole(luthier_materials[luthier_header(material)].y);
}

/// A layer of a material, counted from the top.
fn luthier_layer(material: u32, index: u32) -> LuthierLayer {
    let first = luthier_whole(luthier_materials[luthier_header(material)].x) + index * LUTHIER_LAYER_WORDS;
    let base = luthier_materials[first + 3u];
    let numbers = luthier_materials[first + 10u];
    var layer: LuthierLayer;
    layer.kind = luthier_whole(numbers.x);
    layer.lambert = base.xyz;
    return layer;
}

/// BRDF of a Lambertian base.
fn luthier_diffuse(layer: LuthierLayer) -> vec3<f32> {
    return layer.lambert;
}

/// f cos_theta_i of the model `elek`, both directions above the horizon.
fn luthier_eval_elek(material: u32, wi: vec3<f32>, wo: vec3<f32>) -> vec3<f32> {
    let layer = luthier_layer(material, 0u);
    return wi.z * luthier_diffuse(layer);
}

/// f cos_theta_i, RGB, of a material for light from wi seen from wo: unit, in the local frame (+z is the normal), away
/// from the surface. Zero when either is not above the horizon. See `luthier_bounded` for the range.
fn luthier_eval(material: u32, wi: vec3<f32>, wo: vec3<f32>) -> vec3<f32> {
    if min(wi.z, wo.z) <= 0.0 {
        return vec3<f32>(0.0);
    }
    return luthier_eval_elek(material, wi, wo);
}

/// A sum over lights, clamped to what a picture of half floats holds, 0 to 65504. Highlights at grazing angles go beyond, colours outside
/// of Rec.709 have channels below 0: bound the sum, not its terms.
fn luthier_bounded(radiance: vec3<f32>) -> vec3<f32> {
    return clamp(radiance, vec3<f32>(0.0), vec3<f32>(65504.0));
}
