/// Thickness record of a film that varies over the surface: d / (2 d_max), two slopes, normalisation. Repeats in uv.
fn luthier_lookup_thickness(tile: f32, uv: vec2<f32>) -> vec4<f32> {
    let x = $x(uv.x);
    let y = $y(uv.y);
    let position = $position(x, y);
    return $read;
}
