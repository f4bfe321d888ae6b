/// BRDF of a rough diffuse base (Oren and Nayar 1994, eq. 26-30, with inter-reflection); Lambert at sigma 0.
fn luthier_diffuse(layer: LuthierLayer, wi: vec3<f32>, wo: vec3<f32>) -> vec3<f32> {
    let sines = vec2<f32>(length(wi.xy), length(wo.xy));
    let cosines = max(vec2<f32>(wi.z, wo.z), vec2<f32>(1e-12));
    let angles = atan2(sines, cosines);
    let high = max(angles.x, angles.y);
    let low = min(angles.x, angles.y);
    // Along the normal there is no azimuth, and every term with it is multiplied by zero.
    let cos_phi = clamp(dot(wi.xy, wo.xy) / max(sines.x * sines.y, 1e-30), -1.0, 1.0);

    // Tangents from sines and cosines: those of angles near pi/2 lose their sign in f32.
    let tan_low = min(sines.x, sines.y) / max(cosines.x, cosines.y);
    let tan_mean = (sines.x + sines.y) / (cosines.x + cosines.y);
    let sigma_sq = layer.sigma * layer.sigma;
    let back = 0.636619772 * low;
    let lobe = max(sines.x, sines.y) - select(0.0, back * back * back, cos_phi < 0.0);
    let cross_angle = 0.405284735 * high * low;
    let flat_part = 1.0 - 0.5 * sigma_sq / (sigma_sq + 0.33);
    let forward = 0.45 * sigma_sq / (sigma_sq + 0.09) * lobe * cos_phi * tan_low;
    let side = 0.125 * sigma_sq / (sigma_sq + 0.09) * cross_angle * cross_angle * (1.0 - abs(cos_phi)) * tan_mean;
    let direct = flat_part + forward + side;
    let bounced = 0.17 * sigma_sq / (sigma_sq + 0.13) * (1.0 - cos_phi * back * back);
    return max(layer.lambert * (direct + LUTHIER_PI * layer.lambert * bounced), vec3<f32>(0.0));
}
