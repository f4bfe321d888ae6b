// Shader model 5.1. Checked by glslang, not by a compiler of Direct3D.
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
// Registers, space0:
//   t6 luthier_materials: ByteAddressBuffer (a raw view), 33 float4
// luthier_materials is materials.bin of the bake, byte for byte. Numbers from 16 up are yours.

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
    // Real part of the index below, at three wavelengths; F0 of an interface of Schlick's, RGB.
    float3 ior_n;
    // Imaginary part of it; of an interface of Schlick's -1 less the weight of its edge tint.
    float3 ior_k;
    // Index above over index below, for the refracted directions.
    float inverse_eta;
    // Squared cosine of a refracted grazing direction, 1 - 1 / eta^2.
    float grazing_cos_sq;
};

// Complex numbers at three wavelengths.
struct LuthierComplex {
    float3 re;
    float3 im;
};

// State of the light on its way down and back up: directions, and sums over the layers so far.
struct LuthierPath {
    // To the light, in the medium above the next layer.
    float3 wi_local;
    // To the eye, in the medium above the next layer.
    float3 wo_local;
    // Sum of their tangential parts. It nearly cancels in a highlight, so that it is refracted as a whole.
    float2 across;
    // Share of the light that comes down to the next layer and back out.
    float3 throughput;
    // f of the layers so far.
    float3 total;
    // Whether any light reaches the next layer.
    bool open;
};

static const uint LUTHIER_MATERIAL_VARNISHED_GOLD = 0u;
static const uint LUTHIER_MATERIAL_WORDS = 11u;
static const uint LUTHIER_LAYER_WORDS = 11u;

ByteAddressBuffer luthier_materials : register(t6);

// Channel by channel, the second value where a condition holds, and the first where it does not. HLSL 2021 has no conditions of three channels.
float3 luthier_choose(float3 first, float3 second, bool3 holds) {
    return float3(holds.x ? second.x : first.x, holds.y ? second.y : first.y, holds.z ? second.z : first.z);
}

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
    float4 head = asfloat(luthier_materials.Load4(first*16));
    float4 base = asfloat(luthier_materials.Load4((first + 3u)*16));
    float4 real_part = asfloat(luthier_materials.Load4((first + 4u)*16));
    float4 imaginary_part = asfloat(luthier_materials.Load4((first + 5u)*16));
    float4 numbers = asfloat(luthier_materials.Load4((first + 10u)*16));
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

LuthierComplex ConstructLuthierComplex(float3 arg0, float3 arg1) {
    LuthierComplex ret = (LuthierComplex)0;
    ret.re = arg0;
    ret.im = arg1;
    return ret;
}

// Normal component of the wave vector in a medium, over that above: sqrt((n + i k)^2 - sin_theta^2), both parts >= 0.
// Formed without cancellation for an index near 1, under total reflection, and for weak absorption.
LuthierComplex luthier_normal_index(float3 ior_n, float3 ior_k, float cos_theta) {
    float3 square = (((ior_n - (1.0).xxx) * (ior_n + (1.0).xxx)) - (ior_k * ior_k)) + (cos_theta * cos_theta).xxx;
    float3 product = ior_n * ior_k;
    float3 modulus = sqrt((square * square) + ((4.0 * product) * product));
    float3 large_sq = 0.5 * (modulus + abs(square));
    float3 small_sq = (product * product) / max(large_sq, (1e-30).xxx);
    bool3 propagates = square >= (0.0).xxx;
    float3 re_sq = luthier_choose(small_sq, large_sq, propagates);
    float3 im_sq = luthier_choose(large_sq, small_sq, propagates);
    return ConstructLuthierComplex(sqrt(re_sq), sqrt(im_sq));
}

// Exact Fresnel reflectance of unpolarised light for the relative index n + i k, total reflection included.
float3 luthier_fresnel(float3 ior_n, float3 ior_k, float cos_theta) {
    LuthierComplex below = luthier_normal_index(ior_n, ior_k, cos_theta);
    float sin_sq = 1.0 - (cos_theta * cos_theta);
    float3 im_sq = below.im * below.im;
    float3 difference = below.re - (cos_theta).xxx;
    float3 sum = below.re + (cos_theta).xxx;
    float3 refl_s = ((difference * difference) + im_sq) / ((sum * sum) + im_sq);
    float3 along = below.re * cos_theta;
    float3 across = (im_sq * cos_theta) * cos_theta;
    float3 refl_ratio = (((along - (sin_sq).xxx) * (along - (sin_sq).xxx)) + across) / (((along + (sin_sq).xxx) * (along + (sin_sq).xxx)) + across);
    return (0.5 * refl_s) * ((1.0).xxx + refl_ratio);
}

