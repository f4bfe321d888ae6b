// What a place sends to the eye.

// One layer, in words: kind (0 dielectric, 1 conductor, 2 diffuse base), alpha, eta, first blurred map;
// Fresnel tile, FGD tile, film tile, fraction of the film's greatest thickness; optical depth, squared cotangent of the critical angle;
// albedo.
struct ShadingLayer {
    kind: f32,
    alpha: f32,
    eta: f32,
    chain: f32,
    fresnel_tile: f32,
    fgd_tile: f32,
    film_tile: f32,
    film_fraction: f32,
    optical_depth: vec3<f32>,
    critical_cot_sq: f32,
    albedo: vec3<f32>,
}

const SHADING_LAYER_WORDS: u32 = 4u;

// Mean cosine of light that reaches a patch evenly from its hemisphere.
const SHADING_MEAN_COSINE: f32 = 2.0 / 3.0;

// What the maps of a material say about a place.
struct ShadingMaps {
    uv: vec2<f32>,
    // Unit, in the frame of the shape.
    normal: vec3<f32>,
    roughness: f32,
    thickness: f32,
    patina: f32,
    flake: vec3<f32>,
    has_flakes: bool,
}

// What a part shows at a place: a material, and the normal of a particle.
struct ShadingPick {
    material: u32,
    normal: vec3<f32>,
}

// The same as the blurred environment takes it.
struct ShadingFactors {
    normal: vec3<f32>,
    alpha: f32,
    slab: f32,
    film: f32,
    // Normal below the first interface, in the frame of `normal`.
    below: vec3<f32>,
    // Below 0: none.
    patina: f32,
}

// Texel of a map that repeats. `header`: word offset, columns, rows.
fn shading_texel(header: vec4<u32>, at: vec2<f32>) -> vec4<f32> {
    let size = vec2<f32>(header.yz);
    let wrapped = vec2<u32>(clamp(at - floor(at / size) * size, vec2<f32>(0.0), size - 1.0));
    return kernel_inputs.words[header.x + wrapped.y * header.y + wrapped.x];
}

fn shading_bilinear(header: vec4<u32>, uv: vec2<f32>) -> vec4<f32> {
    let position = fract(uv) * vec2<f32>(header.yz) - 0.5;
    let corner = floor(position);
    let weight = position - corner;
    let above = mix(shading_texel(header, corner), shading_texel(header, corner + vec2<f32>(1.0, 0.0)), weight.x);
    let below = mix(shading_texel(header, corner + vec2<f32>(0.0, 1.0)), shading_texel(header, corner + 1.0), weight.x);
    return mix(above, below, weight.y);
}

fn shading_map_header(material: u32, slot: u32) -> vec4<u32> {
    let maps = bitcast<u32>(kernel_inputs.words[kernel_inputs.materials + material].z);
    return bitcast<vec4<u32>>(kernel_inputs.words[maps + slot]);
}

// The maps at a texture coordinate: filtered, but those of flakes are not.
fn shading_maps(material: u32, uv: vec2<f32>) -> ShadingMaps {
    var maps = ShadingMaps(uv, vec3<f32>(0.0, 0.0, 1.0), 1.0, 1.0, 0.5, vec3<f32>(0.0), false);
    let normal = shading_map_header(material, 0u);
    if normal.y > 0u {
        let n = 2.0 * shading_bilinear(normal, uv).xyz - 1.0;
        maps.normal = normalize(vec3<f32>(n.xy, max(n.z, 1e-3)));
    }
    let roughness = shading_map_header(material, 1u);
    if roughness.y > 0u {
        maps.roughness = shading_bilinear(roughness, uv).x;
    }
    let thickness = shading_map_header(material, 2u);
    if thickness.y > 0u {
        maps.thickness = shading_bilinear(thickness, uv).x;
    }
    let patina = shading_map_header(material, 3u);
    if patina.y > 0u {
        maps.patina = shading_bilinear(patina, uv).x;
    }
    let flakes = shading_map_header(material, 4u);
    if flakes.y > 0u {
        let tiling = luthier_materials[luthier_header(material) + 4u].w;
        maps.flake = 2.0 * shading_texel(flakes, floor(fract(uv * tiling) * vec2<f32>(flakes.yz))).xyz - 1.0;
        maps.has_flakes = true;
    }
    return maps;
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
    return ShadingLayer(head.x, head.y, head.z, head.w, tiles.x, tiles.y, tiles.z, tiles.w, slab.xyz, slab.w, base.xyz);
}

