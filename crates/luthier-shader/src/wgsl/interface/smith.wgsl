/// A lobe of a rough interface: what reflects between two directions.
struct LuthierLobe {
    /// Cosine between either direction and the half vector.
    cos_theta_d: f32,
    /// D G / (4 cos_theta_o): f cos_theta_i of a perfectly reflecting surface, one bounce.
    value: f32,
}

/// Smith's Lambda of a direction above the horizon (Walter et al. 2007, eq. 34 for GGX; Heitz 2014, table 1).
fn luthier_lambda(layer: LuthierLayer, w: vec3<f32>) -> f32 {
    //? anisotropic
    let across = luthier_stretched(layer, layer.alpha_xy, w);
    //? else
    let across = layer.alpha * w.xy;
    let slope_sq = dot(across, across) / (w.z * w.z);
    //? beckmann
    {
        //? ggx
        if layer.distribution > 0.5 {
            return 0.5 * (sqrt(1.0 + slope_sq) - 1.0);
        }
        if slope_sq < 0.01 {
            return 0.0;
        }
        // erfc as Abramowitz and Stegun 1964, 7.1.26: within 1.5e-7.
        let nu = inverseSqrt(slope_sq);
        let t = 1.0 / (1.0 + 0.3275911 * nu);
        let poly = t * (0.254829592 + t * (-0.284496736 + t * (1.421413741 + t * (-1.453152027 + t * 1.061405429))));
        return max(exp(-nu * nu) * (0.282094792 / nu - 0.5 * poly), 0.0);
    }
    //? else
    return 0.5 * (sqrt(1.0 + slope_sq) - 1.0);
}

/// The lobe of a layer.
fn luthier_smith_lobe(layer: LuthierLayer, wi: vec3<f32>, wo: vec3<f32>) -> LuthierLobe {
    // For unit directions cos_theta_d is half the length of their sum, which does not cancel at grazing angles.
    let bisector = vec3<f32>(wi.xy + wo.xy, max(wi.z + wo.z, 1e-16));
    let length_sq = dot(bisector, bisector);
    if length_sq < 1e-24 {
        return LuthierLobe(0.0, 0.0);
    }
    //? masked
    let masking = luthier_masking(layer, wi, wo, bisector, length_sq);
    //? else
    // Height-correlated (Heitz 2014, eq. 99).
    let masking = 1.0 / (1.0 + luthier_lambda(layer, wi) + luthier_lambda(layer, wo));
    return LuthierLobe(min(0.5 * sqrt(length_sq), 1.0), luthier_quarter_density(layer, bisector) * (masking / wo.z));
}
