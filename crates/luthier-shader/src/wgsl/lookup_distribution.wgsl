/// pi alpha^2 D of a slope distribution, for the angle between half vector and normal: D is this over pi alpha^2.
fn luthier_lookup_distribution(tile: f32, cos_theta_h: f32, sin_theta_h_sq: f32, alpha: f32) -> f32 {
    let theta_h = atan2(sqrt(sin_theta_h_sq), cos_theta_h); //? theta_axis
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