// Cosine at which the Fresnel row and the film tile of a layer are read.
fn shading_row_cosine(layer: ShadingLayer, cos_theta: f32) -> f32 {
    let sin_theta_sq = (1.0 - cos_theta) * (1.0 + cos_theta);
    return sqrt(max(cos_theta * cos_theta - layer.critical_cot_sq * sin_theta_sq, 0.0));
}

// Cosine below an interface for one above it; 0 when nothing is refracted.
fn shading_refract(cos_theta: f32, eta: f32) -> f32 {
    return sqrt(max(1.0 - (1.0 - cos_theta * cos_theta) / (eta * eta), 0.0));
}

// The environment as the layers send it along wo, without sampling: each interface reflects its albedo times the blurred
// environment around the mirrored direction, a diffuse base its albedo times irradiance over pi. Layers attenuate as in
// luthier_eval, with the cosine of wo for light that comes mirrored and the mean cosine for light from everywhere. Seen
// from outside, slopes below an interface are steeper by its eta.
fn shading_prefiltered(
    material: u32, factors: ShadingFactors, is_bare: bool, frame: mat3x3<f32>, wo: vec3<f32>,
) -> vec3<f32> {
    let normal = frame[2];
    let patina_diffuse = bitcast<vec4<f32>>(shading_map_header(material, 5u));
    var tarnish = vec3<f32>(1.0);
    if factors.patina >= 0.0 {
        tarnish = mix(tarnish, bitcast<vec4<f32>>(shading_map_header(material, 6u)).rgb, factors.patina);
    }
    var mirrored = frame * vec3<f32>(-wo.xy, wo.z);
    var leaving = vec3<f32>(1.0);
    var entering = vec3<f32>(1.0);
    var cos_out = clamp(wo.z, 1e-4, 1.0);
    var cos_in = SHADING_MEAN_COSINE;
    var alpha = 0.0;
    var spread = 1.0;
    var total = vec3<f32>(0.0);
    let count = shading_layer_count(material);
    for (var i = select(0u, 1u, is_bare); i < count; i++) {
        var layer = shading_layer(material, select(i, count, is_bare && i == 1u));
        if layer.kind == 2.0 {
            total += leaving * entering * layer.albedo * environment_diffuse(normal);
            break;
        }
        layer.alpha = min(layer.alpha * factors.alpha, 1.0);
        if i == 1u && factors.patina >= 0.0 && patina_diffuse.w >= 0.0 {
            layer.alpha = mix(layer.alpha, patina_diffuse.w, factors.patina);
        }
        alpha = max(alpha, layer.alpha);
        let row_out = shading_row_cosine(layer, cos_out);
        let row_in = shading_row_cosine(layer, cos_in);
        var reflected_out = shading_fresnel(layer.fresnel_tile, row_out);
        var reflected_in = shading_fresnel(layer.fresnel_tile, row_in);
        var albedo = reflected_out;
        if layer.film_tile >= 0.0 {
            // Albedos are tabulated for one thickness.
            let fraction = layer.film_fraction * select(1.0, factors.film, i == 0u);
            reflected_out = shading_film(layer.film_tile, row_out, fraction);
            reflected_in = shading_film(layer.film_tile, row_in, fraction);
            albedo = reflected_out;
        } else if layer.fgd_tile >= 0.0 {
            albedo = shading_fgd(layer.fgd_tile, cos_out, alpha);
        }
        if i > 0u {
            albedo *= tarnish;
        }
        let light = environment_mirrored(u32(layer.chain), min(alpha * spread, 1.0), mirrored);
        total += leaving * leaving * albedo * light;
        if i == 0u && factors.patina > 0.0 {
            let scattered = (1.0 - reflected_out) * (1.0 - reflected_in) * patina_diffuse.rgb;
            total += scattered * environment_diffuse(normal);
        }
        if layer.kind == 1.0 {
            break;
        }
        let outside = cos_out;
        cos_out = shading_refract(cos_out, layer.eta);
        cos_in = shading_refract(cos_in, layer.eta);
        if min(cos_out, cos_in) <= 0.0 {
            break;
        }
        if i == 0u && factors.below.z < 1.0 {
            // What a tilted mirror below the interface shows.
            let down = vec3<f32>(wo.xy / layer.eta, cos_out);
            let up = reflect(-down, factors.below);
            let across_sq = dot(up.xy, up.xy) * layer.eta * layer.eta;
            cos_out = dot(down, factors.below);
            if min(cos_out, up.z) <= 0.0 || across_sq >= 1.0 {
                break;
            }
            mirrored = frame * vec3<f32>(up.xy * layer.eta, sqrt(1.0 - across_sq));
        }
        let depth = layer.optical_depth * select(1.0, factors.slab, i == 0u);
        leaving *= (1.0 - reflected_out) * exp(-depth / cos_out);
        entering *= (1.0 - reflected_in) * exp(-depth / cos_in);
        spread *= layer.eta;
    }
    return total;
}

