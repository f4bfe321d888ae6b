// Model: elek (O. Elek, Layered Materials in Real-Time Rendering, CESCG 2010).
// Fresnel reflectance and slope distribution are read from tables.
//
// Tables, in texels:
//   fresnel       128 x 3 rgba16float, 3 tiles of 128 x 1; cos_theta 0..1
//   distribution  512 x 1024 r16float, 2 tiles of 512 x 512; theta_h 0..1.5707964 as u^8, alpha 0.001..1 logarithmic
//
// Bindings, group 0:
//   0 luthier_fresnel: texture
//   1 luthier_distribution: texture
//   5 luthier_sampler: sampler, linear, clamp to edge
//   6 luthier_materials: storage buffer, 31 vec4
//
// Materials:
//   0 varnished-gold, elek, 2 layers

const LUTHIER_MATERIAL_VARNISHED_GOLD: u32 = 0u;

@group(0) @binding(0) var luthier_fresnel: texture_2d<f32>;
@group(0) @binding(1) var luthier_distribution: texture_2d<f32>;
@group(0) @binding(5) var luthier_sampler: sampler;
@group(0) @binding(6) var<storage, read> luthier_materials: array<vec4<f32>>;

const LUTHIER_FRESNEL_SIZE: vec2<f32> = vec2<f32>(128.0, 3.0);

/// Fresnel reflectance of an interface, RGB.
fn luthier_lookup_fresnel(tile: f32, cos_theta: f32) -> vec3<f32> {
    let x = saturate(cos_theta) * 127.0;
    let position = vec2<f32>(x + 0.5, tile + 0.5);
    return textureSampleLevel(luthier_fresnel, luthier_sampler, position / LUTHIER_FRESNEL_SIZE, 0.0).rgb;
}

const LUTHIER_DISTRIBUTION_SIZE: vec2<f32> = vec2<f32>(512.0, 1024.0);
const LUTHIER_DISTRIBUTION_TILE: vec2<f32> = vec2<f32>(512.0, 512.0);

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
    let x = sqrt(sqrt(sqrt(saturate(theta_h / 1.5707964)))) * 511.0;
    let y = saturate(log2(max(alpha, 0.001) / 0.001) / 9.965784) * 511.0;
    let position = vec2<f32>(x + 0.5, tile * LUTHIER_DISTRIBUTION_TILE.y + y + 0.5);
    return textureSampleLevel(luthier_distribution, luthier_sampler, position / LUTHIER_DISTRIBUTION_SIZE, 0.0).r;
}

const LUTHIER_PI: f32 = 3.14159265;

const LUTHIER_MATERIAL_WORDS: u32 = 11u;
const LUTHIER_LAYER_WORDS: u32 = 10u;

/// One layer of a material. Indices are relative to the medium above it; tiles are -1 where there is none.
struct LuthierLayer {
    /// 0 dielectric, 1 conductor, 2 diffuse base.
    kind: u32,
    /// Slope parameter of the micro-surface.
    alpha: f32,
    /// Index below over index above, for the refracted directions.
    eta: f32,
    /// Tile of the Fresnel table.
    fresnel_tile: f32,
    /// Tile of the distribution table.
    distribution_tile: f32,
}

/// Index of the first word of a material in the buffer.
fn luthier_header(material: u32) -> u32 {
    return material * LUTHIER_MATERIAL_WORDS;
}

/// Number of layers of a material.
fn luthier_layer_count(material: u32) -> u32 {
    return u32(luthier_materials[luthier_header(material)].y);
}

/// A layer of a material, counted from the top.
fn luthier_layer(material: u32, index: u32) -> LuthierLayer {
    let first = u32(luthier_materials[luthier_header(material)].x) + index * LUTHIER_LAYER_WORDS;
    let head = luthier_materials[first];
    let tiles = luthier_materials[first + 1u];
    var layer: LuthierLayer;
    layer.kind = u32(head.x);
    layer.alpha = head.y;
    layer.eta = head.z;
    layer.fresnel_tile = tiles.x;
    layer.distribution_tile = tiles.y;
    return layer;
}

/// Fresnel reflectance of a layer, from its row or, under a film that varies, its tile of the tables.
fn luthier_fresnel_term(layer: LuthierLayer, cos_theta_d: f32) -> vec3<f32> {
    return luthier_lookup_fresnel(layer.fresnel_tile, cos_theta_d);
}

/// pi alpha^2 D of a layer, from the table.
fn luthier_distribution_term(layer: LuthierLayer, alpha: f32, cos_theta_h: f32, sin_theta_h_sq: f32) -> f32 {
    return luthier_lookup_distribution(layer.distribution_tile, cos_theta_h, sin_theta_h_sq, alpha);
}

