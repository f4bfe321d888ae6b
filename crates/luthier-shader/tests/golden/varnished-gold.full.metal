// Model: elek (O. Elek, Layered Materials in Real-Time Rendering, CESCG 2010).
// No tables: Fresnel equations at three wavelengths, closed forms of D.
// Metal 2.0. Not checked by a Metal compiler.
//
// Bindings, by argument index of a complete shader. A function takes those that it reads, in this order, as its last
// arguments:
//   buffer(6) luthier_materials: constant LuthierMaterials&, 31 float4
//
// Materials:
//   0 varnished-gold, elek, 2 layers

#include <metal_stdlib>
#include <simd/simd.h>

using metal::uint;

struct LuthierMaterials {
    metal::float4 inner[31];
};

// One layer of a material. Indices are relative to the medium above it; tiles are -1 where there is none.
struct LuthierLayer {
    // 0 dielectric, 1 conductor, 2 diffuse base.
    uint kind;
    // Slope parameter of the micro-surface.
    float alpha;
    // Index below over index above, for the refracted directions.
    float eta;
    // Slope distribution: 0 Beckmann, 1 GGX.
    float distribution;
    // Real part of the index below, at three wavelengths.
    metal::float3 ior_n;
    // Imaginary part of it.
    metal::float3 ior_k;
};

// Complex numbers at three wavelengths.
struct LuthierComplex {
    metal::float3 re;
    metal::float3 im;
};

// What the light has met on its way down and back up: directions, and sums over the layers so far.
struct LuthierPath {
    // To the light, in the medium above the next layer.
    metal::float3 wi;
    // To the eye, in the medium above the next layer.
    metal::float3 wo;
    // Sum of their tangential parts. It nearly cancels in a highlight, so that it is refracted as a whole.
    metal::float2 across;
    char _pad3[8];
    // Share of the light that comes down to the next layer and back out, times the outer cos_theta_i.
    metal::float3 throughput;
    // Reflected by the layers so far: f cos_theta_i.
    metal::packed_float3 reflected;
    // Greatest slope parameter so far: a layer is never smoother than those above it.
    float alpha;
    // Whether any light reaches the next layer.
    bool open;
};

constant uint LUTHIER_MATERIAL_VARNISHED_GOLD = 0u;
constant float LUTHIER_PI = 3.1415927;
constant uint LUTHIER_MATERIAL_WORDS = 11u;
constant uint LUTHIER_LAYER_WORDS = 10u;

// Index of the first word of a material in the buffer.
uint luthier_header(uint material) {
    return material * LUTHIER_MATERIAL_WORDS;
}

uint luthier_wgsl_f2u32(float value) {
    return static_cast<uint>(metal::clamp(value, 0.0, 4294967000.0));
}

// Number of layers of a material.
uint luthier_layer_count(uint material, constant LuthierMaterials& luthier_materials) {
    return luthier_wgsl_f2u32(luthier_materials.inner[luthier_header(material)].y);
}

