/// Four values of a texel with its steps, part of the way to the next texel.
fn luthier_stepped(texel: vec4<u32>, way: f32) -> vec4<f32> {
    let value = vec4<f32>(unpack2x16float(texel.x), unpack2x16float(texel.y));
    let step = vec4<f32>(unpack2x16float(texel.z), unpack2x16float(texel.w));
    return value + way * step;
}
