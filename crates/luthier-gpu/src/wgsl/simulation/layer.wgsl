// Layers as the material buffer has them, and how one facet splits light.

const SIMULATION_LAYER_WORDS: u32 = $layer_wordsu;
const SIMULATION_MATERIAL_WORDS: u32 = $material_wordsu;

const SIMULATION_DIELECTRIC: u32 = 0u;
const SIMULATION_DIFFUSE: u32 = 2u;

// Indices closer than this make no interface.
const SIMULATION_INDEX_MATCH: f32 = 1e-5;

// An interface and what lies below it.
struct SimulationLayer {
    kind: u32,
    is_ggx: bool,
    // Light goes straight through.
    is_absent: bool,
    alpha: vec2<f32>,
    // Cosine and sine of the angle from the tangent of the stack to that of the layer.
    turn: vec2<f32>,
    // Index below over index above of the channel that leads; 1 below which nothing goes on.
    eta: f32,
    // Index below over index above; F0 where k is -1.
    n: vec3<f32>,
    k: vec3<f32>,
    // Optical depth along the normal over ln 2.
    depth_log2: vec3<f32>,
    // Albedo over pi.
    lambert: vec3<f32>,
    sigma: f32,
}

// The channels that share a path, and the one whose indices bend it.
struct SimulationWay {
    mask: vec3<f32>,
    lead: u32,
}

fn simulation_whole(word: f32) -> u32 {
    return bitcast<u32>(word) & 0x7fffffu;
}

fn simulation_header(material: u32) -> vec2<u32> {
    let head = luthier_materials[material * SIMULATION_MATERIAL_WORDS];
    return vec2<u32>(simulation_whole(head.x), simulation_whole(head.y));
}

// `first`: the first word of the first layer.
fn simulation_layer(first: u32, number: u32, lead: u32) -> SimulationLayer {
    let at = first + number * SIMULATION_LAYER_WORDS;
    let real_part = luthier_materials[at + 4u].xyz;
    let imaginary_part = luthier_materials[at + 5u].xyz;
    let base = luthier_materials[at + 3u];
    let tangent = luthier_materials[at + 9u];
    let numbers = luthier_materials[at + 10u];
    var layer: SimulationLayer;
    layer.kind = simulation_whole(numbers.x) & 3u;
    layer.is_ggx = base.w == 1.0;
    layer.alpha = tangent.xy;
    layer.turn = tangent.zw;
    layer.n = real_part;
    layer.k = imaginary_part;
    layer.eta = 1.0;
    if layer.kind == SIMULATION_DIELECTRIC {
        layer.eta = select(real_part[lead], numbers.z, imaginary_part.x == -1.0);
        let is_bare = imaginary_part[lead] == 0.0;
        layer.is_absent = is_bare && abs(layer.eta - 1.0) < SIMULATION_INDEX_MATCH;
    }
    layer.depth_log2 = luthier_materials[at + 2u].xyz;
    layer.lambert = base.xyz;
    layer.sigma = numbers.w;
    return layer;
}

// Share of light that comes through the slab below an interface at a cosine.
fn simulation_slab(first: u32, number: u32, cos_theta: f32) -> vec3<f32> {
    let depth_log2 = luthier_materials[first + number * SIMULATION_LAYER_WORDS + 2u].xyz;
    return exp2(-depth_log2 / cos_theta);
}

// Paths that a sample is made of: one for all channels where no transparent interface bends them apart, else one for each.
fn simulation_ways(first: u32, count: u32) -> u32 {
    for (var i = 0u; i < count; i++) {
        let layer = simulation_layer(first, i, 0u);
        if layer.kind == SIMULATION_DIELECTRIC && layer.k.x >= 0.0 && any(layer.n != layer.n.xxx) {
            return 3u;
        }
    }
    return 1u;
}

fn simulation_way(ways: u32, number: u32) -> SimulationWay {
    if ways == 1u {
        return SimulationWay(vec3<f32>(1.0), 0u);
    }
    return SimulationWay(vec3<f32>(vec3<u32>(number) == vec3<u32>(0u, 1u, 2u)), number);
}

