/// Share of the energy that a rough interface sends back, all bounces included: RGB; A is the luminance of the part
/// that never crossed the interface.
fn luthier_lookup_fgd(tile: f32, cos_theta: f32, alpha: f32) -> vec4<f32> {
    //? theta_axis
    {
        let cosine = saturate(cos_theta);
        let theta = atan2(sqrt((1.0 - cosine) * (1.0 + cosine)), cosine);
        let x = $x(theta);
    }
    //? else
    let x = $x(cos_theta);
    let y = $y(alpha);
    let position = $position(x, y);
    return $read;
}
