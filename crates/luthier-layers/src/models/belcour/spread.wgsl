/// Variance that an interface adds, its slope parameter times `scale`.
fn luthier_belcour_interface_spread(layer: LuthierLayer, scale: f32) -> f32 {
    return luthier_variance(scale * layer.alpha);
}

/// Slope parameter of the isotropic surface of that variance.
fn luthier_belcour_mean_alpha(spread: f32) -> f32 {
    return luthier_spread_alpha(spread);
}

/// A variance held far beyond that of any surface, but finite.
fn luthier_belcour_limited(spread: f32) -> f32 {
    return min(spread, 1e9);
}

/// f cos_theta_i of the lobe of the last interface: a GGX surface of its variance.
fn luthier_belcour_lobe(path: LuthierBelcour, wi: vec3<f32>, wo: vec3<f32>) -> vec3<f32> {
    let alpha = luthier_spread_alpha(path.lobe_spread);
    return path.lobe_energy * luthier_ggx_lobe(vec2<f32>(alpha), vec2<f32>(1.0, 0.0), wi, wo);
}

/// The lobe of the last interface as a part to draw from.
fn luthier_belcour_part(path: LuthierBelcour) -> LuthierPart {
    var part = luthier_no_part();
    part.energy = path.lobe_energy;
    part.alpha = vec2<f32>(luthier_spread_alpha(path.lobe_spread));
    return part;
}
