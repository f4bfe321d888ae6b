// Reads a table at given axis values: `tile` first, then the arguments of the look-up. KERNEL_LOOKUP stands for the
// call.

@group(1) @binding(0) var<storage, read> kernel_inputs: array<vec4<f32>>;
@group(1) @binding(1) var<storage, read_write> kernel_outputs: array<vec4<f32>>;

@compute @workgroup_size(64)
fn kernel_lookup(@builtin(global_invocation_id) thread: vec3<u32>) {
    let i = thread.x;
    if i >= arrayLength(&kernel_outputs) {
        return;
    }
    let at = kernel_inputs[i];
    kernel_outputs[i] = KERNEL_LOOKUP;
}
