/// A part of a row of lobes over the cosine of the view: 0 is the wide remainder RGB, the last the albedo RGB. Between them one lobe has its strength RGB
/// with its shift, and its shape with its share above the horizon; two have both strengths with shifts, the sharpness of both, and decays and shares.
fn luthier_lookup_lobes(tile: f32, cos_theta: f32, part: f32) -> vec4<f32> {
    let x = $x(cos_theta);
    let y = $y(part);
    let position = $position(x, y);
    return $read;
}
