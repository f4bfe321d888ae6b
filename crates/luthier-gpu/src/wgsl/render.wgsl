// Renders a shape. One thread per pixel.

// Radiance along the ray through a point of the picture, -1 to 1 in both coordinates.
fn render_radiance(at: vec2<f32>, seed: u32) -> vec3<f32> {
    let through = kernel_inputs.target_point + at.x * kernel_inputs.right + at.y * kernel_inputs.up;
    let ray = normalize(through - kernel_inputs.eye);
    let hit = shape_hit(kernel_inputs.shape, kernel_inputs.eye, ray);
    if hit.found$shown {
        return shading_radiance(hit.part, hit.place, -ray, seed);
    }
    if kernel_inputs.first_direction > 0u {
        return vec3<f32>(0.0);
    }
    if kernel_inputs.environment_behind == 1.0 {
        return $behind_environment;
    }
    return $behind_plain;
}

@compute @workgroup_size(8, 8)
fn kernel_render(@builtin(global_invocation_id) thread: vec3<u32>) {
    let size = kernel_inputs.size;
    let index = thread.y * size + thread.x;
    if thread.x >= size || index >= arrayLength(&kernel_outputs) {
        return;
    }
    let pixel = vec2<f32>(f32(thread.x), f32(kernel_inputs.row + thread.y));
    let samples = kernel_inputs.samples;
    var sum = vec3<f32>(0.0);
    for (var i = 0u; i < kernel_inputs.sample_count; i++) {
        let sample = kernel_inputs.first_sample + i;
        let cell = vec2<f32>(f32(sample % samples), f32(sample / samples));
        let at = (pixel + (cell + 0.5) / f32(samples)) / f32(size);
        let seed = ((kernel_inputs.row + thread.y) * size + thread.x) * samples * samples + sample;
        sum += render_radiance(vec2<f32>(2.0 * at.x - 1.0, 1.0 - 2.0 * at.y), seed);
    }
    kernel_outputs[index] = vec4<f32>(sum * (kernel_inputs.exposure / f32(samples * samples)), 1.0);
}
