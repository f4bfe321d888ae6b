/// (1 - away)^exponent, 0 from `away` 1 on: Phong's lobe, from 1 minus its cosine.
fn luthier_power_lobe(away: f32, exponent: f32) -> f32 {
    if away >= 1.0 {
        return 0.0;
    }
    // log(1 - away), as a series where the logarithm would round what is left of 1.
    let s = away / (2.0 - away);
    let s_sq = s * s;
    let series = -2.0 * s * (1.0 + s_sq * (0.33333333 + s_sq * (0.2 + s_sq * 0.14285714)));
    return exp(exponent * select(log(1.0 - away), series, away < 0.25));
}
