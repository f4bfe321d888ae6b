/// A part of a row of lobes over the cosine of the view: 0 is the wide remainder RGB; then for each lobe its strength RGB with its
/// shift, and its shape with its share above the horizon; last is the albedo RGB.
fn luthier_lookup_lobes(tile: f32, cos_theta: f32, part: f32) -> vec4<f32> {
    let x = $x(cos_theta);
    let y = $y(part);
    let position = $position(x, y);
    return $read;
}
