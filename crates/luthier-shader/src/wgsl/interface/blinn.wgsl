/// pi alpha^2 D of Blinn, from squares of a half vector of any length: the cosine to the power of 2 / alpha^2 - 2.
fn luthier_blinn(falloff: f32, z_sq: f32, across_sq: f32) -> f32 {
    return exp2(-max(falloff - 1.0, 0.0) * luthier_log2_one_plus(min(across_sq / z_sq, 1e30)));
}
