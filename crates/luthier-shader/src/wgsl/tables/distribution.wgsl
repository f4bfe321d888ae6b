/// pi alpha^2 D of a slope distribution, for the angle between half vector and normal: D is this over pi alpha^2.
fn luthier_lookup_distribution(tile: f32, cos_theta_h: f32, sin_theta_h_sq: f32, alpha: f32) -> f32 {
    //? theta_axis
    {
        // atan2 may be a thousandth of a lobe off on some devices; this is twice the arc tangent of the tangent of the half angle, by the
        // polynomial of Cephes.
        let tangent = sqrt(sin_theta_h_sq) / (1.0 + cos_theta_h);
        let is_wide = tangent > 0.41421356;
        let t = select(tangent, (tangent - 1.0) / (tangent + 1.0), is_wide);
        let t_sq = t * t;
        let series = t_sq * (-0.33332949 + t_sq * (0.19977711 + t_sq * (-0.13877686 + t_sq * 0.08053744)));
        let theta_h = 2.0 * (select(0.0, 0.78539816, is_wide) + t + t * series);
        let x = $x(theta_h);
    }
    //? else
    let x = $x(cos_theta_h);
    let y = $y(alpha);
    let position = $position(x, y);
    //? split_root
    {
        // The texel holds the sixteenth root, split in two halves.
        let halves = $read.rg;
        let root = halves.x + halves.y / 1024.0;
        let square = root * root;
        let fourth = square * square;
        let eighth = fourth * fourth;
        return eighth * eighth;
    }
    //? else
    return $read.r;
}
