// The environment by directions about the lobes of layer records, for shaders that draw none.

// Slope parameter of the lobe of an interface whose slopes a place has times a factor, seen from outside; 0 for what is no interface. Models that make a base as rough as
// its coat are sampled for the coat as well.
fn shading_lobe(material: u32, index: u32, factor: f32) -> f32 {
    var alpha = 0.0;
    var spread = 1.0;
    for (var i = 0u; i <= index; i++) {
        let layer = shading_layer(material, i);
        if layer.kind == 2.0 {
            return 0.0;
        }
        alpha = min(layer.alpha * factor, 1.0);
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

// The environment through luthier_eval: the same number of directions for each interface and for the cosine, Hammersley
// points shifted by the seed, weighed by the balance heuristic (Veach 1997, eq. 9.8).
fn shading_around(material: u32, surface: ShadingSurface, frame: mat3x3<f32>, wo: vec3<f32>, seed: u32$place) -> vec3<f32> {
    let factors = shading_factors(material, surface);
    let turn = shading_turned_frame(mat3x3<f32>(1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0), factors.normal);
    let wo_there = wo * turn;
    if wo_there.z <= 0.0 {
        return vec3<f32>(0.0);
    }
    let lobes = shading_layer_count(material) + 1u;
    let count = kernel_inputs.environment_samples;
    var total = vec3<f32>(0.0);
    for (var lobe = 0u; lobe < lobes; lobe++) {
        var alpha = 0.0;
        if lobe + 1u < lobes {
            alpha = shading_lobe(material, lobe, factors.alpha);
            if alpha == 0.0 {
                continue;
            }
        }
        let first = shading_hash(seed * 16u + lobe);
        let shift = vec2<f32>(shading_unit(first), shading_unit(shading_hash(first)));
        let first_direction = kernel_inputs.first_direction;
        for (var i = first_direction; i < first_direction + kernel_inputs.direction_count; i++) {
            let point = vec2<f32>((f32(i) + 0.5) / f32(count), shading_unit(reverseBits(i)));
            let there = shading_sample(alpha, fract(point + shift), wo_there);
            let wi = turn * there;
            if min(there.z, wi.z) <= 0.0 {
                continue;
            }
            var density = there.z / ENVIRONMENT_PI;
            for (var other = 0u; other + 1u < lobes; other++) {
                let other_alpha = shading_lobe(material, other, factors.alpha);
                if other_alpha > 0.0 {
                    density += shading_density(other_alpha, there, wo_there);
                }
            }
            let seen = shading_lit(material, surface, wi, wo, $radiance);
            total += seen / (density * f32(count));
        }
    }
    return total;
}
