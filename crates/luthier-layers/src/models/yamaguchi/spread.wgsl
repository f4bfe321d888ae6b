/// Covariance (xx, xy, yy) that an interface adds, its slope parameters times `scale` (Yamaguchi et al. 2019, eq. 1).
fn luthier_yamaguchi_interface_spread(layer: LuthierLayer, scale: f32) -> vec3<f32> {
    //? anisotropic
    {
        let variance_x = luthier_variance(scale * layer.alpha_xy.x);
        let variance_y = luthier_variance(scale * layer.alpha_xy.y);
        let turn = layer.rotation;
        let turn_sq = turn * turn;
        let xx = turn_sq.x * variance_x + turn_sq.y * variance_y;
        let yy = turn_sq.y * variance_x + turn_sq.x * variance_y;
        return vec3<f32>(xx, turn.x * turn.y * (variance_x - variance_y), yy);
    }
    //? else
    return luthier_variance(scale * layer.alpha) * vec3<f32>(1.0, 0.0, 1.0);
}

/// Slope parameter of the isotropic surface of the same mean variance.
fn luthier_yamaguchi_mean_alpha(spread: vec3<f32>) -> f32 {
    return luthier_spread_alpha(0.5 * (spread.x + spread.z));
}

/// A covariance held far beyond that of any surface, but finite.
fn luthier_yamaguchi_limited(spread: vec3<f32>) -> vec3<f32> {
    return spread * min(1e9 / max(spread.x + spread.z, 1e-20), 1.0);
}

/// The last lobe as a GGX surface along the principal axes of its covariance: its slope parameters, and the axis of the first.
fn luthier_yamaguchi_axes(path: LuthierYamaguchi) -> vec4<f32> {
    let spread = path.lobe_spread;
    let half_difference = 0.5 * (spread.x - spread.z);
    let radius = sqrt(half_difference * half_difference + spread.y * spread.y);
    let first = 0.5 * (spread.x + spread.z) + radius;
    let second = max((spread.x * spread.z - spread.y * spread.y) / max(first, 1e-20), 0.0);
    // Half the angle of (half_difference, xy): the larger of sine and cosine first. Equal variances have any axis.
    let larger = sqrt(0.5 + 0.5 * min(abs(half_difference) / max(radius, 1e-20), 1.0));
    let smaller = 0.5 * spread.y / max(radius * larger, 1e-20);
    let turned = select(vec2<f32>(larger, smaller), vec2<f32>(smaller, larger), half_difference < 0.0);
    let axis = select(vec2<f32>(1.0, 0.0), turned, radius > 0.0);
    return vec4<f32>(luthier_spread_alpha(first), luthier_spread_alpha(second), axis);
}

/// f cos_theta_i of the lobe of the last interface.
fn luthier_yamaguchi_lobe(path: LuthierYamaguchi, wi: vec3<f32>, wo: vec3<f32>) -> vec3<f32> {
    let axes = luthier_yamaguchi_axes(path);
    return path.lobe_energy * luthier_ggx_lobe(axes.xy, axes.zw, wi, wo);
}

/// The lobe of the last interface as a part to draw from.
fn luthier_yamaguchi_part(path: LuthierYamaguchi) -> LuthierPart {
    let axes = luthier_yamaguchi_axes(path);
    var part = luthier_no_part();
    part.energy = path.lobe_energy;
    part.alpha = axes.xy;
    part.axis = axes.zw;
    return part;
}
