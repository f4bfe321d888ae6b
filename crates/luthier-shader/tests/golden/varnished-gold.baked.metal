// Model: elek (O. Elek, Layered Materials in Real-Time Rendering, CESCG 2010).
// Fresnel reflectance and slope distribution are read from tables.
// Metal 2.0. Not checked by a Metal compiler.
//
// Tables, in texels:
//   fresnel       128 x 3 rgba16float, 3 tiles of 128 x 1; cos_theta 0..1
//   distribution  512 x 1024 r16float, 2 tiles of 512 x 512; theta_h 0..1.5707964 as u^8, alpha 0.001..1 logarithmic
//
// Bindings, by argument index of a complete shader. A function takes those that it reads, in this order, as its last
// arguments:
//   texture(0) luthier_fresnel: texture2d<float>
//   texture(1) luthier_distribution: texture2d<float>
//   sampler(5) luthier_sampler: sampler, linear, clamp to edge
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
    // Tile of the Fresnel table.
    float fresnel_tile;
    // Tile of the distribution table.
    float distribution_tile;
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
constant metal::float2 LUTHIER_FRESNEL_SIZE = metal::float2(128.0, 3.0);
constant metal::float2 LUTHIER_DISTRIBUTION_SIZE = metal::float2(512.0, 1024.0);
constant metal::float2 LUTHIER_DISTRIBUTION_TILE = metal::float2(512.0, 512.0);
constant float LUTHIER_PI = 3.1415927;
constant uint LUTHIER_MATERIAL_WORDS = 11u;
constant uint LUTHIER_LAYER_WORDS = 10u;

// Fresnel reflectance of an interface, RGB.
metal::float3 luthier_lookup_fresnel(
    float tile,
    float cos_theta,
    metal::texture2d<float> luthier_fresnel,
    metal::sampler luthier_sampler
) {
    float x = metal::saturate(cos_theta) * 127.0;
    metal::float2 position = metal::float2(x + 0.5, tile + 0.5);
    return luthier_fresnel.sample(luthier_sampler, position / LUTHIER_FRESNEL_SIZE, metal::level(0.0)).xyz;
}

// pi alpha^2 D of a slope distribution, for the angle between half vector and normal: D is this over pi alpha^2.
float luthier_lookup_distribution(
    float tile,
    float cos_theta_h,
    float sin_theta_h_sq,
    float alpha,
    metal::texture2d<float> luthier_distribution,
    metal::sampler luthier_sampler
) {
    float tangent = metal::sqrt(sin_theta_h_sq) / (1.0 + cos_theta_h);
    bool is_wide = tangent > 0.41421357;
    float t = is_wide ? ((tangent - 1.0) / (tangent + 1.0)) : tangent;
    float t_sq = t * t;
    float series = t_sq * (-0.3333295 + (t_sq * (0.19977711 + (t_sq * (-0.13877685 + (t_sq * 0.08053744))))));
    float theta_h = 2.0 * (((is_wide ? 0.7853982 : 0.0) + t) + (t * series));
    float x = metal::sqrt(metal::sqrt(metal::sqrt(metal::saturate(theta_h / 1.5707964)))) * 511.0;
    float y = metal::saturate(metal::log2(metal::max(alpha, 0.001) / 0.001) / 9.965784) * 511.0;
    metal::float2 position = metal::float2(x + 0.5, ((tile * 512.0) + y) + 0.5);
    return luthier_distribution.sample(luthier_sampler, position / LUTHIER_DISTRIBUTION_SIZE, metal::level(0.0)).x;
}

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
    metal::float4 tiles = luthier_materials.inner[first + 1u];
    layer.kind = luthier_wgsl_f2u32(head.x);
    layer.alpha = head.y;
    layer.eta = head.z;
    layer.fresnel_tile = tiles.x;
    layer.distribution_tile = tiles.y;
    return layer;
}

// Fresnel reflectance of a layer, from its row or, under a film that varies, its tile of the tables.
metal::float3 luthier_fresnel_term(
    LuthierLayer layer,
    float cos_theta_d,
    metal::texture2d<float> luthier_fresnel,
    metal::sampler luthier_sampler
) {
    return luthier_lookup_fresnel(layer.fresnel_tile, cos_theta_d, luthier_fresnel, luthier_sampler);
}

// pi alpha^2 D of a layer, from the table.
float luthier_distribution_term(
    LuthierLayer layer,
    float alpha,
    float cos_theta_h,
    float sin_theta_h_sq,
    metal::texture2d<float> luthier_distribution,
    metal::sampler luthier_sampler
) {
    return luthier_lookup_distribution(layer.distribution_tile, cos_theta_h, sin_theta_h_sq, alpha, luthier_distribution, luthier_sampler);
}

