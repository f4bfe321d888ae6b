// Metal 2.0. Not checked by a Metal compiler.
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
// Bindings, by argument index of a complete shader:
//   buffer(6) luthier_materials: device LuthierMaterials const&, 33 float4
// A function takes those that it reads as its last arguments, in this order. luthier_materials is materials.bin of the bake, byte for byte.
// Numbers from 16 up are yours.

#include <metal_stdlib>
#include <simd/simd.h>

using metal::uint;

struct LuthierMaterials {
    metal::float4 inner[33];
};

// One layer of a material. Indices are relative to the medium above it; tiles are -1 where there is none.
struct LuthierLayer {
    // 0 dielectric, 1 conductor, 2 diffuse base.
    uint kind;
    // Slope parameter of the micro-surface.
    float alpha;
    // How fast D falls with the squared slope: 1 / alpha^2, over ln 2 for Beckmann.
    float falloff;
    // A quarter of the greatest D, 1 / (4 pi alpha^2).
    float peak;
    // Slope distribution: 0 Beckmann, 1 GGX, 2 Blinn, 3 ABC, 4 SGD.
    float distribution;
    char _pad5[12];
    // Real part of the index below, at three wavelengths; F0 of an interface of Schlick's, RGB.
    metal::float3 ior_n;
    // Imaginary part of it; of an interface of Schlick's -1 less the weight of its edge tint.
    metal::packed_float3 ior_k;
    // Index above over index below, for the refracted directions.
    float inverse_eta;
    // Squared cosine of a refracted grazing direction, 1 - 1 / eta^2.
    float grazing_cos_sq;
};

// Complex numbers at three wavelengths.
struct LuthierComplex {
    metal::float3 re;
    metal::float3 im;
};

// State of the light on its way down and back up: directions, and sums over the layers so far.
struct LuthierPath {
    // To the light, in the medium above the next layer.
    metal::float3 wi_local;
    // To the eye, in the medium above the next layer.
    metal::float3 wo_local;
    // Sum of their tangential parts. It nearly cancels in a highlight, so that it is refracted as a whole.
    metal::float2 across;
    char _pad3[8];
    // Share of the light that comes down to the next layer and back out.
    metal::float3 throughput;
    // f of the layers so far.
    metal::packed_float3 total;
    // Whether any light reaches the next layer.
    bool open;
};

constant uint LUTHIER_MATERIAL_VARNISHED_GOLD = 0u;
constant uint LUTHIER_MATERIAL_WORDS = 11u;
constant uint LUTHIER_LAYER_WORDS = 11u;

// Channel by channel, the second value where a condition holds, and the first where it does not. HLSL 2021 has no conditions of three channels.
metal::float3 luthier_choose(metal::float3 first, metal::float3 second, metal::bool3 holds) {
    return metal::float3(holds.x ? second.x : first.x, holds.y ? second.y : first.y, holds.z ? second.z : first.z);
}

// A whole number n, which the buffer holds as 2^23 + n: its low bits are n.
uint luthier_whole(float word) {
    return as_type<uint>(word) & 8388607u;
}

// Index of the first word of a material in the buffer.
uint luthier_header(uint material) {
    return material * LUTHIER_MATERIAL_WORDS;
}

// Number of layers of a material.
uint luthier_layer_count(uint material, device LuthierMaterials const& luthier_materials) {
    return luthier_whole(luthier_materials.inner[luthier_header(material)].y);
}