/// D of a layer at the half vector along `bisector`, whose squared length is `length_sq`.
fn luthier_density(layer: LuthierLayer, bisector: vec3<f32>, length_sq: f32) -> f32 {
    let inverse_length = inverseSqrt(length_sq);
    let cos_theta_h = bisector.z * inverse_length;
    let sin_theta_h_sq = dot(bisector.xy, bisector.xy) * inverse_length * inverse_length;
    let area = layer.alpha * layer.alpha;
    let alpha = layer.alpha;
    return luthier_distribution_term(layer, alpha, cos_theta_h, sin_theta_h_sq) / LUTHIER_PI / area;
}

/// What the light has met on its way down and back up: directions, and sums over the layers so far.
struct LuthierPath {
    /// To the light, in the medium above the next layer.
    wi: vec3<f32>,
    /// To the eye, in the medium above the next layer.
    wo: vec3<f32>,
    /// Sum of their tangential parts. It nearly cancels in a highlight, so that it is refracted as a whole.
    across: vec2<f32>,
    /// Share of the light that comes down to the next layer and back out, times the outer cos_theta_i.
    throughput: vec3<f32>,
    /// Reflected by the layers so far: f cos_theta_i.
    reflected: vec3<f32>,
    /// Greatest slope parameter so far: a layer is never smoother than those above it.
    alpha: f32,
    /// Whether any light reaches the next layer.
    open: bool,
}

/// Adds what a rough interface reflects (Torrance-Sparrow, F D G / (4 cos_theta_i cos_theta_o)) and goes on to the
/// layer below it (Weidlich and Wilkie 2007; Elek 2010, eq. 2-4).
fn luthier_add_interface(path: LuthierPath, layer: LuthierLayer) -> LuthierPath {
    var next = path;
    next.open = false;

    // For unit directions cos_theta_d is half the length of their sum, which does not cancel at grazing angles.
    let bisector = vec3<f32>(path.across, path.wi.z + path.wo.z);
    let length_sq = dot(bisector.xy, bisector.xy) + bisector.z * bisector.z;
    if length_sq < 1e-24 {
        return next;
    }
    let inverse_length = inverseSqrt(length_sq);
    let cos_theta_d = min(0.5 * length_sq * inverse_length, 1.0);
    let fresnel = luthier_fresnel_term(layer, cos_theta_d);
    // G of V-cavities: 2 cos_theta_h / cos_theta_d times the lower cosine, at most 1. Below 1e-18 that cosine cancels, and
    // the product of both would underflow.
    let cavity = 4.0 * (bisector.z * inverse_length) * inverse_length;
    let cosines = max(vec2<f32>(path.wi.z, path.wo.z), vec2<f32>(1e-18));
    let masking = min(cavity * min(cosines.x, cosines.y), 1.0);
    let shape = luthier_density(layer, bisector, length_sq) * masking / (4.0 * cosines.x * cosines.y);
    next.reflected = path.reflected + path.throughput * fresnel * shape;

    // Refracted at the normal; the squared cosine is written so that it does not cancel for an index near 1.
    let inverse_eta = 1.0 / layer.eta;
    let cosines_sq = (cosines * cosines + (layer.eta - 1.0) * (layer.eta + 1.0)) * (inverse_eta * inverse_eta);
    if min(cosines_sq.x, cosines_sq.y) <= 0.0 {
        return next;
    }
    let secants = inverseSqrt(cosines_sq);
    let refracted = cosines_sq * secants;
    next.wi = vec3<f32>(path.wi.xy * inverse_eta, refracted.x);
    next.wo = vec3<f32>(path.wo.xy * inverse_eta, refracted.y);
    next.across = path.across * inverse_eta;
    next.open = true;
    // (1 - F) down, (1 - F) up, and part of what the cavities block comes back.
    let crossed = 1.0 - fresnel;
    let kept = crossed * (1.0 - masking + crossed * masking);
    next.throughput = path.throughput * kept;
    return next;
}

/// Adds an interface, which is never smoother than those above it.
fn luthier_elek_interface(path: LuthierPath, layer: LuthierLayer) -> LuthierPath {
    var rougher = layer;
    rougher.alpha = max(path.alpha, layer.alpha);
    var next = luthier_add_interface(path, rougher);
    next.alpha = rougher.alpha;
    return next;
}

/// f cos_theta_i of the model `elek`, both directions above the horizon.
fn luthier_eval_elek(material: u32, wi: vec3<f32>, wo: vec3<f32>) -> vec3<f32> {
    var path = LuthierPath(wi, wo, wi.xy + wo.xy, vec3<f32>(wi.z), vec3<f32>(0.0), 0.0, true);
    path = luthier_elek_interface(path, luthier_layer(material, 0u));
    if path.open {
        path = luthier_elek_interface(path, luthier_layer(material, 1u));
    }
    return path.reflected;
}

/// f cos_theta_i, RGB, of a material for light from wi seen from wo: unit, in the local frame (+z is the normal), away
/// from the surface. Zero when either is not above the horizon.
fn luthier_eval(material: u32, wi: vec3<f32>, wo: vec3<f32>) -> vec3<f32> {
    if min(wi.z, wo.z) <= 0.0 {
        return vec3<f32>(0.0);
    }
    return luthier_eval_elek(material, wi, wo);
}
