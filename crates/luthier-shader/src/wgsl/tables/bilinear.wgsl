/// Bilinear read of a texture that the hardware does not filter, at a position in texels with centres at i + 0.5.
fn luthier_bilinear(table: texture_2d<f32>, position: vec2<f32>) -> vec4<f32> {
    let corner = floor(position - 0.5);
    let weight = position - 0.5 - corner;
    let last = vec2<i32>(textureDimensions(table)) - 1;
    let near = clamp(vec2<i32>(corner), vec2<i32>(0), last);
    let far = min(near + 1, last);
    let top = mix(textureLoad(table, near, 0), textureLoad(table, vec2<i32>(far.x, near.y), 0), weight.x);
    let bottom = mix(textureLoad(table, vec2<i32>(near.x, far.y), 0), textureLoad(table, far, 0), weight.x);
    return mix(top, bottom, weight.y);
}
