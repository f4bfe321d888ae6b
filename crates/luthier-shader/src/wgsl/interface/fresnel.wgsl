//? !complex_index
/// Fresnel reflectance of unpolarised light between transparent media of one relative index, total reflection included.
fn luthier_fresnel_real(index: f32, cos_theta: f32) -> f32 {
    let excess = (index - 1.0) * (index + 1.0);
    let square = excess + cos_theta * cos_theta;
    let sum = sqrt(max(square, 0.0)) + cos_theta;
    // The difference of both cosines does not cancel where the media are alike.
    let difference = excess / sum;
    let refl_s = difference / sum;
    let refl_ratio = (cos_theta * sum - 1.0) / (cos_theta * difference + 1.0);
    return select(0.5 * refl_s * refl_s * (1.0 + refl_ratio * refl_ratio), 1.0, square <= 0.0);
}

//? complex_index
/// Exact Fresnel reflectance of unpolarised light for the relative index n + i k, total reflection included.
fn luthier_fresnel(ior_n: vec3<f32>, ior_k: vec3<f32>, cos_theta: f32) -> vec3<f32> {
    let below = luthier_normal_index(ior_n, ior_k, cos_theta);
    let sin_sq = 1.0 - cos_theta * cos_theta;
    let im_sq = below.im * below.im;
    let difference = below.re - cos_theta;
    let sum = below.re + cos_theta;
    let refl_s = (difference * difference + im_sq) / (sum * sum + im_sq);
    let along = below.re * cos_theta;
    let across = im_sq * cos_theta * cos_theta;
    let refl_ratio = ((along - sin_sq) * (along - sin_sq) + across) / ((along + sin_sq) * (along + sin_sq) + across);
    return 0.5 * refl_s * (1.0 + refl_ratio);
}
