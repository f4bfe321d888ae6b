/// Share of the energy that a rough interface sends back, all bounces included: RGB; A is the luminance of the part
/// that never crossed the interface.
fn luthier_lookup_fgd(tile: f32, cos_theta: f32, alpha: f32) -> vec4<f32> {
    let cosine = saturate(cos_theta); //? theta_axis
    let theta = atan2(sqrt((1.0 - cosine) * (1.0 + cosine)), cosine); //? theta_axis
    let x = $x(theta); //? theta_axis
    let x = $x(cos_theta); //? !theta_axis
    let y = $y(alpha);
    let position = $position(x, y);
    return $read;
}
