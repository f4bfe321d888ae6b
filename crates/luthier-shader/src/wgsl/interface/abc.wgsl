/// pi alpha^2 D of the distribution ABC, 1 / (1 + b (1 - cos))^c, from squares of a half vector of any length. A falloff other than 1 stretches
/// its slopes.
fn luthier_abc(shape: vec2<f32>, falloff: f32, z_sq: f32, across_sq: f32) -> f32 {
    let narrowed_sq = across_sq * falloff;
    let length_sq = z_sq + narrowed_sq;
    let ratio = (z_sq + across_sq) / length_sq;
    // 1 less the cosine, without cancellation.
    let versine = narrowed_sq / (length_sq + sqrt(z_sq * length_sq));
    return ratio * ratio * exp2(-shape.y * luthier_log2_one_plus(shape.x * versine));
}
