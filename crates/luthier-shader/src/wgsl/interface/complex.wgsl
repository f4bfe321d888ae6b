/// Complex numbers at three wavelengths.
struct LuthierComplex {
    re: vec3<f32>,
    im: vec3<f32>,
}

/// Normal component of the wave vector in a medium, over that above: sqrt((n + i k)^2 - sin_theta^2), both parts >= 0.
/// Formed without cancellation for an index near 1, under total reflection, and for weak absorption.
fn luthier_normal_index(ior_n: vec3<f32>, ior_k: vec3<f32>, cos_theta: f32) -> LuthierComplex {
    let square = (ior_n - 1.0) * (ior_n + 1.0) - ior_k * ior_k + cos_theta * cos_theta;
    let product = ior_n * ior_k;
    let modulus = sqrt(square * square + 4.0 * product * product);
    let large_sq = 0.5 * (modulus + abs(square));
    let small_sq = product * product / max(large_sq, vec3<f32>(1e-30));
    let propagates = square >= vec3<f32>(0.0);
    let re_sq = luthier_choose(small_sq, large_sq, propagates);
    let im_sq = luthier_choose(large_sq, small_sq, propagates);
    return LuthierComplex(sqrt(re_sq), sqrt(im_sq));
}
