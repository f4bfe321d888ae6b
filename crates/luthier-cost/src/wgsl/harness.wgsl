// Evaluates luthier_eval for one pair of directions per thread. The directions are made from the number of the thread by one
// instruction per component, which no compiler can see through: loads would put their latency in the place of the shader's cost.

@group(1) @binding(0) var<storage, read_write> harness_values: array<vec4<f32>>;
@group(1) @binding(1) var<uniform> harness_material: vec4<u32>;

@compute @workgroup_size(64)
fn harness(@builtin(global_invocation_id) thread: vec3<u32>) {
    let wi = bitcast<vec3<f32>>(thread.xxx ^ vec3<u32>(0x3eaaaaabu, 0x3ecccccdu, 0x3f19999au));
    let wo = bitcast<vec3<f32>>(thread.xxx ^ vec3<u32>(0x3dcccccdu, 0x3f0ccccdu, 0x3f333333u));
    let value = luthier_eval(harness_material.x, wi, wo);
    harness_values[thread.x] = vec4<f32>(value, 0.0);
}
