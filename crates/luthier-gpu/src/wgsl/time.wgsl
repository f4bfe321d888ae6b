// Evaluates a material for many pairs of directions per thread, so that the evaluations outweigh the traffic of memory.

struct KernelPair {
    wi: vec3<f32>,
    material: u32,
    wo: vec3<f32>,
    // Threads in a row that share a material, where threads have several.
    run: u32,
}

@group(1) @binding(0) var<storage, read> kernel_inputs: array<KernelPair>;
@group(1) @binding(1) var<storage, read_write> kernel_outputs: array<vec4<f32>>;

// Stands in for evaluations where the harness alone is timed.
fn kernel_empty(material: u32, wi: vec3<f32>, wo: vec3<f32>) -> vec3<f32> {
    return wi * wo;
}

@compute @workgroup_size(64)
fn kernel_time(@builtin(global_invocation_id) thread: vec3<u32>) {
    let i = thread.x;
    if i >= arrayLength(&kernel_outputs) {
        return;
    }
    let count = arrayLength(&kernel_inputs);
    let material = kernel_inputs[$material].material;
    var sum = vec3<f32>(0.0);
    for (var k = 0u; k < 16u; k += $lightsu) {
        let pair = kernel_inputs[(i + 97u * k) % count];
$views    }
    kernel_outputs[i] = vec4<f32>(sum, 0.0);
}
