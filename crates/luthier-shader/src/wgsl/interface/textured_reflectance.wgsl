/// Reflectance of a layer as it is at a place: Schlick's form with another F0 leaves a constant factor of what it left.
fn luthier_fresnel_term(layer: LuthierLayer, cos_theta_d: f32) -> vec3<f32> {
    return 1.0 - layer.passing * (1.0 - luthier_fresnel_given(layer, cos_theta_d));
}
