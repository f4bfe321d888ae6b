//
// Materials, each a number and a constant:
//   0 varnished-gold, LUTHIER_MATERIAL_VARNISHED_GOLD: elek, 2 layers
//
// Model: elek (O. Elek, Layered Materials in Real-Time Rendering, CESCG 2010).
// No tables: Fresnel equations at three wavelengths, closed forms of D.
//
// Functions:
//   luthier_eval(material, wi, wo): f cos_theta_i, linear Rec.709; a light adds its irradiance times this
//   luthier_bounded(radiance): a sum over lights within 0..65504, which half floats hold
//   luthier_layer(material, index), luthier_layer_count(material): the layers as records, from the top
// wi points to the light and wo to the eye. Both are unit vectors in the local frame of the surface, away from it. +z is the normal, +x the
// tangent. Values are 0 where either is not above the horizon.
//
// Bindings, group 0:
//   6 luthier_materials: storage buffer, 33 vec4
// luthier_materials is materials.bin of the bake, byte for byte. Numbers from 16 up are yours.

const LUTHIER_MATERIAL_VARNISHED_GOLD: u32 = 0u;

@group(0) @binding(6) var<storage, read> luthier_materials: array<vec4<f32>>;

/// Channel by channel, the second value where a condition holds, and the first where it does not. HLSL 2021 has no conditions of three channels.
fn luthier_choose(first: vec3<f32>, second: vec3<f32>, holds: vec3<bool>) -> vec3<f32> {
    return vec3<f32>(
        select(first.x, second.x, holds.x),
        select(first.y, second.y, holds.y),
        select(first.z, second.z, holds.z),
    );
}

const LUTHIER_MATERIAL_WORDS: u32 = 11u;
const LUTHIER_LAYER_WORDS: u32 = 11u;

/// One layer of a material. Indices are relative to the medium above it; tiles are -1 where there is none.
struct LuthierLayer {
    /// 0 dielectric, 1 conductor, 2 diffuse base.
    kind: u32,
    /// Slope parameter of the micro-surface.
    alpha: f32,
    /// How fast D falls with the squared slope: 1 / alpha^2, over ln 2 for Beckmann.
    falloff: f32,
    /// A quarter of the greatest D, 1 / (4 pi alpha^2).
    peak: f32,
    /// Slope distribution: 0 Beckmann, 1 GGX, 2 Blinn, 3 ABC, 4 SGD.
    distribution: f32,
    /// Real part of the index below, at three wavelengths; F0 of an interface of Schlick's, RGB.
    ior_n: vec3<f32>,
    /// Imaginary part of it; of an interface of Schlick's -1 less the weight of its edge tint.
    ior_k: vec3<f32>,
    /// Index above over index below, for the refracted directions.
    inverse_eta: f32,
    /// Squared cosine of a refracted grazing direction, 1 - 1 / eta^2.
    grazing_cos_sq: f32,
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
    let head = luthier_materials[first];
    let base = luthier_materials[first + 3u];
    let real_part = luthier_materials[first + 4u];
    let imaginary_part = luthier_materials[first + 5u];
    let numbers = luthier_materials[first + 10u];
    var layer: LuthierLayer;
    layer.kind = luthier_whole(numbers.x);
    layer.alpha = numbers.y;
    layer.falloff = head.x;
    layer.peak = head.y;
    layer.inverse_eta = head.z;
    layer.grazing_cos_sq = head.w;
    layer.distribution = base.w;
    layer.ior_n = real_part.xyz;
    layer.ior_k = imaginary_part.xyz;
    return layer;
}

/// Complex numbers at three wavelengths.
struct LuthierComplex {
    re: vec3<f32>,
    im: vec3<f32>,
}

/// Normal component of the wave vector in a medium, over that above: sqrt((n + i k)^2 - sin_theta^2), both parts >= 0.
/// Formed without cancellation for an index near 1, under total reflection, and for weak absorption.
fn luthier_normal_index(ior_n: vec3<f32>, ior_k: vec3<f32>, cos_theta: f32) -> LuthierComplex {
    let square = (ior_n - 1.0) * (ior_n + 1.0) - ior_k * ior_k + cos_theta * cos_theta;
    let product = ior_n * ior_k;
    let modulus = sqrt(square * square + 4.0 * product * product);
    let large_sq = 0.5 * (modulus + abs(square));
    let small_sq = product * product / max(large_sq, vec3<f32>(1e-30));
    let propagates = square >= vec3<f32>(0.0);
    let re_sq = luthier_choose(small_sq, large_sq, propagates);
    let im_sq = luthier_choose(large_sq, small_sq, propagates);
    return LuthierComplex(sqrt(re_sq), sqrt(im_sq));
}

/// Exact Fresnel reflectance of unpolarised light for the relative index n + i k, total reflection included.
fn luthier_fresnel(ior_n: vec3<f32>, ior_k: vec3<f32>, cos_theta: f32) -> vec3<f32> {
    let below = luthier_normal_index(ior_n, ior_k, cos_theta);
    let sin_sq = 1.0 - cos_theta * cos_theta;
    let im_sq = below.im * below.im;
    let difference = below.re - cos_theta;
    let sum = below.re + cos_theta;
    let refl_s = (difference * difference + im_sq) / (sum * sum + im_sq);
    let along = below.re * cos_theta;
    let across = im_sq * cos_theta * cos_theta;
    let refl_ratio = ((along - sin_sq) * (along - sin_sq) + across) / ((along + sin_sq) * (along + sin_sq) + across);
    return 0.5 * refl_s * (1.0 + refl_ratio);
}