// The same with and without the first layer where patina has grown in part.
fn shading_environment(material: u32, factors: ShadingFactors, frame: mat3x3<f32>, wo: vec3<f32>) -> vec3<f32> {
    let grown = select(1.0, factors.patina, factors.patina >= 0.0);
    var total = vec3<f32>(0.0);
    if grown < 1.0 {
        total += (1.0 - grown) * shading_prefiltered(material, factors, true, frame, wo);
    }
    if grown > 0.0 {
        total += grown * shading_prefiltered(material, factors, false, frame, wo);
    }
    return total;
}

// The frame whose +z is `n` (unit, in the frame): turned the shortest way, as luthier_eval_at does.
fn shading_turned_frame(frame: mat3x3<f32>, n: vec3<f32>) -> mat3x3<f32> {
    let a = 1.0 / (1.0 + max(n.z, 0.0));
    let shear = -n.x * n.y * a;
    return frame * mat3x3<f32>(vec3<f32>(1.0 - n.x * n.x * a, shear, -n.x), vec3<f32>(shear, 1.0 - n.y * n.y * a, -n.y), n);
}

// Slope parameter of the lobe of an interface, seen from outside; 0 for what is no interface. Models that make a base as rough as
// its coat are sampled for the coat as well.
fn shading_lobe(material: u32, index: u32) -> f32 {
    var alpha = 0.0;
    var spread = 1.0;
    for (var i = 0u; i <= index; i++) {
        let layer = shading_layer(material, i);
        if layer.kind == 2.0 {
            return 0.0;
        }
        alpha = layer.alpha;
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
fn shading_sampled(material: u32, surface: ShadingSurface, frame: mat3x3<f32>, wo: vec3<f32>, seed: u32$place) -> vec3<f32> {
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
        let first_direction = kernel_inputs.first_direction;
        for (var i = first_direction; i < first_direction + kernel_inputs.direction_count; i++) {
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
            let seen = shading_lit(material, surface, wi, wo, $radiance);
            total += seen / (density * f32(count));
        }
    }
    return total;
}

// Radiance along the ray that left the eye in the direction -wo_world.
fn shading_radiance(part: u32, place: Place, wo_world: vec3<f32>, seed: u32) -> vec3<f32> {
    let pick = shading_pick(bitcast<vec4<u32>>(kernel_inputs.words[kernel_inputs.parts + part]), place.uv);
    let material = pick.material;
    var maps = shading_maps(material, place.uv);
    if pick.normal.z < 1.0 {
        maps.normal = pick.normal;
    }
    let normal = place.normal;
    let frame = mat3x3<f32>(place.tangent, cross(normal, place.tangent)$sign, normal);
    let wo = wo_world * frame;
    let surface = shading_surface(material, maps, length(kernel_inputs.eye - place.position));
    var total = vec3<f32>(0.0);
    let light_count = select(0u, kernel_inputs.light_count, kernel_inputs.first_direction == 0u);
    for (var i = 0u; i < light_count; i++) {
        let light = kernel_inputs.words[kernel_inputs.lights + 2u * i];
        let color = kernel_inputs.words[kernel_inputs.lights + 2u * i + 1u].rgb;
        // A directional light is 1 away.
        let to_light = select(light.xyz, light.xyz - place.position, light.w == 1.0);
        let distance_sq = dot(to_light, to_light);
        let wi = (to_light * inverseSqrt(distance_sq)) * frame;
        // The second half of the materials has its slopes widened by the size of the lights.
        total += shading_lit(material + kernel_inputs.material_count, surface, wi, wo, color) / distance_sq$sees;
    }
    if kernel_inputs.environment_samples > 0u {
        return total + shading_sampled(material, surface, frame, wo, seed$here);
    }
    let factors = shading_factors(surface);
    let turned = shading_turned_frame(frame, factors.normal);
    if kernel_inputs.words[kernel_inputs.materials + material].w > 0.0 {
        // The samples of a pixel share the directions of a circle.
        let samples = kernel_inputs.samples * kernel_inputs.samples;
        let turn = f32(seed % samples) / f32(samples);
        return total + lobes_environment(material, surface, turned, wo_world * turned, turn)$open;
    }
    return total + shading_environment(material, factors, turned, wo_world * turned)$open;
}
