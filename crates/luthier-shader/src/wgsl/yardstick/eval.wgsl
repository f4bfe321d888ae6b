/// f cos_theta_i of one light.
fn luthier_eval(material: u32, wi: vec3<f32>, wo: vec3<f32>) -> vec3<f32> {
    return luthier_light(luthier_prepare(material, wo), wi);
}
