/// A direction in a frame whose normal is `normal` (unit, in the frame of the direction): the least rotation that takes +z
/// there is undone.
fn luthier_local(normal: vec3<f32>, w: vec3<f32>) -> vec3<f32> {
    let across = w.x * normal.x + w.y * normal.y;
    let along = w.z + across / (1.0 + max(normal.z, 0.0));
    return vec3<f32>(w.xy - normal.xy * along, across + w.z * normal.z);
}
