/// Variance of the light that a GGX surface reflects, in the projected disc (Belcour 2018, eq. 4).
fn luthier_variance(alpha: f32) -> f32 {
    let power = pow(clamp(alpha, 1e-12, 0.9999), 1.1);
    return power / (1.0 - power);
}

/// Its inverse: slope parameter of the GGX surface that spreads light this far.
fn luthier_spread_alpha(variance: f32) -> f32 {
    return clamp(pow(max(variance, 1e-20) / (1.0 + variance), 0.909090909), 0.0001, 1.0);
}

//? full
/// Share of the light at a cosine above an interface that it sends back, its facets taken as level.
fn luthier_energy_fgd(layer: LuthierLayer, cos_theta: f32) -> vec3<f32> {
    return saturate(luthier_fresnel_term(layer, cos_theta));
}
//? else
/// Share of the light at a cosine above an interface that it sends back, all bounces on it included.
fn luthier_energy_fgd(layer: LuthierLayer, cos_theta: f32) -> vec3<f32> {
    //? level
    {
        //? fgd
        if layer.reflectance != 0u {
            return saturate(luthier_fresnel_term(layer, cos_theta));
        }
        //? else
        return saturate(luthier_fresnel_term(layer, cos_theta));
    }
    //? !level|fgd
    {
        let given = luthier_lookup_fgd(layer.fgd_tile, cos_theta, layer.alpha).rgb;
        //? own_f0
        // What another F0 does not reflect is in proportion: exact of one bounce, and where all is reflected.
        //? own_edge
        {
            // An edge tint is taken off as at a level facet.
            let cubed = (1.0 - cos_theta) * (1.0 - cos_theta) * (1.0 - cos_theta);
            return saturate(1.0 - layer.passing * (1.0 - given) - layer.edge * (cos_theta * cubed * cubed));
        }
        //? else
        return saturate(1.0 - layer.passing * (1.0 - given));
        //? else
        return saturate(given);
    }
}

/// f cos_theta_i of a perfectly reflecting GGX surface, its slope parameters along an axis and across it: D G / (4 cos_theta_o), G
/// height-correlated (Heitz 2014, eq. 99), multiplied out so that no vanishing cosine is left alone below a fraction.
fn luthier_ggx_lobe(alpha: vec2<f32>, axis: vec2<f32>, wi: vec3<f32>, wo: vec3<f32>) -> f32 {
    let bisector = wi + wo;
    let length_sq = dot(bisector, bisector);
    if length_sq < 1e-24 {
        return 0.0;
    }
    let across = vec2<f32>(-axis.y, axis.x);
    let slope = vec2<f32>(dot(axis, bisector.xy), dot(across, bisector.xy)) / alpha;
    let ratio = length_sq / (dot(slope, slope) + bisector.z * bisector.z);
    let light = alpha * vec2<f32>(dot(axis, wi.xy), dot(across, wi.xy));
    let eye = alpha * vec2<f32>(dot(axis, wo.xy), dot(across, wo.xy));
    let light_length = sqrt(wi.z * wi.z + dot(light, light));
    let eye_length = sqrt(wo.z * wo.z + dot(eye, eye));
    return ratio * ratio / (2.0 * LUTHIER_PI * alpha.x * alpha.y * (eye_length + wo.z / wi.z * light_length));
}

/// BRDF of a diffuse base below layers (T(wi) T(wo) f / (n^2 (1 - rho R)), R their reflectance of diffuse light from below) for
/// what comes down along both directions, these directions above the base, and the index there over that outside.
fn luthier_base(material: u32, layer: LuthierLayer, transmitted: vec3<f32>, wi: vec3<f32>, wo: vec3<f32>, eta: f32) -> vec3<f32> {
    let veil = luthier_materials[luthier_header(material) + $word_veil];
    let lost = max(1.0 - LUTHIER_PI * layer.lambert * veil.rgb, vec3<f32>(1e-6));
    let brdf = $diffuse(layer, wi, wo);
    return transmitted * brdf * ((1.0 - veil.w) / (eta * eta)) / lost;
}
