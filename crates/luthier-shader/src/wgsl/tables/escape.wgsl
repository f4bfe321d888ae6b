/// Share of a lobe inside a medium that is not totally reflected at its surface (Belcour 2018, sec. 5), for the cosine outside of the
/// refracted direction.
fn luthier_lookup_escape(tile: f32, cos_theta: f32, alpha: f32) -> f32 {
    let x = $x(cos_theta);
    let y = $y(alpha);
    let position = $position(x, y);
    return $read.r;
}
