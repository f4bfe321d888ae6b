// Evaluates luthier_eval for pairs of directions.

struct KernelPair {
    wi: vec3<f32>,
    material: u32,
    wo: vec3<f32>,
}

@group(1) @binding(0) var<storage, read> kernel_inputs: array<KernelPair>;
@group(1) @binding(1) var<storage, read_write> kernel_outputs: array<vec4<f32>>;

@compute @workgroup_size(64)
fn kernel_evaluate(@builtin(global_invocation_id) thread: vec3<u32>) {
    let i = thread.x;
    if i >= arrayLength(&kernel_outputs) {
        return;
    }
    let pair = kernel_inputs[i];
    kernel_outputs[i] = vec4<f32>(luthier_eval(pair.material, pair.wi, pair.wo), 0.0);
}