// A layer of a material, counted from the top.
LuthierLayer luthier_layer(uint material, uint index, device LuthierMaterials const& luthier_materials) {
    LuthierLayer layer = {};
    uint first = luthier_whole(luthier_materials.inner[luthier_header(material)].x) + (index * LUTHIER_LAYER_WORDS);
    metal::float4 head = luthier_materials.inner[first];
    metal::float4 base = luthier_materials.inner[first + 3u];
    metal::float4 real_part = luthier_materials.inner[first + 4u];
    metal::float4 imaginary_part = luthier_materials.inner[first + 5u];
    metal::float4 numbers = luthier_materials.inner[first + 10u];
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

// Normal component of the wave vector in a medium, over that above: sqrt((n + i k)^2 - sin_theta^2), both parts >= 0.
// Formed without cancellation for an index near 1, under total reflection, and for weak absorption.
LuthierComplex luthier_normal_index(metal::float3 ior_n, metal::float3 ior_k, float cos_theta) {
    metal::float3 square = (((ior_n - metal::float3(1.0)) * (ior_n + metal::float3(1.0))) - (ior_k * ior_k)) + metal::float3(cos_theta * cos_theta);
    metal::float3 product = ior_n * ior_k;
    metal::float3 modulus = metal::sqrt((square * square) + ((4.0 * product) * product));
    metal::float3 large_sq = 0.5 * (modulus + metal::abs(square));
    metal::float3 small_sq = (product * product) / metal::max(large_sq, metal::float3(0.000000000000000000000000000001));
    metal::bool3 propagates = square >= metal::float3(0.0);
    metal::float3 re_sq = luthier_choose(small_sq, large_sq, propagates);
    metal::float3 im_sq = luthier_choose(large_sq, small_sq, propagates);
    return LuthierComplex {metal::sqrt(re_sq), metal::sqrt(im_sq)};
}

// Exact Fresnel reflectance of unpolarised light for the relative index n + i k, total reflection included.
metal::float3 luthier_fresnel(metal::float3 ior_n, metal::float3 ior_k, float cos_theta) {
    LuthierComplex below = luthier_normal_index(ior_n, ior_k, cos_theta);
    float sin_sq = 1.0 - (cos_theta * cos_theta);
    metal::float3 im_sq = below.im * below.im;
    metal::float3 difference = below.re - metal::float3(cos_theta);
    metal::float3 sum = below.re + metal::float3(cos_theta);
    metal::float3 refl_s = ((difference * difference) + im_sq) / ((sum * sum) + im_sq);
    metal::float3 along = below.re * cos_theta;
    metal::float3 across = (im_sq * cos_theta) * cos_theta;
    metal::float3 refl_ratio = (((along - metal::float3(sin_sq)) * (along - metal::float3(sin_sq))) + across) / (((along + metal::float3(sin_sq)) * (along + metal::float3(sin_sq))) + across);
    return (0.5 * refl_s) * (metal::float3(1.0) + refl_ratio);
}

// pi alpha^2 D of Beckmann, from squares of a half vector of any length. Beyond a slope of 10 it is zero in f32 for any alpha <= 1.
float luthier_beckmann(float falloff, float z_sq, float across_sq) {
    float slope_sq = metal::min(across_sq / z_sq, 100.0);
    float secant_sq = 1.0 + slope_sq;
    return metal::exp2(-(slope_sq) * falloff) * (secant_sq * secant_sq);
}

// pi alpha^2 D of GGX (Trowbridge-Reitz), from squares of a half vector of any length.
float luthier_ggx(float falloff, float z_sq, float across_sq) {
    float ratio = (z_sq + across_sq) / (z_sq + (across_sq * falloff));
    return ratio * ratio;
}

// Fresnel reflectance of a layer at three wavelengths, its film included.
metal::float3 luthier_fresnel_term(LuthierLayer layer, float cos_theta_d) {
    return luthier_fresnel(layer.ior_n, layer.ior_k, cos_theta_d);
}

// pi alpha^2 D of a layer whose falloff is `sharper` times its own, from squares of the half vector.
float luthier_distribution_term(LuthierLayer layer, float sharper, float z_sq, float across_sq) {
    float falloff = layer.falloff;
    if (layer.distribution > 0.5) {
        return luthier_ggx(falloff, z_sq, across_sq);
    }
    return luthier_beckmann(falloff, z_sq, across_sq);
}

// D / 4 of a layer at the half vector along `bisector`, above the horizon.
float luthier_quarter_density(LuthierLayer layer, metal::float3 bisector) {
    float z_sq = bisector.z * bisector.z;
    float across_sq = metal::dot(bisector.xy, bisector.xy);
    return luthier_distribution_term(layer, 1.0, z_sq, across_sq) * layer.peak;
}

// Adds what a rough interface reflects (Torrance-Sparrow, F D G / (4 cos_theta_i cos_theta_o)) and goes on to the
// layer below it (Weidlich and Wilkie 2007; Elek 2010, eq. 2-4).
LuthierPath luthier_add_interface(LuthierPath above, LuthierLayer layer) {
    LuthierPath next = above;
    next.open = false;
    metal::float2 cosines = metal::float2(above.wi_local.z, above.wo_local.z);
    metal::float3 bisector = metal::float3(above.across, cosines.x + cosines.y);
    float length_sq = metal::dot(bisector.xy, bisector.xy) + (bisector.z * bisector.z);
    float secant_d = 2.0 * metal::rsqrt(length_sq);
    float cos_theta_d = metal::min((0.25 * length_sq) * secant_d, 1.0);
    metal::float3 fresnel = luthier_fresnel_term(layer, cos_theta_d);
    float masking = metal::min((bisector.z * metal::min(cosines.x, cosines.y)) * (secant_d * secant_d), 1.0);
    float geometry = (luthier_quarter_density(layer, bisector) * masking) / (cosines.x * cosines.y);
    next.total = above.total + ((above.throughput * fresnel) * geometry);
    metal::float2 bent = cosines * layer.inverse_eta;
    metal::float2 cosines_sq = (bent * bent) + metal::float2(layer.grazing_cos_sq);
    metal::float2 secants = metal::rsqrt(cosines_sq);
    metal::float2 refracted = cosines_sq * secants;
    next.wi_local = metal::float3(above.wi_local.xy * layer.inverse_eta, refracted.x);
    next.wo_local = metal::float3(above.wo_local.xy * layer.inverse_eta, refracted.y);
    next.across = above.across * layer.inverse_eta;
    next.open = metal::min(cosines_sq.x, cosines_sq.y) > 0.0;
    metal::float3 returned = metal::float3(1.0) - (masking * fresnel);
    next.throughput = (above.throughput * (metal::float3(1.0) - fresnel)) * returned;
    return next;
}

// f cos_theta_i of the model `elek`, both directions above the horizon.
metal::float3 luthier_eval_elek(
    uint material,
    metal::float3 wi,
    metal::float3 wo,
    device LuthierMaterials const& luthier_materials
) {
    metal::float3 down = metal::float3(wi.xy, metal::max(wi.z, 0.0000000000000001));
    metal::float3 up = metal::float3(wo.xy, metal::max(wo.z, 0.0000000000000001));
    LuthierPath path = LuthierPath {down, up, wi.xy + wo.xy, {}, metal::float3(1.0), metal::float3(0.0), true};
    path = luthier_add_interface(path, luthier_layer(material, 0u, luthier_materials));
    if (path.open) {
        path = luthier_add_interface(path, luthier_layer(material, 1u, luthier_materials));
    }
    return wi.z * path.total;
}

// f cos_theta_i, RGB, of a material for light from wi seen from wo: unit, in the local frame (+z is the normal), away
// from the surface. Zero when either is not above the horizon. See `luthier_bounded` for the range.
metal::float3 luthier_eval(
    uint material,
    metal::float3 wi,
    metal::float3 wo,
    device LuthierMaterials const& luthier_materials
) {
    if (metal::min(wi.z, wo.z) <= 0.0) {
        return metal::float3(0.0);
    }
    return luthier_eval_elek(material, wi, wo, luthier_materials);
}

// A sum over lights, clamped to what a picture of half floats holds, 0 to 65504. Highlights at grazing angles go beyond, colours outside
// of Rec.709 have channels below 0: bound the sum, not its terms.
metal::float3 luthier_bounded(metal::float3 radiance) {
    return metal::clamp(radiance, metal::float3(0.0), metal::float3(65504.0));
}
