/// Linear read along a row of a texture, at a position in texels with centres at i + 0.5. Rows beside it are no neighbours: a sampler,
/// which rounds positions, would mix them in.
fn luthier_along(table: texture_2d<f32>, position: vec2<f32>) -> vec4<f32> {
    let corner = floor(position.x - 0.5);
    let near = vec2<i32>(vec2<f32>(corner, position.y));
    let far = vec2<i32>(min(near.x + 1, i32(textureDimensions(table).x) - 1), near.y);
    return mix(textureLoad(table, near, 0), textureLoad(table, far, 0), position.x - 0.5 - corner);
}
