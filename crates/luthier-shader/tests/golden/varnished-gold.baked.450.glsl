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
// Bindings, group 0:
//   0 luthier_fresnel: sampler2D, rgba16float, 128 x 3, filtered; 3 tiles of 128 x 1: cos_theta 0..1
//   1 luthier_distribution: sampler2D, r16float, 512 x 1024, filtered; 2 tiles of 512 x 512: theta_h 0..1.5707964 as u^8, alpha 0.001..1
//     logarithmic
//   6 luthier_materials: storage block LuthierMaterials (std430), 33 vec4
// luthier_materials is materials.bin of the bake, byte for byte. Textures are the KTX2 files of the bake: one level, linear values, the
// first row at coordinate 0. Filters clamp to the edge. Numbers from 16 up are yours.

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
    vec3 wi_local;
    // To the eye, in the medium above the next layer.
    vec3 wo_local;
    // Sum of their tangential parts. It nearly cancels in a highlight, so that it is refracted as a whole.
    vec2 across;
    // Share of the light that comes down to the next layer and back out.
    vec3 throughput;
    // f of the layers so far.
    vec3 total;
    // Whether any light reaches the next layer.
    bool open;
};

const uint LUTHIER_MATERIAL_VARNISHED_GOLD = 0u;
const uint LUTHIER_MATERIAL_WORDS = 11u;
const uint LUTHIER_LAYER_WORDS = 11u;

layout(binding = 0) uniform sampler2D luthier_fresnel;
layout(binding = 1) uniform sampler2D luthier_distribution;
layout(std430, binding = 6) readonly buffer LuthierMaterials { vec4 luthier_materials[]; };

// Fresnel reflectance of an interface, RGB.
vec3 luthier_lookup_fresnel(float tile, float cos_theta) {
    float x = clamp(cos_theta, 0.0, 1.0) * 0.9921875;
    vec2 position = vec2(x + 0.00390625, (tile + 0.5) / 3.0);
    return textureLod(luthier_fresnel, vec2(position), 0.0).xyz;
}

// pi alpha^2 D of a slope distribution, for the angle between half vector and normal: D is this over pi alpha^2.
float luthier_lookup_distribution(float tile, float cos_theta_h, float sin_theta_h_sq, float alpha) {
    float tangent = sqrt(sin_theta_h_sq) / (1.0 + cos_theta_h);
    bool is_wide = tangent > 0.41421357;
    float t = is_wide ? ((tangent - 1.0) / (tangent + 1.0)) : tangent;
    float t_sq = t * t;
    float series = t_sq * (-0.3333295 + (t_sq * (0.19977711 + (t_sq * (-0.13877685 + (t_sq * 0.08053744))))));
    float theta_h = 2.0 * (((is_wide ? 0.7853982 : 0.0) + t) + (t * series));
    float x = sqrt(sqrt(sqrt(clamp(theta_h / 1.5707964, 0.0, 1.0)))) * 0.9980469;
    float y = clamp(log2(max(alpha, 0.001) / 0.001) / 9.965784, 0.0, 1.0) * 511.0;
    vec2 position = vec2(x + 0.0009765625, (((tile * 512.0) + y) + 0.5) / 1024.0);
    return textureLod(luthier_distribution, vec2(position), 0.0).x;
}

// A whole number n, which the buffer holds as 2^23 + n: its low bits are n.
uint luthier_whole(float word) {
    return floatBitsToUint(word) & 8388607u;
}

// Index of the first word of a material in the buffer.
uint luthier_header(uint material) {
    return material * LUTHIER_MATERIAL_WORDS;
}

// Number of layers of a material.
uint luthier_layer_count(uint material) {
    return luthier_whole(luthier_materials[luthier_header(material)].y);
}