// D of a layer at the half vector along `bisector`, whose squared length is `length_sq`.
float luthier_density(
    LuthierLayer layer,
    metal::float3 bisector,
    float length_sq,
    metal::texture2d<float> luthier_distribution,
    metal::sampler luthier_sampler
) {
    float inverse_length = metal::rsqrt(length_sq);
    float cos_theta_h = bisector.z * inverse_length;
    float sin_theta_h_sq = (metal::dot(bisector.xy, bisector.xy) * inverse_length) * inverse_length;
    float area = layer.alpha * layer.alpha;
    float alpha = layer.alpha;
    return (luthier_distribution_term(layer, alpha, cos_theta_h, sin_theta_h_sq, luthier_distribution, luthier_sampler) / LUTHIER_PI) / area;
}

// Adds what a rough interface reflects (Torrance-Sparrow, F D G / (4 cos_theta_i cos_theta_o)) and goes on to the
// layer below it (Weidlich and Wilkie 2007; Elek 2010, eq. 2-4).
LuthierPath luthier_add_interface(
    LuthierPath path,
    LuthierLayer layer,
    metal::texture2d<float> luthier_fresnel,
    metal::texture2d<float> luthier_distribution,
    metal::sampler luthier_sampler
) {
    LuthierPath next = path;
    next.open = false;
    metal::float3 bisector = metal::float3(path.across, path.wi.z + path.wo.z);
    float length_sq = metal::dot(bisector.xy, bisector.xy) + (bisector.z * bisector.z);
    if (length_sq < 0.000000000000000000000001) {
        return next;
    }
    float inverse_length = metal::rsqrt(length_sq);
    float cos_theta_d = metal::min((0.5 * length_sq) * inverse_length, 1.0);
    metal::float3 fresnel = luthier_fresnel_term(layer, cos_theta_d, luthier_fresnel, luthier_sampler);
    float cavity = (4.0 * (bisector.z * inverse_length)) * inverse_length;
    metal::float2 cosines = metal::max(metal::float2(path.wi.z, path.wo.z), metal::float2(0.000000000000000001));
    float masking = metal::min(cavity * metal::min(cosines.x, cosines.y), 1.0);
    float shape = (luthier_density(layer, bisector, length_sq, luthier_distribution, luthier_sampler) * masking) / ((4.0 * cosines.x) * cosines.y);
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
LuthierPath luthier_elek_interface(
    LuthierPath path,
    LuthierLayer layer,
    metal::texture2d<float> luthier_fresnel,
    metal::texture2d<float> luthier_distribution,
    metal::sampler luthier_sampler
) {
    LuthierLayer rougher = layer;
    rougher.alpha = metal::max(path.alpha, layer.alpha);
    LuthierPath next = luthier_add_interface(path, rougher, luthier_fresnel, luthier_distribution, luthier_sampler);
    next.alpha = rougher.alpha;
    return next;
}

// f cos_theta_i of the model `elek`, both directions above the horizon.
metal::float3 luthier_eval_elek(
    uint material,
    metal::float3 wi,
    metal::float3 wo,
    metal::texture2d<float> luthier_fresnel,
    metal::texture2d<float> luthier_distribution,
    metal::sampler luthier_sampler,
    constant LuthierMaterials& luthier_materials
) {
    LuthierPath path = LuthierPath {wi, wo, wi.xy + wo.xy, {}, metal::float3(wi.z), metal::float3(0.0), 0.0, true};
    path = luthier_elek_interface(path, luthier_layer(material, 0u, luthier_materials), luthier_fresnel, luthier_distribution, luthier_sampler);
    if (path.open) {
        path = luthier_elek_interface(path, luthier_layer(material, 1u, luthier_materials), luthier_fresnel, luthier_distribution, luthier_sampler);
    }
    return path.reflected;
}

// f cos_theta_i, RGB, of a material for light from wi seen from wo: unit, in the local frame (+z is the normal), away
// from the surface. Zero when either is not above the horizon.
metal::float3 luthier_eval(
    uint material,
    metal::float3 wi,
    metal::float3 wo,
    metal::texture2d<float> luthier_fresnel,
    metal::texture2d<float> luthier_distribution,
    metal::sampler luthier_sampler,
    constant LuthierMaterials& luthier_materials
) {
    if (metal::min(wi.z, wo.z) <= 0.0) {
        return metal::float3(0.0);
    }
    return luthier_eval_elek(material, wi, wo, luthier_fresnel, luthier_distribution, luthier_sampler, luthier_materials);
}
