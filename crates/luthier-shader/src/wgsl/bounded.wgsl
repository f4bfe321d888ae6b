/// A sum over lights, clamped to what a picture of half floats holds, 0 to 65504. Highlights at grazing angles go beyond, colours outside
/// of Rec.709 have channels below 0: bound the sum, not its terms.
fn luthier_bounded(radiance: vec3<f32>) -> vec3<f32> {
    return clamp(radiance, vec3<f32>(0.0), vec3<f32>(65504.0));
}
