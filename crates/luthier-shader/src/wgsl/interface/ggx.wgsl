/// pi alpha^2 D of GGX (Trowbridge-Reitz), from squares of a half vector of any length.
fn luthier_ggx(falloff: f32, z_sq: f32, across_sq: f32) -> f32 {
    let ratio = (z_sq + across_sq) / (z_sq + across_sq * falloff);
    return ratio * ratio;
}