// pi alpha^2 D of Beckmann, from squares of a half vector of any length. Beyond a slope of 10 it is zero in f32 for any alpha <= 1.
float luthier_beckmann(float falloff, float z_sq, float across_sq) {
    float slope_sq = min(across_sq / z_sq, 100.0);
    float secant_sq = 1.0 + slope_sq;
    return exp2(-(slope_sq) * falloff) * (secant_sq * secant_sq);
}

// pi alpha^2 D of GGX (Trowbridge-Reitz), from squares of a half vector of any length.
float luthier_ggx(float falloff, float z_sq, float across_sq) {
    float ratio = (z_sq + across_sq) / (z_sq + (across_sq * falloff));
    return ratio * ratio;
}

// Fresnel reflectance of a layer at three wavelengths, its film included.
float3 luthier_fresnel_term(LuthierLayer layer, float cos_theta_d) {
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
float luthier_quarter_density(LuthierLayer layer, float3 bisector) {
    float z_sq = bisector.z * bisector.z;
    float across_sq = dot(bisector.xy, bisector.xy);
    return luthier_distribution_term(layer, 1.0, z_sq, across_sq) * layer.peak;
}

// Adds what a rough interface reflects (Torrance-Sparrow, F D G / (4 cos_theta_i cos_theta_o)) and goes on to the
// layer below it (Weidlich and Wilkie 2007; Elek 2010, eq. 2-4).
LuthierPath luthier_add_interface(LuthierPath above, LuthierLayer layer) {
    LuthierPath next = above;
    next.open = false;
    float2 cosines = float2(above.wi_local.z, above.wo_local.z);
    float3 bisector = float3(above.across, cosines.x + cosines.y);
    float length_sq = dot(bisector.xy, bisector.xy) + (bisector.z * bisector.z);
    float secant_d = 2.0 * rsqrt(length_sq);
    float cos_theta_d = min((0.25 * length_sq) * secant_d, 1.0);
    float3 fresnel = luthier_fresnel_term(layer, cos_theta_d);
    float masking = min((bisector.z * min(cosines.x, cosines.y)) * (secant_d * secant_d), 1.0);
    float geometry = (luthier_quarter_density(layer, bisector) * masking) / (cosines.x * cosines.y);
    next.total = above.total + ((above.throughput * fresnel) * geometry);
    float2 bent = cosines * layer.inverse_eta;
    float2 cosines_sq = (bent * bent) + (layer.grazing_cos_sq).xx;
    float2 secants = rsqrt(cosines_sq);
    float2 refracted = cosines_sq * secants;
    next.wi_local = float3(above.wi_local.xy * layer.inverse_eta, refracted.x);
    next.wo_local = float3(above.wo_local.xy * layer.inverse_eta, refracted.y);
    next.across = above.across * layer.inverse_eta;
    next.open = min(cosines_sq.x, cosines_sq.y) > 0.0;
    float3 returned = (1.0).xxx - (masking * fresnel);
    next.throughput = (above.throughput * ((1.0).xxx - fresnel)) * returned;
    return next;
}

LuthierPath ConstructLuthierPath(float3 arg0, float3 arg1, float2 arg2, float3 arg3, float3 arg4, bool arg5) {
    LuthierPath ret = (LuthierPath)0;
    ret.wi_local = arg0;
    ret.wo_local = arg1;
    ret.across = arg2;
    ret.throughput = arg3;
    ret.total = arg4;
    ret.open = arg5;
    return ret;
}

// f cos_theta_i of the model `elek`, both directions above the horizon.
float3 luthier_eval_elek(uint material, float3 wi, float3 wo) {
    float3 down = float3(wi.xy, max(wi.z, 1e-16));
    float3 up = float3(wo.xy, max(wo.z, 1e-16));
    LuthierPath path = ConstructLuthierPath(down, up, wi.xy + wo.xy, (1.0).xxx, (0.0).xxx, true);
    path = luthier_add_interface(path, luthier_layer(material, 0u));
    if (path.open) {
        path = luthier_add_interface(path, luthier_layer(material, 1u));
    }
    return wi.z * path.total;
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