// Reflectance for light from above: Fresnel's formulas for a complex index (Born and Wolf, sec. 14.2), or Schlick's with its
// edge tint.
fn simulation_reflectance(layer: SimulationLayer, cos_theta: f32) -> vec3<f32> {
    if layer.k.x < 0.0 {
        let c = 1.0 - cos_theta;
        let fifth = c * c * c * c * c;
        // The weight of an edge tint is what is below -1.
        return max(layer.n + (1.0 - layer.n) * fifth + (1.0 + layer.k) * (cos_theta * c * fifth), vec3<f32>(0.0));
    }
    let sin_sq = (1.0 - cos_theta) * (1.0 + cos_theta);
    let square = (layer.n - 1.0) * (layer.n + 1.0) - layer.k * layer.k + cos_theta * cos_theta;
    let product = layer.n * layer.k;
    let large = 0.5 * (sqrt(square * square + 4.0 * product * product) + abs(square));
    let small = product * product / max(large, vec3<f32>(1e-30));
    let is_real = square >= vec3<f32>(0.0);
    let real_part = sqrt(select(small, large, is_real));
    let imaginary_sq = select(large, small, is_real);
    let less = real_part - cos_theta;
    let more = real_part + cos_theta;
    let across = (less * less + imaginary_sq) / (more * more + imaginary_sq);
    let shared_part = imaginary_sq * cos_theta * cos_theta;
    let less_along = real_part * cos_theta - sin_sq;
    let more_along = real_part * cos_theta + sin_sq;
    let ratio = (less_along * less_along + shared_part) / (more_along * more_along + shared_part);
    return 0.5 * across * (1.0 + ratio);
}

// Shares of light at a facet, and the cosine of the refracted ray.
struct SimulationSplit {
    reflected: vec3<f32>,
    transmitted: vec3<f32>,
    cos_theta_t: f32,
}

// Index of a side over that of the other.
fn simulation_eta(layer: SimulationLayer, above: bool) -> f32 {
    return select(layer.eta, 1.0 / layer.eta, above);
}

fn simulation_split(layer: SimulationLayer, above: bool, cos_theta: f32) -> SimulationSplit {
    let cosine = clamp(cos_theta, 0.0, 1.0);
    if layer.kind != SIMULATION_DIELECTRIC {
        return SimulationSplit(simulation_reflectance(layer, cosine), vec3<f32>(0.0), 0.0);
    }
    let eta_it = simulation_eta(layer, above);
    let cos_t_sq = 1.0 - (1.0 - cosine) * (1.0 + cosine) * (eta_it * eta_it);
    if cos_t_sq <= 0.0 || cosine == 0.0 {
        return SimulationSplit(vec3<f32>(1.0), vec3<f32>(0.0), 0.0);
    }
    let cos_t = sqrt(cos_t_sq);
    let reflected = clamp(simulation_reflectance(layer, select(cos_t, cosine, above)), vec3<f32>(0.0), vec3<f32>(1.0));
    return SimulationSplit(reflected, 1.0 - reflected, cos_t);
}

// BRDF of a rough diffuse base (Oren and Nayar 1994, eq. 26-30, with inter-reflection); Lambert at sigma 0.
fn simulation_diffuse(layer: SimulationLayer, wi: vec3<f32>, wo: vec3<f32>) -> vec3<f32> {
    if layer.sigma == 0.0 {
        return layer.lambert;
    }
    let sines = vec2<f32>(length(wi.xy), length(wo.xy));
    let cosines = max(vec2<f32>(wi.z, wo.z), vec2<f32>(1e-12));
    let theta = atan2(sines, cosines);
    let most = max(theta.x, theta.y);
    let least = min(theta.x, theta.y);
    let cos_phi = clamp(dot(wi.xy, wo.xy) / max(sines.x * sines.y, 1e-30), -1.0, 1.0);
    let tan_least = min(sines.x, sines.y) / max(cosines.x, cosines.y);
    let tan_mean = (sines.x + sines.y) / (cosines.x + cosines.y);
    let sigma_sq = layer.sigma * layer.sigma;
    let back = 2.0 / SIMULATION_PI * least;
    let lobe = max(sines.x, sines.y) - select(0.0, back * back * back, cos_phi < 0.0);
    let angles = 4.0 / (SIMULATION_PI * SIMULATION_PI) * most * least;
    let c1 = 1.0 - 0.5 * sigma_sq / (sigma_sq + 0.33);
    let c2 = 0.45 * sigma_sq / (sigma_sq + 0.09) * lobe;
    let c3 = 0.125 * sigma_sq / (sigma_sq + 0.09) * angles * angles;
    let direct = c1 + c2 * cos_phi * tan_least + c3 * (1.0 - abs(cos_phi)) * tan_mean;
    let bounced = 0.17 * sigma_sq / (sigma_sq + 0.13) * (1.0 - cos_phi * back * back);
    return max(layer.lambert * (direct + SIMULATION_PI * layer.lambert * bounced), vec3<f32>(0.0));
}
