// Metal 2.0. Not checked by a Metal compiler.
//
// Materials, each a number and a constant:
//   0 varnished-gold, LUTHIER_MATERIAL_VARNISHED_GOLD: elek, 2 layers
//
// Model: elek (O. Elek, Layered Materials in Real-Time Rendering, CESCG 2010).
// Fresnel reflectance and slope distribution are read from tables.
//
// Functions:
//   luthier_eval(material, wi, wo): f cos_theta_i, linear Rec.709; a light adds its irradiance times this
//   luthier_bounded(radiance): a sum over lights within 0..65504, which half floats hold
//   luthier_layer(material, index), luthier_layer_count(material): the layers as records, from the top
//   luthier_lookup_T(tile, ...): a value of the table T, which is fresnel, distribution
// wi points to the light and wo to the eye. Both are unit vectors in the local frame of the surface, away from it. +z is the normal, +x the
// tangent. Values are 0 where either is not above the horizon.
//
// Bindings, by argument index of a complete shader:
//   texture(0) luthier_fresnel: texture2d<float>, rgba16float, 128 x 3, filtered; 3 tiles of 128 x 1: cos_theta 0..1
//   texture(1) luthier_distribution: texture2d<float>, r16float, 512 x 1024, filtered; 2 tiles of 512 x 512: theta_h 0..1.5707964 as u^8,
//     alpha 0.001..1 logarithmic
//   sampler(5) luthier_sampler: sampler, linear, clamp to edge
//   buffer(6) luthier_materials: device LuthierMaterials const&, 33 float4
// A function takes those that it reads as its last arguments, in this order. luthier_materials is materials.bin of the bake, byte for byte.
// Textures are the KTX2 files of the bake: one level, linear values, the first row at coordinate 0. Filters clamp to the edge. Numbers from
// 16 up are yours.

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
    // A quarter of the greatest D, 1 / (4 pi alpha^2).
    float peak;
    // Index above over index below, for the refracted directions.
    float inverse_eta;
    // Squared cosine of a refracted grazing direction, 1 - 1 / eta^2.
    float grazing_cos_sq;
    // Tile in `luthier_fresnel`.
    float fresnel_tile;
    // Tile in `luthier_distribution`.
    float distribution_tile;
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

// Fresnel reflectance of an interface, RGB.
metal::float3 luthier_lookup_fresnel(
    float tile,
    float cos_theta,
    metal::texture2d<float> luthier_fresnel,
    metal::sampler luthier_sampler
) {
    float x = metal::saturate(cos_theta) * 0.9921875;
    metal::float2 position = metal::float2(x + 0.00390625, (tile + 0.5) / 3.0);
    return luthier_fresnel.sample(luthier_sampler, position, metal::level(0.0)).xyz;
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
    float x = metal::sqrt(metal::sqrt(metal::sqrt(metal::saturate(theta_h / 1.5707964)))) * 0.9980469;
    float y = metal::saturate(metal::log2(metal::max(alpha, 0.001) / 0.001) / 9.965784) * 511.0;
    metal::float2 position = metal::float2(x + 0.0009765625, (((tile * 512.0) + y) + 0.5) / 1024.0);
    return luthier_distribution.sample(luthier_sampler, position, metal::level(0.0)).x;
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
    metal::float4 tiles = luthier_materials.inner[first + 1u];
    metal::float4 numbers = luthier_materials.inner[first + 10u];
    layer.kind = luthier_whole(numbers.x);
    layer.alpha = numbers.y;
    layer.peak = head.y;
    layer.inverse_eta = head.z;
    layer.grazing_cos_sq = head.w;
    layer.fresnel_tile = tiles.x;
    layer.distribution_tile = tiles.y;
    return layer;
}

// Fresnel reflectance of a layer, from its row or, under a film that varies, its tile of the tables.
metal::float3 luthier_fresnel_term(
    LuthierLayer layer,
    float cos_theta_i,
    metal::texture2d<float> luthier_fresnel,
    metal::sampler luthier_sampler
) {
    return luthier_lookup_fresnel(layer.fresnel_tile, cos_theta_i, luthier_fresnel, luthier_sampler);
}

