// Evaluates luthier_eval for one pair of directions per thread.

struct HarnessPair {
    wi: vec4<f32>,
    wo: vec4<f32>,
}

@group(1) @binding(0) var<storage, read> harness_pairs: array<HarnessPair>;
@group(1) @binding(1) var<storage, read_write> harness_values: array<vec4<f32>>;
@group(1) @binding(2) var<uniform> harness_material: vec4<u32>;

@compute @workgroup_size(64)
fn harness(@builtin(global_invocation_id) thread: vec3<u32>) {
    let pair = harness_pairs[thread.x];
    let value = luthier_eval(harness_material.x, pair.wi.xyz, pair.wo.xyz);
    harness_values[thread.x] = vec4<f32>(value, 0.0);
}
