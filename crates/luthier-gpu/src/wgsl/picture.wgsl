// What a picture is made of.

struct Render {
    eye: vec3<f32>,
    exposure: f32,
    target_point: vec3<f32>,
    // 1 where the environment is seen behind the shape.
    environment_behind: f32,
    // Half the picture, in the plane through the target.
    right: vec3<f32>,
    up: vec3<f32>,
    backdrop: vec3<f32>,
    size: u32,
    samples: u32,
    // First row of this dispatch.
    row: u32,
    shape: u32,
    // Directions per lobe and sample; 0 reads blurred maps instead.
    environment_samples: u32,
    light_count: u32,
    material_count: u32,
    // Where in `words` things begin.
    parts: u32,
    lights: u32,
    materials: u32,
    maps: u32,
    // Slopes of the inner boundary of films against the outer one, beside those of a thickness table.
    film_tilt: vec2<f32>,
    // What this dispatch adds: samples of a pixel, and directions of the environment for each of these. Lights come with the first direction.
    first_sample: u32,
    sample_count: u32,
    first_direction: u32,
    direction_count: u32,
    words: array<vec4<f32>>,
}

@group(1) @binding(0) var<storage, read> kernel_inputs: Render;
@group(1) @binding(1) var<storage, read_write> kernel_outputs: array<vec4<f32>>;
