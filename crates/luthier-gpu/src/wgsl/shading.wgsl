// What a place sends to the eye.

// One layer, in words: kind (0 dielectric, 1 conductor, 2 diffuse base), alpha, eta, first blurred map;
// Fresnel tile, FGD tile; optical depth; albedo.
struct ShadingLayer {
    kind: f32,
    alpha: f32,
    eta: f32,
    chain: f32,
    fresnel_tile: f32,
    fgd_tile: f32,
    optical_depth: vec3<f32>,
    albedo: vec3<f32>,
}

const SHADING_LAYER_WORDS: u32 = 4u;

// Mean cosine of light that reaches a patch evenly from its hemisphere.
const SHADING_MEAN_COSINE: f32 = 2.0 / 3.0;

// The emitted shader, called here and nowhere else. `place` is for what varies over the surface.
fn shading_eval(material: u32, place: Place, wi: vec3<f32>, wo: vec3<f32>) -> vec3<f32> {
    return luthier_eval(material, wi, wo);
}

fn shading_layer_count(material: u32) -> u32 {
    return bitcast<u32>(kernel_inputs.words[kernel_inputs.materials + material].y);
}

fn shading_layer(material: u32, index: u32) -> ShadingLayer {
    let first = bitcast<u32>(kernel_inputs.words[kernel_inputs.materials + material].x);
    let at = first + index * SHADING_LAYER_WORDS;
    let head = kernel_inputs.words[at];
    let tiles = kernel_inputs.words[at + 1u];
    let slab = kernel_inputs.words[at + 2u];
    let base = kernel_inputs.words[at + 3u];
    return ShadingLayer(head.x, head.y, head.z, head.w, tiles.x, tiles.y, slab.xyz, base.xyz);
}

// Cosine below an interface for one above it; 0 when nothing is refracted.
fn shading_refract(cos_theta: f32, eta: f32) -> f32 {
    return sqrt(max(1.0 - (1.0 - cos_theta * cos_theta) / (eta * eta), 0.0));
}

// The environment as the layers send it along wo, without sampling: each interface reflects its albedo times the blurred
// environment around the mirrored direction, a diffuse base its albedo times irradiance over pi. Layers attenuate as in
// luthier_eval, with the cosine of wo for light that comes mirrored and the mean cosine for light from everywhere. Seen
// from outside, slopes below an interface are steeper by its eta.
fn shading_prefiltered(material: u32, normal: vec3<f32>, wo: vec3<f32>, cos_theta_o: f32) -> vec3<f32> {
    let mirrored = reflect(-wo, normal);
    var leaving = vec3<f32>(1.0);
    var entering = vec3<f32>(1.0);
    var cos_out = cos_theta_o;
    var cos_in = SHADING_MEAN_COSINE;
    var alpha = 0.0;
    var spread = 1.0;
    var total = vec3<f32>(0.0);
    for (var i = 0u; i < shading_layer_count(material); i++) {
        let layer = shading_layer(material, i);
        if layer.kind == 2.0 {
            total += leaving * entering * layer.albedo * environment_diffuse(normal);
            break;
        }
        alpha = max(alpha, layer.alpha);
        let reflected_out = shading_fresnel(layer.fresnel_tile, cos_out);
        var albedo = reflected_out;
        if layer.fgd_tile >= 0.0 {
            albedo = shading_fgd(layer.fgd_tile, cos_out, alpha);
        }
        let light = environment_mirrored(u32(layer.chain), min(alpha * spread, 1.0), mirrored);
        total += leaving * leaving * albedo * light;
        if layer.kind == 1.0 {
            break;
        }
        let reflected_in = shading_fresnel(layer.fresnel_tile, cos_in);
        cos_out = shading_refract(cos_out, layer.eta);
        cos_in = shading_refract(cos_in, layer.eta);
        if min(cos_out, cos_in) <= 0.0 {
            break;
        }
        leaving *= (1.0 - reflected_out) * exp(-layer.optical_depth / cos_out);
        entering *= (1.0 - reflected_in) * exp(-layer.optical_depth / cos_in);
        spread *= layer.eta;
    }
    return total;
}

// Slope parameter of the lobe of an interface, seen from outside; 0 for what is no interface.
fn shading_lobe(material: u32, index: u32) -> f32 {
    var alpha = 0.0;
    var spread = 1.0;
    for (var i = 0u; i <= index; i++) {
        let layer = shading_layer(material, i);
        if layer.kind == 2.0 {
            return 0.0;
        }
        alpha = max(alpha, layer.alpha);
        if i < index {
            spread *= layer.eta;
        }
    }
    return clamp(alpha * spread, 1e-3, 1.0);
}

