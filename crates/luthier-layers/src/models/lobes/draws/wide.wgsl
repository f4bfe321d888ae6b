/// Shares of the draws of the remainder by mu (1 - mu)^2 and by mu (1 - mu)^5, mu being the cosine of the light, and a factor on its energy for its chance:
/// see `WideDraw` of the f64 twin.
fn luthier_wide_draw(prepared: LuthierPreparedLobes) -> vec3<f32> {
    let more = max(-prepared.medium.zy, vec2<f32>(0.0)) / vec2<f32>(6.0, 21.0);
    let all = 1.0 + more.x + more.y;
    return vec3<f32>(more / all, max(all * prepared.medium.w * LUTHIER_PI, 1.0));
}

/// Density in solid angle of draws of the remainder.
fn luthier_wide_density(given: vec3<f32>, cos_theta: f32) -> f32 {
    let away = 1.0 - cos_theta;
    let away_sq = away * away;
    let ways = 1.0 - given.x - given.y + 6.0 * given.x * away_sq + 21.0 * given.y * (away_sq * away_sq * away);
    return ways * (cos_theta / LUTHIER_PI);
}

/// A direction of the remainder.
fn luthier_draw_wide(given: vec3<f32>, u: vec3<f32>) -> vec3<f32> {
    let phi = 2.0 * LUTHIER_PI * u.z;
    var cos_theta = sqrt(1.0 - u.y);
    var sin_theta = sqrt(u.y);
    if u.x < given.x + given.y {
        // 1 - mu has the density of a product of powers.
        let is_square = u.x < given.x;
        let rest = select((u.x - given.x) / given.y, u.x / given.x, is_square);
        let powers = select(vec2<f32>(1.0 / 6.0, 1.0 / 7.0), vec2<f32>(1.0 / 3.0, 0.25), is_square);
        let away = pow(u.y, powers.x) * pow(max(1.0 - rest, 0.0), powers.y);
        cos_theta = 1.0 - away;
        sin_theta = sqrt(away * (2.0 - away));
    }
    return vec3<f32>(sin_theta * vec2<f32>(cos(phi), sin(phi)), cos_theta);
}
