/// pi alpha^2 D of GGX (Trowbridge-Reitz).
fn luthier_ggx(alpha: f32, cos_theta_h: f32, sin_theta_h_sq: f32) -> f32 {
    let alpha_sq = alpha * alpha;
    let ratio = alpha_sq / (alpha_sq * cos_theta_h * cos_theta_h + sin_theta_h_sq);
    return ratio * ratio;
}
