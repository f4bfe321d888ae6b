// f cos_theta_i of pairs of directions. One thread for some samples of a pair.

struct SimulationPair {
    wi: vec3<f32>,
    wo: vec3<f32>,
}

struct SimulationPairs {
    material: u32,
    seed: u32,
    first_sample: u32,
    // Of a thread.
    samples: u32,
    pairs: array<SimulationPair>,
}

@group(1) @binding(0) var<storage, read> kernel_inputs: SimulationPairs;
// Sums, and sums of squares.
@group(1) @binding(1) var<storage, read_write> kernel_outputs: array<vec4<f32>>;

@compute @workgroup_size(64)
fn kernel_simulate_pairs(@builtin(global_invocation_id) thread: vec3<u32>) {
    if 2u * thread.x >= arrayLength(&kernel_outputs) {
        return;
    }
    let count = arrayLength(&kernel_inputs.pairs);
    let number = thread.x % count;
    let pair = kernel_inputs.pairs[number];
    let first_sample = kernel_inputs.first_sample + thread.x / count * kernel_inputs.samples;
    let header = simulation_header(kernel_inputs.material);
    let ways = simulation_ways(header.x, header.y);
    var sum = vec3<f32>(0.0);
    var squares = vec3<f32>(0.0);
    for (var i = 0u; i < kernel_inputs.samples; i++) {
        simulation_begin(kernel_inputs.seed, number, first_sample + i);
        var value = vec3<f32>(0.0);
        for (var k = 0u; k < ways; k++) {
            value += simulation_path(header.x, header.y, simulation_way(ways, k), pair.wi, pair.wo, true).connected;
        }
        sum += value;
        squares += value * value;
    }
    kernel_outputs[2u * thread.x] = vec4<f32>(sum, 0.0);
    kernel_outputs[2u * thread.x + 1u] = vec4<f32>(squares, 0.0);
}
