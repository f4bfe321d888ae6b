/// A direction in the frame of a layer, its tangential part times `scale`. //? anisotropic
fn luthier_scaled(layer: LuthierLayer, scale: vec2<f32>, w: vec3<f32>) -> vec2<f32> { //? anisotropic
    let turn = layer.rotation; //? anisotropic
    return scale * vec2<f32>(turn.x * w.x + turn.y * w.y, turn.x * w.y - turn.y * w.x); //? anisotropic
} //? anisotropic

/// D of a layer at the half vector along `bisector`, whose squared length is `length_sq`.
fn luthier_density(layer: LuthierLayer, bisector: vec3<f32>, length_sq: f32) -> f32 {
    let inverse_length = inverseSqrt(length_sq);
    let cos_theta_h = bisector.z * inverse_length;
    let sin_theta_h_sq = dot(bisector.xy, bisector.xy) * inverse_length * inverse_length; //? !anisotropic
    let across_sq = dot(bisector.xy, bisector.xy); //? anisotropic
    let sin_theta_h_sq = across_sq * inverse_length * inverse_length; //? anisotropic
    // An anisotropic surface is, along one azimuth, an isotropic one of another slope parameter. //? anisotropic
    let area = layer.alpha_xy.x * layer.alpha_xy.y; //? anisotropic
    let crossed = luthier_scaled(layer, layer.alpha_xy.yx, bisector); //? anisotropic
    let crossed_sq = dot(crossed, crossed); //? anisotropic
    let along = area * sqrt(across_sq / max(crossed_sq, 1e-30)); //? anisotropic
    let alpha = select(layer.alpha, along, crossed_sq > 1e-30); //? anisotropic
    let area = layer.alpha * layer.alpha; //? !anisotropic
    let alpha = layer.alpha; //? !anisotropic
    return luthier_distribution_term(layer, alpha, cos_theta_h, sin_theta_h_sq) / LUTHIER_PI / area;
}
