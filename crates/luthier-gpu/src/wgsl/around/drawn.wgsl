// The environment by directions that the shader draws for the place.

// As many directions as the material has lobes, the cosine counted, times what was asked for. Points of a cube: equal steps, which lead from lobe to
// lobe, and the plastic sequence for the directions of each (Roberts 2018), shifted by the seed.
fn shading_around(material: u32, surface: ShadingSurface, frame: mat3x3<f32>, wo: vec3<f32>, seed: u32$place) -> vec3<f32> {
    let lobes = shading_layer_count(material) + 1u;
    let count = lobes * kernel_inputs.environment_samples;
    let prepared = $prepared;
    let first = shading_hash(seed);
    let second = shading_hash(first);
    let shift = vec3<f32>(shading_unit(first), shading_unit(second), shading_unit(shading_hash(second)));
    var total = vec3<f32>(0.0);
    let end = lobes * (kernel_inputs.first_direction + kernel_inputs.direction_count);
    for (var i = lobes * kernel_inputs.first_direction; i < end; i++) {
        let point = vec3<f32>((f32(i) + 0.5) / f32(count), shading_unit(i * 3242174889u), shading_unit(i * 2447445414u));
        let drawn = luthier_sample(prepared, min(fract(point + shift), vec3<f32>(0.99999994)));
        if drawn.pdf > 0.0 {
            let wi = drawn.wi;
            total += $reflected;
        }
    }
    return total / f32(count);
}
