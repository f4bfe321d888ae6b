/// Schlick 1994.
fn luthier_schlick(normal: vec3<f32>, cos_theta: f32) -> vec3<f32> {
    let q = 1.0 - cos_theta;
    return normal + (1.0 - normal) * (q * q * q * q * q);
}

//? edge_tint
/// Reflectance of a layer with an F0, and with an edge tint if it has one (Kutz, Hasan and Edmondson 2021).
fn luthier_edge_tinted(layer: LuthierLayer, cos_theta: f32) -> vec3<f32> {
    let q = 1.0 - cos_theta;
    let fifth = q * q * q * q * q;
    // The weight of the correction is what is below -1.
    return max(layer.ior_n + (1.0 - layer.ior_n) * fifth + (1.0 + layer.ior_k) * (cos_theta * q * fifth), vec3<f32>(0.0));
}
