// Evaluates luthier_eval_at for pairs of directions, each at a place of its own.

// A pair takes so many words: eight, and three for each layer that has textures.
const KERNEL_WORDS: u32 = $words;

@group(1) @binding(0) var<storage, read> kernel_inputs: array<vec4<f32>>;
@group(1) @binding(1) var<storage, read_write> kernel_outputs: array<vec4<f32>>;

fn kernel_place(material: u32, first: u32) -> LuthierPlace {
    var place = luthier_place();
    place.normal = kernel_inputs[first + 2u].xyz;
    place.alpha_factor = kernel_inputs[first + 2u].w;
    place.slab_factor = kernel_inputs[first + 3u].w;
    place.film_factor = kernel_inputs[first + 4u].w;
    $fill
    return place;
}

@compute @workgroup_size(64)
fn kernel_evaluate_at(@builtin(global_invocation_id) thread: vec3<u32>) {
    let i = thread.x;
    if i >= arrayLength(&kernel_outputs) {
        return;
    }
    let first = KERNEL_WORDS * i;
    let material = u32(kernel_inputs[first].w);
    let place = kernel_place(material, first);
    kernel_outputs[i] = vec4<f32>(luthier_eval_at(place, material, kernel_inputs[first].xyz, kernel_inputs[first + 1u].xyz), 0.0);
}