// Density over wi of the lobe that is sampled for an interface (GGX of its slope parameter), or of the cosine.
fn shading_density(alpha: f32, wi: vec3<f32>, wo: vec3<f32>) -> f32 {
    if alpha == 0.0 {
        return wi.z / ENVIRONMENT_PI;
    }
    let wh = normalize(wi + wo);
    let root = alpha / max(alpha * alpha * wh.z * wh.z + dot(wh.xy, wh.xy), 1e-20);
    return root * root * wh.z / (4.0 * ENVIRONMENT_PI * max(dot(wh, wo), 1e-6));
}

fn shading_sample(alpha: f32, u: vec2<f32>, wo: vec3<f32>) -> vec3<f32> {
    let phi = 2.0 * ENVIRONMENT_PI * u.y;
    let around = vec2<f32>(cos(phi), sin(phi));
    if alpha == 0.0 {
        return vec3<f32>(around * sqrt(u.x), sqrt(1.0 - u.x));
    }
    let tan_sq = alpha * alpha * u.x / max(1.0 - u.x, 1e-7);
    let wh = vec3<f32>(around * sqrt(tan_sq), 1.0) * inverseSqrt(1.0 + tan_sq);
    return reflect(-wo, wh);
}

fn shading_hash(x: u32) -> u32 {
    // PCG output function (Jarzynski and Olano 2020).
    let state = x * 747796405u + 2891336453u;
    let word = ((state >> ((state >> 28u) + 4u)) ^ state) * 277803737u;
    return (word >> 22u) ^ word;
}

fn shading_unit(x: u32) -> f32 {
    return f32(x >> 8u) * (1.0 / 16777216.0);
}

// The environment through luthier_eval: the same number of directions for each interface and for the cosine, Hammersley
// points shifted by the seed, weighed by the balance heuristic (Veach 1997, eq. 9.8).
fn shading_sampled(material: u32, place: Place, frame: mat3x3<f32>, wo: vec3<f32>, seed: u32) -> vec3<f32> {
    let lobes = shading_layer_count(material) + 1u;
    let count = kernel_inputs.environment_samples;
    var total = vec3<f32>(0.0);
    for (var lobe = 0u; lobe < lobes; lobe++) {
        var alpha = 0.0;
        if lobe + 1u < lobes {
            alpha = shading_lobe(material, lobe);
            if alpha == 0.0 {
                continue;
            }
        }
        let first = shading_hash(seed * 16u + lobe);
        let shift = vec2<f32>(shading_unit(first), shading_unit(shading_hash(first)));
        for (var i = 0u; i < count; i++) {
            let point = vec2<f32>((f32(i) + 0.5) / f32(count), shading_unit(reverseBits(i)));
            let wi = shading_sample(alpha, fract(point + shift), wo);
            if wi.z <= 0.0 {
                continue;
            }
            var density = wi.z / ENVIRONMENT_PI;
            for (var other = 0u; other + 1u < lobes; other++) {
                let other_alpha = shading_lobe(material, other);
                if other_alpha > 0.0 {
                    density += shading_density(other_alpha, wi, wo);
                }
            }
            let f_cos = shading_eval(material, place, wi, wo);
            total += f_cos * environment_radiance(frame * wi) / (density * f32(count));
        }
    }
    return total;
}

// Radiance along the ray that left the eye in the direction -wo_world.
fn shading_radiance(part: u32, place: Place, wo_world: vec3<f32>, seed: u32) -> vec3<f32> {
    let material = bitcast<u32>(kernel_inputs.words[kernel_inputs.parts + part].x);
    let normal = place.normal;
    let frame = mat3x3<f32>(place.tangent, cross(normal, place.tangent), normal);
    let wo = wo_world * frame;
    var total = vec3<f32>(0.0);
    for (var i = 0u; i < kernel_inputs.light_count; i++) {
        let light = kernel_inputs.words[kernel_inputs.lights + 2u * i];
        let color = kernel_inputs.words[kernel_inputs.lights + 2u * i + 1u].rgb;
        // A directional light is 1 away.
        let to_light = select(light.xyz, light.xyz - place.position, light.w == 1.0);
        let distance_sq = dot(to_light, to_light);
        let wi = (to_light * inverseSqrt(distance_sq)) * frame;
        // The second half of the materials has its slopes widened by the size of the lights.
        total += shading_eval(material + kernel_inputs.material_count, place, wi, wo) * color / distance_sq;
    }
    if kernel_inputs.environment_samples > 0u {
        return total + shading_sampled(material, place, frame, wo, seed);
    }
    return total + shading_prefiltered(material, normal, wo_world, clamp(wo.z, 1e-4, 1.0));
}
