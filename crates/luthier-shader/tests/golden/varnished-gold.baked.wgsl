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
//   0 luthier_fresnel: texture_2d<f32>, rgba16float, 128 x 3, filtered; 3 tiles of 128 x 1: cos_theta 0..1
//   1 luthier_distribution: texture_2d<f32>, r16float, 512 x 1024, filtered; 2 tiles of 512 x 512: theta_h 0..1.5707964 as u^8, alpha
//     0.001..1 logarithmic
//   5 luthier_sampler: sampler, linear, clamp to edge
//   6 luthier_materials: storage buffer, 33 vec4
// luthier_materials is materials.bin of the bake, byte for byte. Textures are the KTX2 files of the bake: one level, linear values, the
// first row at coordinate 0. Filters clamp to the edge. Numbers from 16 up are yours.

const LUTHIER_MATERIAL_VARNISHED_GOLD: u32 = 0u;

@group(0) @binding(0) var luthier_fresnel: texture_2d<f32>;
@group(0) @binding(1) var luthier_distribution: texture_2d<f32>;
@group(0) @binding(5) var luthier_sampler: sampler;
@group(0) @binding(6) var<storage, read> luthier_materials: array<vec4<f32>>;

/// Fresnel reflectance of an interface, RGB.
fn luthier_lookup_fresnel(tile: f32, cos_theta: f32) -> vec3<f32> {
    let x = saturate(cos_theta) * 0.9921875;
    let position = vec2<f32>(x + 0.00390625, (tile + 0.5) / 3.0);
    return textureSampleLevel(luthier_fresnel, luthier_sampler, position, 0.0).rgb;
}

/// pi alpha^2 D of a slope distribution, for the angle between half vector and normal: D is this over pi alpha^2.
fn luthier_lookup_distribution(tile: f32, cos_theta_h: f32, sin_theta_h_sq: f32, alpha: f32) -> f32 {
    // atan2 may be a thousandth of a lobe off on some devices; this is twice the arc tangent of the tangent of the half angle, by the
    // polynomial of Cephes.
    let tangent = sqrt(sin_theta_h_sq) / (1.0 + cos_theta_h);
    let is_wide = tangent > 0.41421356;
    let t = select(tangent, (tangent - 1.0) / (tangent + 1.0), is_wide);
    let t_sq = t * t;
    let series = t_sq * (-0.33332949 + t_sq * (0.19977711 + t_sq * (-0.13877686 + t_sq * 0.08053744)));
    let theta_h = 2.0 * (select(0.0, 0.78539816, is_wide) + t + t * series);
    let x = sqrt(sqrt(sqrt(saturate(theta_h / 1.5707964)))) * 0.9980469;
    let y = saturate(log2(max(alpha, 0.001) / 0.001) / 9.965784) * 511.0;
    let position = vec2<f32>(x + 0.0009765625, (tile * 512.0 + y + 0.5) / 1024.0);
    return textureSampleLevel(luthier_distribution, luthier_sampler, position, 0.0).r;
}

const LUTHIER_MATERIAL_WORDS: u32 = 11u;
const LUTHIER_LAYER_WORDS: u32 = 11u;

/// One layer of a material. Indices are relative to the medium above it; tiles are -1 where there is none.
struct LuthierLayer {
    /// 0 dielectric, 1 conductor, 2 diffuse base.
    kind: u32,
    /// Slope parameter of the micro-surface.
    alpha: f32,
    /// A quarter of the greatest D, 1 / (4 pi alpha^2).
    peak: f32,
    /// Index above over index below, for the refracted directions.
    inverse_eta: f32,
    /// Squared cosine of a refracted grazing direction, 1 - 1 / eta^2.
    grazing_cos_sq: f32,
    /// Tile in `luthier_fresnel`.
    fresnel_tile: f32,
    /// Tile in `luthier_distribution`.
    distribution_tile: f32,
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
    let tiles = luthier_materials[first + 1u];
    let numbers = luthier_materials[first + 10u];
    var layer: LuthierLayer;
    layer.kind = luthier_whole(numbers.x);
    layer.alpha = numbers.y;
    layer.peak = head.y;
    layer.inverse_eta = head.z;
    layer.grazing_cos_sq = head.w;
    layer.fresnel_tile = tiles.x;
    layer.distribution_tile = tiles.y;
    return layer;
}

/// Fresnel reflectance of a layer, from its row or, under a film that varies, its tile of the tables.
fn luthier_fresnel_term(layer: LuthierLayer, cos_theta_i: f32) -> vec3<f32> {
    let cos_theta_d = cos_theta_i;
    return luthier_lookup_fresnel(layer.fresnel_tile, cos_theta_d);
}

/// pi alpha^2 D of a layer whose falloff is `sharper` times its own, from the table and squares of the half vector.
fn luthier_distribution_term(layer: LuthierLayer, sharper: f32, z_sq: f32, across_sq: f32) -> f32 {
    let alpha = layer.alpha;
    let inverse_length_sq = 1.0 / (z_sq + across_sq);
    let cos_theta_h = sqrt(z_sq * inverse_length_sq);
    return luthier_lookup_distribution(layer.distribution_tile, cos_theta_h, across_sq * inverse_length_sq, alpha);
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
