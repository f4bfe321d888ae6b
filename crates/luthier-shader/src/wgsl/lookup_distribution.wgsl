/// pi alpha^2 D of a slope distribution, for the angle between half vector and normal: D is this over pi alpha^2.
fn luthier_lookup_distribution(tile: f32, cos_theta_h: f32, sin_theta_h_sq: f32, alpha: f32) -> f32 {
    // atan2 may be a thousandth of a lobe off on some devices; this is twice the arc tangent of the tangent of the half angle, by the //? theta_axis
    // polynomial of Cephes. //? theta_axis
    let tangent = sqrt(sin_theta_h_sq) / (1.0 + cos_theta_h); //? theta_axis
    let is_wide = tangent > 0.41421356; //? theta_axis
    let t = select(tangent, (tangent - 1.0) / (tangent + 1.0), is_wide); //? theta_axis
    let t_sq = t * t; //? theta_axis
    let series = t_sq * (-0.33332949 + t_sq * (0.19977711 + t_sq * (-0.13877686 + t_sq * 0.08053744))); //? theta_axis
    let theta_h = 2.0 * (select(0.0, 0.78539816, is_wide) + t + t * series); //? theta_axis
    let x = $x(theta_h); //? theta_axis
    let x = $x(cos_theta_h); //? !theta_axis
    let y = $y(alpha);
    let position = $position(x, y);
    // The texel holds the sixteenth root, split in two halves. //? split_root
    let halves = $read.rg; //? split_root
    let root = halves.x + halves.y / 1024.0; //? split_root
    let square = root * root; //? split_root
    let fourth = square * square; //? split_root
    let eighth = fourth * fourth; //? split_root
    return eighth * eighth; //? split_root
    return $read.r; //? !split_root
}
