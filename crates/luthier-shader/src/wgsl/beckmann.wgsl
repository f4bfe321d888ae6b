/// pi alpha^2 D of Beckmann. Below a cosine of 0.1 it is zero in f32 for any alpha <= 1.
fn luthier_beckmann(alpha: f32, cos_theta_h: f32, sin_theta_h_sq: f32) -> f32 {
    let secant_sq = 1.0 / max(cos_theta_h * cos_theta_h, 0.01);
    return exp(-sin_theta_h_sq * secant_sq / (alpha * alpha)) * (secant_sq * secant_sq);
}
