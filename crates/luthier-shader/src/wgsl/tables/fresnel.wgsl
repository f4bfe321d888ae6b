/// Fresnel reflectance of an interface, RGB.
fn luthier_lookup_fresnel(tile: f32, cos_theta: f32) -> vec3<f32> {
    //? theta_axis|schlick_base
    let cosine = saturate(cos_theta);
    //? theta_axis
    {
        let theta = atan2(sqrt((1.0 - cosine) * (1.0 + cosine)), cosine);
        let x = $x(theta);
    }
    //? else
    let x = $x(cos_theta);
    let position = $position(x, 0.0);
    //? schlick_base
    {
        // Behind the nodes lie the coefficients of Schlick's form (1994) and a dip before grazing angles; the nodes hold the rest.
        let header = vec2<i32>(position - vec2<f32>(x, 0.0)) + vec2<i32>($nodes, 0);
        let normal = textureLoad(luthier_fresnel, header, 0);
        let edge = textureLoad(luthier_fresnel, header + vec2<i32>(1, 0), 0).rgb * 32.0 - 16.0;
        let scale = textureLoad(luthier_fresnel, header + vec2<i32>(2, 0), 0).rgb;
        let away = 1.0 - cosine;
        let away_sq = away * away;
        let w = away_sq * away_sq * away;
        let f_normal = 1.25 * normal.rgb;
        let schlick = f_normal + (normal.a - f_normal) * w - edge * (cosine * away * w);
        return schlick + scale * ($span * $read.rgb - 1.0);
    }
    //? else
    return $read.rgb;
}
