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