// A layer of a material, counted from the top.
LuthierLayer luthier_layer(uint material, uint index) {
    LuthierLayer layer = LuthierLayer(0u, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0);
    uint first = luthier_whole(luthier_materials[luthier_header(material)].x) + (index * LUTHIER_LAYER_WORDS);
    vec4 head = luthier_materials[first];
    vec4 tiles = luthier_materials[first + 1u];
    vec4 numbers = luthier_materials[first + 10u];
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
vec3 luthier_fresnel_term(LuthierLayer layer, float cos_theta_i) {
    return luthier_lookup_fresnel(layer.fresnel_tile, cos_theta_i);
}

// pi alpha^2 D of a layer whose falloff is `sharper` times its own, from the table and squares of the half vector.
float luthier_distribution_term(LuthierLayer layer, float sharper, float z_sq, float across_sq) {
    float alpha = layer.alpha;
    float inverse_length_sq = 1.0 / (z_sq + across_sq);
    float cos_theta_h = sqrt(z_sq * inverse_length_sq);
    return luthier_lookup_distribution(layer.distribution_tile, cos_theta_h, across_sq * inverse_length_sq, alpha);
}

// D / 4 of a layer at the half vector along `bisector`, above the horizon.
float luthier_quarter_density(LuthierLayer layer, vec3 bisector) {
    float z_sq = bisector.z * bisector.z;
    float across_sq = dot(bisector.xy, bisector.xy);
    return luthier_distribution_term(layer, 1.0, z_sq, across_sq) * layer.peak;
}

// Adds what a rough interface reflects (Torrance-Sparrow, F D G / (4 cos_theta_i cos_theta_o)) and goes on to the
// layer below it (Weidlich and Wilkie 2007; Elek 2010, eq. 2-4).
LuthierPath luthier_add_interface(LuthierPath above, LuthierLayer layer) {
    LuthierPath next = above;
    next.open = false;
    vec2 cosines = vec2(above.wi_local.z, above.wo_local.z);
    vec3 bisector = vec3(above.across, cosines.x + cosines.y);
    float length_sq = dot(bisector.xy, bisector.xy) + (bisector.z * bisector.z);
    float secant_d = 2.0 * inversesqrt(length_sq);
    float cos_theta_d = min((0.25 * length_sq) * secant_d, 1.0);
    vec3 fresnel = luthier_fresnel_term(layer, cos_theta_d);
    float masking = min((bisector.z * min(cosines.x, cosines.y)) * (secant_d * secant_d), 1.0);
    float geometry = (luthier_quarter_density(layer, bisector) * masking) / (cosines.x * cosines.y);
    next.total = above.total + ((above.throughput * fresnel) * geometry);
    vec2 bent = cosines * layer.inverse_eta;
    vec2 cosines_sq = (bent * bent) + vec2(layer.grazing_cos_sq);
    vec2 secants = inversesqrt(cosines_sq);
    vec2 refracted = cosines_sq * secants;
    next.wi_local = vec3(above.wi_local.xy * layer.inverse_eta, refracted.x);
    next.wo_local = vec3(above.wo_local.xy * layer.inverse_eta, refracted.y);
    next.across = above.across * layer.inverse_eta;
    next.open = min(cosines_sq.x, cosines_sq.y) > 0.0;
    vec3 returned = vec3(1.0) - (masking * fresnel);
    next.throughput = (above.throughput * (vec3(1.0) - fresnel)) * returned;
    return next;
}

// f cos_theta_i of the model `elek`, both directions above the horizon.
vec3 luthier_eval_elek(uint material, vec3 wi, vec3 wo) {
    vec3 down = vec3(wi.xy, max(wi.z, 1e-16));
    vec3 up = vec3(wo.xy, max(wo.z, 1e-16));
    LuthierPath path = LuthierPath(down, up, wi.xy + wo.xy, vec3(1.0), vec3(0.0), true);
    path = luthier_add_interface(path, luthier_layer(material, 0u));
    if (path.open) {
        path = luthier_add_interface(path, luthier_layer(material, 1u));
    }
    return wi.z * path.total;
}

// f cos_theta_i, RGB, of a material for light from wi seen from wo: unit, in the local frame (+z is the normal), away
// from the surface. Zero when either is not above the horizon. See `luthier_bounded` for the range.
vec3 luthier_eval(uint material, vec3 wi, vec3 wo) {
    if (min(wi.z, wo.z) <= 0.0) {
        return vec3(0.0);
    }
    return luthier_eval_elek(material, wi, wo);
}

// A sum over lights, clamped to what a picture of half floats holds, 0 to 65504. Highlights at grazing angles go beyond, colours outside
// of Rec.709 have channels below 0: bound the sum, not its terms.
vec3 luthier_bounded(vec3 radiance) {
    return clamp(radiance, vec3(0.0), vec3(65504.0));
}
