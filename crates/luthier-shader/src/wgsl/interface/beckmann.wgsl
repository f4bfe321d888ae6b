/// pi alpha^2 D of Beckmann, from squares of a half vector of any length. Beyond a slope of 10 it is zero in f32 for any alpha <= 1.
fn luthier_beckmann(falloff: f32, z_sq: f32, across_sq: f32) -> f32 {
    let slope_sq = min(across_sq / z_sq, 100.0);
    let secant_sq = 1.0 + slope_sq;
    return exp2(-slope_sq * falloff) * (secant_sq * secant_sq);
}