/// pi alpha^2 D of Beckmann, from squares of a half vector of any length. Beyond a slope of 10 it is zero in f32 for any alpha <= 1.
fn luthier_beckmann(falloff: f32, z_sq: f32, across_sq: f32) -> f32 {
    let slope_sq = min(across_sq / z_sq, 100.0);
    let secant_sq = 1.0 + slope_sq;
    return exp2(-slope_sq * falloff) * (secant_sq * secant_sq);
}

/// pi alpha^2 D of GGX (Trowbridge-Reitz), from squares of a half vector of any length.
fn luthier_ggx(falloff: f32, z_sq: f32, across_sq: f32) -> f32 {
    let ratio = (z_sq + across_sq) / (z_sq + across_sq * falloff);
    return ratio * ratio;
}

/// Fresnel reflectance of a layer at three wavelengths, its film included.
fn luthier_fresnel_term(layer: LuthierLayer, cos_theta_d: f32) -> vec3<f32> {
    return luthier_fresnel(layer.ior_n, layer.ior_k, cos_theta_d);
}

/// pi alpha^2 D of a layer whose falloff is `sharper` times its own, from squares of the half vector.
fn luthier_distribution_term(layer: LuthierLayer, sharper: f32, z_sq: f32, across_sq: f32) -> f32 {
    let falloff = layer.falloff;
    if layer.distribution > 0.5 {
        return luthier_ggx(falloff, z_sq, across_sq);
    }
    return luthier_beckmann(falloff, z_sq, across_sq);
}

/// D / 4 of a layer at the half vector along `bisector`, above the horizon.
fn luthier_quarter_density(layer: LuthierLayer, bisector: vec3<f32>) -> f32 {
    let z_sq = bisector.z * bisector.z;
    let across_sq = dot(bisector.xy, bisector.xy);
    return luthier_distribution_term(layer, 1.0, z_sq, across_sq) * layer.peak;
}

/// State of the light on its way down and back up: directions, and sums over the layers so far.
struct LuthierPath {
    /// To the light, in the medium above the next layer.
    wi_local: vec3<f32>,
    /// To the eye, in the medium above the next layer.
    wo_local: vec3<f32>,
    /// Sum of their tangential parts. It nearly cancels in a highlight, so that it is refracted as a whole.
    across: vec2<f32>,
    /// Share of the light that comes down to the next layer and back out.
    throughput: vec3<f32>,
    /// f of the layers so far.
    total: vec3<f32>,
    /// Whether any light reaches the next layer.
    open: bool,
}

/// Adds what a rough interface reflects (Torrance-Sparrow, F D G / (4 cos_theta_i cos_theta_o)) and goes on to the
/// layer below it (Weidlich and Wilkie 2007; Elek 2010, eq. 2-4).
fn luthier_add_interface(above: LuthierPath, layer: LuthierLayer) -> LuthierPath {
    let path = above;
    var next = path;
    next.open = false;

    let cosines = vec2<f32>(path.wi_local.z, path.wo_local.z);
    let bisector = vec3<f32>(path.across, cosines.x + cosines.y);
    let length_sq = dot(bisector.xy, bisector.xy) + bisector.z * bisector.z;
    // For unit directions cos_theta_d is half the length of their sum, which does not cancel at grazing angles.
    let secant_d = 2.0 * inverseSqrt(length_sq);
    let cos_theta_d = min(0.25 * length_sq * secant_d, 1.0);
    let fresnel = luthier_fresnel_term(layer, cos_theta_d);
    // G of V-cavities: 2 cos_theta_h / cos_theta_d times the lower cosine, at most 1.
    let masking = min(bisector.z * min(cosines.x, cosines.y) * (secant_d * secant_d), 1.0);
    let geometry = luthier_quarter_density(layer, bisector) * masking / (cosines.x * cosines.y);
    next.total = path.total + path.throughput * fresnel * geometry;

    // Refracted at the normal; the squared cosine does not cancel for an index near 1.
    let bent = cosines * layer.inverse_eta;
    let cosines_sq = bent * bent + layer.grazing_cos_sq;
    let secants = inverseSqrt(cosines_sq);
    let refracted = cosines_sq * secants;
    next.wi_local = vec3<f32>(path.wi_local.xy * layer.inverse_eta, refracted.x);
    next.wo_local = vec3<f32>(path.wo_local.xy * layer.inverse_eta, refracted.y);
    next.across = path.across * layer.inverse_eta;
    next.open = min(cosines_sq.x, cosines_sq.y) > 0.0;
    // (1 - F) down, (1 - F) up, and part of what the cavities block comes back: (1 - F) (1 - G + (1 - F) G).
    let returned = 1.0 - masking * fresnel;
    next.throughput = path.throughput * (1.0 - fresnel) * returned;
    return next;
}

/// f cos_theta_i of the model `elek`, both directions above the horizon.
fn luthier_eval_elek(material: u32, wi: vec3<f32>, wo: vec3<f32>) -> vec3<f32> {
    // Products of lower cosines would underflow; the outer one stays as it is.
    let down = vec3<f32>(wi.xy, max(wi.z, 1e-16));
    let up = vec3<f32>(wo.xy, max(wo.z, 1e-16));
    var path = LuthierPath(down, up, wi.xy + wo.xy, vec3<f32>(1.0), vec3<f32>(0.0), true);
    path = luthier_add_interface(path, luthier_layer(material, 0u));
    if path.open {
        path = luthier_add_interface(path, luthier_layer(material, 1u));
    }
    return wi.z * path.total;
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
