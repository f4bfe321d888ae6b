/// 2 cos(2 Phi) of a film (Granier and Heidrich 2003, eq. 19), RGB, over s = d (cos_ti + cos_to) / (2 d_max).
fn luthier_lookup_phase(tile: f32, s: f32) -> vec3<f32> {
    let x = $x(s);
    let position = $position(x, 0.0);
    return $read.rgb;
}
