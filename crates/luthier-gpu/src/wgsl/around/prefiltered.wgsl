// The environment by maps of it that were blurred beforehand.

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
    let is_film = bitcast<f32>(shading_map_header(material, 6u).w) > 0.5;
    let first = select(0u, 1u, is_bare && !is_film);
    for (var i = first; i < count; i++) {
        var layer = shading_layer(material, select(i, count, is_bare && i == first));
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

// The environment as a place sends it along wo.
fn shading_around(material: u32, surface: ShadingSurface, frame: mat3x3<f32>, wo: vec3<f32>, seed: u32$place) -> vec3<f32> {
    let factors = shading_factors(material, surface);
    let turned = shading_turned_frame(frame, factors.normal);
    let wo_there = (frame * wo) * turned;
    if kernel_inputs.words[kernel_inputs.materials + material].w > 0.0 {
        // The samples of a pixel share the directions of a circle. One sample does not turn.
        let samples = kernel_inputs.samples * kernel_inputs.samples;
        let turn = select((f32(seed % samples) + 0.5) / f32(samples), 0.0, samples == 1u);
        return lobes_environment(material, surface, turned, wo_there, turn)$open;
    }
    return shading_environment(material, factors, turned, wo_there)$open;
}
