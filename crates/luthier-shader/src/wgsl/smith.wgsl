/// A lobe of a rough interface: what reflects between two directions.
struct LuthierLobe {
    /// Cosine between either direction and the half vector.
    cos_theta_d: f32,
    /// D G / (4 cos_theta_o): f cos_theta_i of a perfectly reflecting surface, one bounce.
    value: f32,
}

/// A direction in the frame of a layer, its tangential part times the slope parameters. //? anisotropic
fn luthier_stretched(layer: LuthierLayer, w: vec3<f32>) -> vec2<f32> { //? anisotropic
    let turn = layer.rotation; //? anisotropic
    return layer.alpha_xy * vec2<f32>(turn.x * w.x + turn.y * w.y, turn.x * w.y - turn.y * w.x); //? anisotropic
} //? anisotropic

/// Smith's Lambda of a direction above the horizon (Walter et al. 2007, eq. 34 for GGX; Heitz 2014, table 1).
fn luthier_lambda(layer: LuthierLayer, w: vec3<f32>) -> f32 {
    let across = luthier_stretched(layer, w); //? anisotropic
    let across = layer.alpha * w.xy; //? !anisotropic
    let slope_sq = dot(across, across) / (w.z * w.z);
    if layer.distribution > 0.5 { //? beckmann, ggx
        return 0.5 * (sqrt(1.0 + slope_sq) - 1.0); //? ggx
    } //? beckmann, ggx
    if slope_sq < 0.01 { //? beckmann
        return 0.0; //? beckmann
    } //? beckmann
    // erfc as Abramowitz and Stegun 1964, 7.1.26: within 1.5e-7. //? beckmann
    let nu = inverseSqrt(slope_sq); //? beckmann
    let t = 1.0 / (1.0 + 0.3275911 * nu); //? beckmann
    let poly = t * (0.254829592 + t * (-0.284496736 + t * (1.421413741 + t * (-1.453152027 + t * 1.061405429)))); //? beckmann
    return max(exp(-nu * nu) * (0.282094792 / nu - 0.5 * poly), 0.0); //? beckmann
}

/// The lobe of a layer, with height-correlated masking 1 / (1 + Lambda_i + Lambda_o) (Heitz 2014, eq. 99).
fn luthier_smith_lobe(layer: LuthierLayer, wi: vec3<f32>, wo: vec3<f32>) -> LuthierLobe {
    // For unit directions cos_theta_d is half the length of their sum, which does not cancel at grazing angles.
    let bisector = wi + wo;
    let length_sq = dot(bisector, bisector);
    if length_sq < 1e-24 {
        return LuthierLobe(0.0, 0.0);
    }
    let sin_theta_h_sq = dot(bisector.xy, bisector.xy) / length_sq;
    let cos_theta_h = bisector.z / sqrt(length_sq);
    // The slope parameter along the azimuth of the half vector. //? anisotropic
    let area = layer.alpha_xy.x * layer.alpha_xy.y; //? anisotropic
    let turn = layer.rotation; //? anisotropic
    let x = layer.alpha_xy.y * (turn.x * bisector.x + turn.y * bisector.y); //? anisotropic
    let y = layer.alpha_xy.x * (turn.x * bisector.y - turn.y * bisector.x); //? anisotropic
    let plain = dot(bisector.xy, bisector.xy); //? anisotropic
    let along = area * sqrt(plain / max(x * x + y * y, 1e-30)); //? anisotropic
    let alpha = select(layer.alpha, along, x * x + y * y > 1e-30); //? anisotropic
    let slopes = luthier_distribution_term(layer, alpha, cos_theta_h, sin_theta_h_sq) / (LUTHIER_PI * area); //? anisotropic
    let area = layer.alpha * layer.alpha; //? !anisotropic
    let slopes = luthier_distribution_term(layer, layer.alpha, cos_theta_h, sin_theta_h_sq) / (LUTHIER_PI * area); //? !anisotropic
    let masking = 1.0 / (1.0 + luthier_lambda(layer, wi) + luthier_lambda(layer, wo));
    return LuthierLobe(min(0.5 * sqrt(length_sq), 1.0), slopes * (masking / (4.0 * wo.z)));
}
