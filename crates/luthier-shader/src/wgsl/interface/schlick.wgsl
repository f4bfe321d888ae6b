/// Schlick 1994.
fn luthier_schlick(normal: vec3<f32>, cos_theta: f32) -> vec3<f32> {
    let q = 1.0 - cos_theta;
    return normal + (1.0 - normal) * (q * q * q * q * q);
}
