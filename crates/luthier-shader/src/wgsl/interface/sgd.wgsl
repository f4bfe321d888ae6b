/// pi alpha^2 D of the shifted gamma distribution (Bagher et al. 2012), from squares of a half vector of any length; `shape` is 1 / alpha of the
/// paper, and p. A falloff other than 1 stretches its slopes.
fn luthier_sgd(shape: vec2<f32>, falloff: f32, z_sq: f32, across_sq: f32) -> f32 {
    let slope_sq = min(across_sq / z_sq, 1e6);
    let secant_sq = 1.0 + slope_sq;
    let t = slope_sq * falloff * shape.x;
    return exp2(-1.44269504 * t - shape.y * luthier_log2_one_plus(t * shape.x)) * (secant_sq * secant_sq);
}
