// Random numbers as a function of a seed, a place, a sample and a count.

const SIMULATION_PI: f32 = 3.14159265358979;

// Seed, place and sample of the walk of this thread.
var<private> simulation_key: vec3<u32>;
// Draws so far.
var<private> simulation_count: u32;

fn simulation_begin(seed: u32, place: u32, sample: u32) {
    simulation_key = vec3<u32>(seed, place, sample);
    simulation_count = 0u;
}

// Four numbers uniform in 0..1, 1 excluded: the hash pcg4d of Jarzynski and Olano 2020.
fn simulation_draw() -> vec4<f32> {
    var v = vec4<u32>(simulation_key, simulation_count) * 1664525u + 1013904223u;
    simulation_count += 1u;
    v.x += v.y * v.w;
    v.y += v.z * v.x;
    v.z += v.x * v.y;
    v.w += v.y * v.z;
    v ^= v >> vec4<u32>(16u);
    v.x += v.y * v.w;
    v.y += v.z * v.x;
    v.z += v.x * v.y;
    v.w += v.y * v.z;
    return vec4<f32>(v >> vec4<u32>(8u)) * (1.0 / 16777216.0);
}
