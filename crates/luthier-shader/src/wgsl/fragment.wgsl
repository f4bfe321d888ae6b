@fragment
fn main(
    @location(0) wi: vec3<f32>,
    @location(1) wo: vec3<f32>,
    @location(2) @interpolate(flat) material: u32,
) -> @location(0) vec4<f32> {
    return vec4<f32>(luthier_bounded(luthier_eval(material, normalize(wi), normalize(wo))), 1.0);
}