// pi alpha^2 D of a layer whose falloff is `sharper` times its own, from the table and squares of the half vector.
float luthier_distribution_term(
    LuthierLayer layer,
    float sharper,
    float z_sq,
    float across_sq,
    metal::texture2d<float> luthier_distribution,
    metal::sampler luthier_sampler
) {
    float alpha = layer.alpha;
    float inverse_length_sq = 1.0 / (z_sq + across_sq);
    float cos_theta_h = metal::sqrt(z_sq * inverse_length_sq);
    return luthier_lookup_distribution(layer.distribution_tile, cos_theta_h, across_sq * inverse_length_sq, alpha, luthier_distribution, luthier_sampler);
}

// D / 4 of a layer at the half vector along `bisector`, above the horizon.
float luthier_quarter_density(
    LuthierLayer layer,
    metal::float3 bisector,
    metal::texture2d<float> luthier_distribution,
    metal::sampler luthier_sampler
) {
    float z_sq = bisector.z * bisector.z;
    float across_sq = metal::dot(bisector.xy, bisector.xy);
    return luthier_distribution_term(layer, 1.0, z_sq, across_sq, luthier_distribution, luthier_sampler) * layer.peak;
}

// Adds what a rough interface reflects (Torrance-Sparrow, F D G / (4 cos_theta_i cos_theta_o)) and goes on to the
// layer below it (Weidlich and Wilkie 2007; Elek 2010, eq. 2-4).
LuthierPath luthier_add_interface(
    LuthierPath above,
    LuthierLayer layer,
    metal::texture2d<float> luthier_fresnel,
    metal::texture2d<float> luthier_distribution,
    metal::sampler luthier_sampler
) {
    LuthierPath next = above;
    next.open = false;
    metal::float2 cosines = metal::float2(above.wi_local.z, above.wo_local.z);
    metal::float3 bisector = metal::float3(above.across, cosines.x + cosines.y);
    float length_sq = metal::dot(bisector.xy, bisector.xy) + (bisector.z * bisector.z);
    float secant_d = 2.0 * metal::rsqrt(length_sq);
    float cos_theta_d = metal::min((0.25 * length_sq) * secant_d, 1.0);
    metal::float3 fresnel = luthier_fresnel_term(layer, cos_theta_d, luthier_fresnel, luthier_sampler);
    float masking = metal::min((bisector.z * metal::min(cosines.x, cosines.y)) * (secant_d * secant_d), 1.0);
    float geometry = (luthier_quarter_density(layer, bisector, luthier_distribution, luthier_sampler) * masking) / (cosines.x * cosines.y);
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
    metal::texture2d<float> luthier_fresnel,
    metal::texture2d<float> luthier_distribution,
    metal::sampler luthier_sampler,
    device LuthierMaterials const& luthier_materials
) {
    metal::float3 down = metal::float3(wi.xy, metal::max(wi.z, 0.0000000000000001));
    metal::float3 up = metal::float3(wo.xy, metal::max(wo.z, 0.0000000000000001));
    LuthierPath path = LuthierPath {down, up, wi.xy + wo.xy, {}, metal::float3(1.0), metal::float3(0.0), true};
    path = luthier_add_interface(path, luthier_layer(material, 0u, luthier_materials), luthier_fresnel, luthier_distribution, luthier_sampler);
    if (path.open) {
        path = luthier_add_interface(path, luthier_layer(material, 1u, luthier_materials), luthier_fresnel, luthier_distribution, luthier_sampler);
    }
    return wi.z * path.total;
}

// f cos_theta_i, RGB, of a material for light from wi seen from wo: unit, in the local frame (+z is the normal), away
// from the surface. Zero when either is not above the horizon. See `luthier_bounded` for the range.
metal::float3 luthier_eval(
    uint material,
    metal::float3 wi,
    metal::float3 wo,
    metal::texture2d<float> luthier_fresnel,
    metal::texture2d<float> luthier_distribution,
    metal::sampler luthier_sampler,
    device LuthierMaterials const& luthier_materials
) {
    if (metal::min(wi.z, wo.z) <= 0.0) {
        return metal::float3(0.0);
    }
    return luthier_eval_elek(material, wi, wo, luthier_fresnel, luthier_distribution, luthier_sampler, luthier_materials);
}

// A sum over lights, clamped to what a picture of half floats holds, 0 to 65504. Highlights at grazing angles go beyond, colours outside
// of Rec.709 have channels below 0: bound the sum, not its terms.
metal::float3 luthier_bounded(metal::float3 radiance) {
    return metal::clamp(radiance, metal::float3(0.0), metal::float3(65504.0));
}
