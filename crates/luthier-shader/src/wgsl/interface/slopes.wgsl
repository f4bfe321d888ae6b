/// A direction in the frame of a layer, its tangential part times `scale`.
fn luthier_stretched(layer: LuthierLayer, scale: vec2<f32>, w: vec3<f32>) -> vec2<f32> {
    let turn = layer.rotation;
    return scale * vec2<f32>(turn.x * w.x + turn.y * w.y, turn.x * w.y - turn.y * w.x);
}

/// D / 4 of a layer at the half vector along `bisector`, above the horizon.
fn luthier_quarter_density(layer: LuthierLayer, bisector: vec3<f32>) -> f32 {
    let z_sq = bisector.z * bisector.z;
    let across_sq = dot(bisector.xy, bisector.xy);
    //? ~anisotropic
    if layer.alpha_xy.x == layer.alpha_xy.y {
        return luthier_distribution_term(layer, 1.0, z_sq, across_sq) * layer.peak;
    }
    //? anisotropic
    {
        // An anisotropic surface is, along one azimuth, an isotropic one of another slope parameter.
        let area = layer.alpha_xy.x * layer.alpha_xy.y;
        let crossed = luthier_stretched(layer, layer.alpha_xy.yx, bisector);
        let ratio = layer.alpha * layer.alpha * dot(crossed, crossed) / (area * area * max(across_sq, 1e-30));
        let sharper = select(1.0, ratio, across_sq > 1e-30);
        return luthier_distribution_term(layer, sharper, z_sq, across_sq) / (4.0 * LUTHIER_PI * area);
    }
    //? else
    return luthier_distribution_term(layer, 1.0, z_sq, across_sq) * layer.peak;
}
