// Light of the surroundings, prefiltered by `luthier environment`, that a material sends to the eye.
fn ball_surroundings(material: u32, wo: vec3<f32>, frame: mat3x3<f32>) -> vec3<f32> {
    return luthier_environment(luthier_prepare(material, wo), frame, 0.0);
}
