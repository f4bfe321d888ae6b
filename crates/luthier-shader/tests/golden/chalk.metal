// Metal 2.0. Not checked by a Metal compiler.
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
// Bindings, by argument index of a complete shader:
//   buffer(6) luthier_materials: device LuthierMaterials const&, 22 float4
// A function takes those that it reads as its last arguments, in this order. luthier_materials is materials.bin of the bake, byte for byte.
// Numbers from 16 up are yours.

#include <metal_stdlib>
#include <simd/simd.h>

using metal::uint;

struct LuthierMaterials {
    metal::float4 inner[22];
};

// One layer of a material. Indices are relative to the medium above it; tiles are -1 where there is none.
struct LuthierLayer {
    // 0 dielectric, 1 conductor, 2 diffuse base.
    uint kind;
    char _pad1[12];
    // BRDF of a Lambertian base, albedo over pi, RGB.
    metal::float3 lambert;
};

constant uint LUTHIER_MATERIAL_CHALK = 0u;
constant uint LUTHIER_MATERIAL_WORDS = 11u;
constant uint LUTHIER_LAYER_WORDS = 11u;

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
    metal::float4 base = luthier_materials.inner[first + 3u];
    metal::float4 numbers = luthier_materials.inner[first + 10u];
    layer.kind = luthier_whole(numbers.x);
    layer.lambert = base.xyz;
    return layer;
}

// BRDF of a Lambertian base.
metal::float3 luthier_diffuse(LuthierLayer layer) {
    return layer.lambert;
}

// f cos_theta_i of the model `elek`, both directions above the horizon.
metal::float3 luthier_eval_elek(
    uint material,
    metal::float3 wi,
    metal::float3 wo,
    device LuthierMaterials const& luthier_materials
) {
    LuthierLayer layer = luthier_layer(material, 0u, luthier_materials);
    return wi.z * luthier_diffuse(layer);
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
