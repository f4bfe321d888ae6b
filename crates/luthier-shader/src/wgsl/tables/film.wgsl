/// Reflectance of an interface under a film that varies, RGB, over the thickness of the film as a fraction of its greatest.
fn luthier_lookup_film(tile: f32, cos_theta: f32, fraction: f32) -> vec3<f32> {
    let x = $x(cos_theta);
    let y = $y(fraction);
    let position = $position(x, y);
    return $read.rgb;
}