// A layer of a material, counted from the top.
LuthierLayer luthier_layer(uint material, uint index, constant LuthierMaterials& luthier_materials) {
    LuthierLayer layer = {};
    uint first = luthier_wgsl_f2u32(luthier_materials.inner[luthier_header(material)].x) + (index * LUTHIER_LAYER_WORDS);
    metal::float4 head = luthier_materials.inner[first];
    metal::float4 base = luthier_materials.inner[first + 3u];
    metal::float4 real_part = luthier_materials.inner[first + 4u];
    metal::float4 imaginary_part = luthier_materials.inner[first + 5u];
    layer.kind = luthier_wgsl_f2u32(head.x);
    layer.alpha = head.y;
    layer.eta = head.z;
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
    metal::float3 re_sq = metal::select(small_sq, large_sq, propagates);
    metal::float3 im_sq = metal::select(large_sq, small_sq, propagates);
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

// pi alpha^2 D of Beckmann. Below a cosine of 0.1 it is zero in f32 for any alpha <= 1.
float luthier_beckmann(float alpha, float cos_theta_h, float sin_theta_h_sq) {
    float secant_sq = 1.0 / metal::max(cos_theta_h * cos_theta_h, 0.01);
    return metal::exp((-(sin_theta_h_sq) * secant_sq) / (alpha * alpha)) * (secant_sq * secant_sq);
}

// pi alpha^2 D of GGX (Trowbridge-Reitz).
float luthier_ggx(float alpha, float cos_theta_h, float sin_theta_h_sq) {
    float alpha_sq = alpha * alpha;
    float ratio = alpha_sq / (((alpha_sq * cos_theta_h) * cos_theta_h) + sin_theta_h_sq);
    return ratio * ratio;
}

// Fresnel reflectance of a layer at three wavelengths, its film included.
metal::float3 luthier_fresnel_term(LuthierLayer layer, float cos_theta_d) {
    return luthier_fresnel(layer.ior_n, layer.ior_k, cos_theta_d);
}

// pi alpha^2 D of a layer, in closed form.
float luthier_distribution_term(LuthierLayer layer, float alpha, float cos_theta_h, float sin_theta_h_sq) {
    if (layer.distribution > 0.5) {
        return luthier_ggx(alpha, cos_theta_h, sin_theta_h_sq);
    }
    return luthier_beckmann(alpha, cos_theta_h, sin_theta_h_sq);
}

// D of a layer at the half vector along `bisector`, whose squared length is `length_sq`.
float luthier_density(LuthierLayer layer, metal::float3 bisector, float length_sq) {
    float inverse_length = metal::rsqrt(length_sq);
    float cos_theta_h = bisector.z * inverse_length;
    float sin_theta_h_sq = (metal::dot(bisector.xy, bisector.xy) * inverse_length) * inverse_length;
    float area = layer.alpha * layer.alpha;
    float alpha = layer.alpha;
    return (luthier_distribution_term(layer, alpha, cos_theta_h, sin_theta_h_sq) / LUTHIER_PI) / area;
}

// Adds what a rough interface reflects (Torrance-Sparrow, F D G / (4 cos_theta_i cos_theta_o)) and goes on to the
// layer below it (Weidlich and Wilkie 2007; Elek 2010, eq. 2-4).
LuthierPath luthier_add_interface(LuthierPath path, LuthierLayer layer) {
    LuthierPath next = path;
    next.open = false;
    metal::float3 bisector = metal::float3(path.across, path.wi.z + path.wo.z);
    float length_sq = metal::dot(bisector.xy, bisector.xy) + (bisector.z * bisector.z);
    if (length_sq < 0.000000000000000000000001) {
        return next;
    }
    float inverse_length = metal::rsqrt(length_sq);
    float cos_theta_d = metal::min((0.5 * length_sq) * inverse_length, 1.0);
    metal::float3 fresnel = luthier_fresnel_term(layer, cos_theta_d);
    float cavity = (4.0 * (bisector.z * inverse_length)) * inverse_length;
    metal::float2 cosines = metal::max(metal::float2(path.wi.z, path.wo.z), metal::float2(0.000000000000000001));
    float masking = metal::min(cavity * metal::min(cosines.x, cosines.y), 1.0);
    float shape = (luthier_density(layer, bisector, length_sq) * masking) / ((4.0 * cosines.x) * cosines.y);
    next.reflected = path.reflected + ((path.throughput * fresnel) * shape);
    float inverse_eta = 1.0 / layer.eta;
    metal::float2 cosines_sq = ((cosines * cosines) + metal::float2((layer.eta - 1.0) * (layer.eta + 1.0))) * (inverse_eta * inverse_eta);
    if (metal::min(cosines_sq.x, cosines_sq.y) <= 0.0) {
        return next;
    }
    metal::float2 secants = metal::rsqrt(cosines_sq);
    metal::float2 refracted = cosines_sq * secants;
    next.wi = metal::float3(path.wi.xy * inverse_eta, refracted.x);
    next.wo = metal::float3(path.wo.xy * inverse_eta, refracted.y);
    next.across = path.across * inverse_eta;
    next.open = true;
    metal::float3 crossed = metal::float3(1.0) - fresnel;
    metal::float3 kept = crossed * (metal::float3(1.0 - masking) + (crossed * masking));
    next.throughput = path.throughput * kept;
    return next;
}

// Adds an interface, which is never smoother than those above it.
LuthierPath luthier_elek_interface(LuthierPath path, LuthierLayer layer) {
    LuthierLayer rougher = layer;
    rougher.alpha = metal::max(path.alpha, layer.alpha);
    LuthierPath next = luthier_add_interface(path, rougher);
    next.alpha = rougher.alpha;
    return next;
}

// f cos_theta_i of the model `elek`, both directions above the horizon.
metal::float3 luthier_eval_elek(
    uint material,
    metal::float3 wi,
    metal::float3 wo,
    constant LuthierMaterials& luthier_materials
) {
    LuthierPath path = LuthierPath {wi, wo, wi.xy + wo.xy, {}, metal::float3(wi.z), metal::float3(0.0), 0.0, true};
    path = luthier_elek_interface(path, luthier_layer(material, 0u, luthier_materials));
    if (path.open) {
        path = luthier_elek_interface(path, luthier_layer(material, 1u, luthier_materials));
    }
    return path.reflected;
}

// f cos_theta_i, RGB, of a material for light from wi seen from wo: unit, in the local frame (+z is the normal), away
// from the surface. Zero when either is not above the horizon.
metal::float3 luthier_eval(
    uint material,
    metal::float3 wi,
    metal::float3 wo,
    constant LuthierMaterials& luthier_materials
) {
    if (metal::min(wi.z, wo.z) <= 0.0) {
        return metal::float3(0.0);
    }
    return luthier_eval_elek(material, wi, wo, luthier_materials);
}
