/// BRDF of a Lambertian base.
fn luthier_diffuse(layer: LuthierLayer) -> vec3<f32> {
    return layer.lambert;
}
