// Shader model 5.1. Checked by glslang, not by a compiler of Direct3D.
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
// Registers, space0:
//   t6 luthier_materials: ByteAddressBuffer (a raw view), 22 float4
// luthier_materials is materials.bin of the bake, byte for byte. Numbers from 16 up are yours.

// One layer of a material. Indices are relative to the medium above it; tiles are -1 where there is none.
struct LuthierLayer {
    // 0 dielectric, 1 conductor, 2 diffuse base.
    uint kind;
    // BRDF of a Lambertian base, albedo over pi, RGB.
    float3 lambert;
};

static const uint LUTHIER_MATERIAL_CHALK = 0u;
static const uint LUTHIER_MATERIAL_WORDS = 11u;
static const uint LUTHIER_LAYER_WORDS = 11u;

ByteAddressBuffer luthier_materials : register(t6);

// A whole number n, which the buffer holds as 2^23 + n: its low bits are n.
uint luthier_whole(float word) {
    return asuint(word) & 8388607u;
}

// Index of the first word of a material in the buffer.
uint luthier_header(uint material) {
    return material * LUTHIER_MATERIAL_WORDS;
}

// Number of layers of a material.
uint luthier_layer_count(uint material) {
    return luthier_whole(asfloat(luthier_materials.Load(4+luthier_header(material)*16)));
}

// A layer of a material, counted from the top.
LuthierLayer luthier_layer(uint material, uint index) {
    LuthierLayer layer = (LuthierLayer)0;
    uint first = luthier_whole(asfloat(luthier_materials.Load(0+luthier_header(material)*16))) + (index * LUTHIER_LAYER_WORDS);
    float4 base = asfloat(luthier_materials.Load4((first + 3u)*16));
    float4 numbers = asfloat(luthier_materials.Load4((first + 10u)*16));
    layer.kind = luthier_whole(numbers.x);
    layer.lambert = base.xyz;
    return layer;
}

// BRDF of a Lambertian base.
float3 luthier_diffuse(LuthierLayer layer) {
    return layer.lambert;
}

// f cos_theta_i of the model `elek`, both directions above the horizon.
float3 luthier_eval_elek(uint material, float3 wi, float3 wo) {
    LuthierLayer layer = luthier_layer(material, 0u);
    return wi.z * luthier_diffuse(layer);
}

// f cos_theta_i, RGB, of a material for light from wi seen from wo: unit, in the local frame (+z is the normal), away
// from the surface. Zero when either is not above the horizon. See `luthier_bounded` for the range.
float3 luthier_eval(uint material, float3 wi, float3 wo) {
    if (min(wi.z, wo.z) <= 0.0) {
        return (0.0).xxx;
    }
    return luthier_eval_elek(material, wi, wo);
}

// A sum over lights, clamped to what a picture of half floats holds, 0 to 65504. Highlights at grazing angles go beyond, colours outside
// of Rec.709 have channels below 0: bound the sum, not its terms.
float3 luthier_bounded(float3 radiance) {
    return clamp(radiance, (0.0).xxx, (65504.0).xxx);
}
