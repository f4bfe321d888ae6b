// Simulates a shape. One thread for some samples of a pixel.

// Radiance along the ray through a point of the picture, -1 to 1 in both coordinates.
fn simulation_radiance(at: vec2<f32>) -> vec3<f32> {
    let through = kernel_inputs.target_point + at.x * kernel_inputs.right + at.y * kernel_inputs.up;
    let ray = normalize(through - kernel_inputs.eye);
    let hit = shape_hit(kernel_inputs.shape, kernel_inputs.eye, ray);
    if !hit.found {
        if kernel_inputs.environment_behind == 1.0 {
            return environment_radiance(ray);
        }
        return kernel_inputs.backdrop * (1.0 - 0.3 * min(dot(at, at), 2.0));
    }
    let material = bitcast<u32>(kernel_inputs.words[kernel_inputs.parts + hit.part].x);
    let place = hit.place;
    let frame = mat3x3<f32>(place.tangent, cross(place.normal, place.tangent), place.normal);
    let wo = -ray * frame;
    let header = simulation_header(material);
    // The second half of the materials has its slopes widened by the size of the lights.
    let widened = simulation_header(material + kernel_inputs.material_count);
    let ways = simulation_ways(header.x, header.y);
    var total = vec3<f32>(0.0);
    for (var k = 0u; k < ways; k++) {
        let way = simulation_way(ways, k);
        let path = simulation_path(header.x, header.y, way, vec3<f32>(0.0, 0.0, 1.0), wo, false);
        if simulation_brightest(path.weight) > 0.0 {
            total += path.weight * environment_radiance(frame * path.direction);
        }
        for (var i = 0u; i < kernel_inputs.light_count; i++) {
            let light = kernel_inputs.words[kernel_inputs.lights + 2u * i];
            let color = kernel_inputs.words[kernel_inputs.lights + 2u * i + 1u].rgb;
            // A directional light is 1 away.
            let to_light = select(light.xyz, light.xyz - place.position, light.w == 1.0);
            let distance_sq = dot(to_light, to_light);
            let wi = (to_light * inverseSqrt(distance_sq)) * frame;
            if wi.z > 0.0 {
                total += simulation_path(widened.x, widened.y, way, wi, wo, true).connected * color / distance_sq;
            }
        }
    }
    return total;
}

@compute @workgroup_size(8, 8)
fn kernel_simulate_picture(@builtin(global_invocation_id) thread: vec3<u32>) {
    let size = kernel_inputs.size;
    let index = thread.y * size + thread.x;
    if thread.x >= size || 2u * index >= arrayLength(&kernel_outputs) {
        return;
    }
    let pixel = vec2<u32>(thread.x, kernel_inputs.row + thread.y);
    let cells = kernel_inputs.samples;
    var sum = vec3<f32>(0.0);
    var squares = vec3<f32>(0.0);
    for (var i = 0u; i < kernel_inputs.sample_count; i++) {
        let sample = kernel_inputs.first_sample + i;
        // The word of the first direction is the seed here.
        simulation_begin(kernel_inputs.first_direction, pixel.y * size + pixel.x, sample);
        let cell = vec2<f32>(f32(sample % cells), f32(sample / cells % cells));
        let at = (vec2<f32>(pixel) + (cell + 0.5) / f32(cells)) / f32(size);
        let value = kernel_inputs.exposure * simulation_radiance(vec2<f32>(2.0 * at.x - 1.0, 1.0 - 2.0 * at.y));
        sum += value;
        squares += value * value;
    }
    kernel_outputs[2u * index] = vec4<f32>(sum, 0.0);
    kernel_outputs[2u * index + 1u] = vec4<f32>(squares, 0.0);
}
