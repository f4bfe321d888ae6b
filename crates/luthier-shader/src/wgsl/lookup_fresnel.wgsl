/// Fresnel reflectance of an interface, RGB.
fn luthier_lookup_fresnel(tile: f32, cos_theta: f32) -> vec3<f32> {
    let cosine = saturate(cos_theta); //? theta_axis
    let theta = atan2(sqrt((1.0 - cosine) * (1.0 + cosine)), cosine); //? theta_axis
    let x = $x(theta); //? theta_axis
    let x = $x(cos_theta); //? !theta_axis
    let position = $position(x, 0.0);
    return $read.rgb;
}
