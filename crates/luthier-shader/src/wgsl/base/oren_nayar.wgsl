/// BRDF of a rough diffuse base (Oren and Nayar 1994, eq. 26-30, with inter-reflection); Lambert at sigma 0.
fn luthier_diffuse(layer: LuthierLayer, wi: vec3<f32>, wo: vec3<f32>) -> vec3<f32> {
    //? ~oren_nayar
    if layer.sigma == 0.0 {
        return layer.lambert;
    }
    let sines = vec2<f32>(length(wi.xy), length(wo.xy));
    let cosines = max(vec2<f32>(wi.z, wo.z), vec2<f32>(1e-12));
    let theta = atan2(sines, cosines);
    let alpha = max(theta.x, theta.y);
    let beta = min(theta.x, theta.y);
    // Along the normal there is no azimuth, and every term with it is multiplied by zero.
    let cos_phi = clamp(dot(wi.xy, wo.xy) / max(sines.x * sines.y, 1e-30), -1.0, 1.0);

    // Tangents from sines and cosines: those of angles near pi/2 lose their sign in f32.
    let tan_beta = min(sines.x, sines.y) / max(cosines.x, cosines.y);
    let tan_mean = (sines.x + sines.y) / (cosines.x + cosines.y);
    let sigma_sq = layer.sigma * layer.sigma;
    let c1 = 1.0 - 0.5 * sigma_sq / (sigma_sq + 0.33);
    let back = 0.636619772 * beta;
    let lobe = max(sines.x, sines.y) - select(0.0, back * back * back, cos_phi < 0.0);
    let c2 = 0.45 * sigma_sq / (sigma_sq + 0.09) * lobe;
    let angles = 0.405284735 * alpha * beta;
    let c3 = 0.125 * sigma_sq / (sigma_sq + 0.09) * angles * angles;
    let direct = c1 + c2 * cos_phi * tan_beta + c3 * (1.0 - abs(cos_phi)) * tan_mean;
    let bounced = 0.17 * sigma_sq / (sigma_sq + 0.13) * (1.0 - cos_phi * back * back);
    return max(layer.lambert * (direct + LUTHIER_PI * layer.lambert * bounced), vec3<f32>(0.0));
}
