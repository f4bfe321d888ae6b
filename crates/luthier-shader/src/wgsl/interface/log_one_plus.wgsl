/// log2(1 + x) of x >= 0, as a series where the sum would round what is added to 1.
fn luthier_log2_one_plus(x: f32) -> f32 {
    let s = x / (2.0 + x);
    let s_sq = s * s;
    let series = 2.88539008 * s * (1.0 + s_sq * (0.33333333 + s_sq * (0.2 + s_sq * 0.14285714)));
    return select(log2(1.0 + x), series, x < 0.25);
}
