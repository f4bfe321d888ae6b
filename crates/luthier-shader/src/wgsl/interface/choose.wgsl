/// Channel by channel, the second value where a condition holds, and the first where it does not. HLSL 2021 has no conditions of three channels.
fn luthier_choose(first: vec3<f32>, second: vec3<f32>, holds: vec3<bool>) -> vec3<f32> {
    return vec3<f32>(
        select(first.x, second.x, holds.x),
        select(first.y, second.y, holds.y),
        select(first.z, second.z, holds.z),
    );
}
