fn luthier_fresnel(ior_n: vec3<f32>, ior_k: vec3<f32>, cos_theta: f32) -> vec3<f32> {
    let k_sq = ior_k * ior_k;
    let f0 = ((ior_n - 1.0) * (ior_n - 1.0) + k_sq) / ((ior_n + 1.0) * (ior_n + 1.0) + k_sq);
    let away = 1.0 - cos_theta;
    let away_sq = away * away;
    return f0 + (1.0 - f0) * (away_sq * away_sq * away);
}
