fn ball_surroundings(material: u32, wo: vec3<f32>, frame: mat3x3<f32>) -> vec3<f32> {
    return vec3<f32>(0.0);
}
