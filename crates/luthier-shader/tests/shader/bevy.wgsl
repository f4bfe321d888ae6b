struct VertexOutput {
    @builtin(position) position: vec4<f32>,
    @location(0) world_position: vec4<f32>,
    @location(1) world_normal: vec3<f32>,
}

struct DirectionalLight {
    color: vec4<f32>,
    direction_to_light: vec3<f32>,
}

struct Lights {
    directional_lights: array<DirectionalLight, 10>,
    n_directional_lights: u32,
}

struct View {
    world_position: vec3<f32>,
    exposure: f32,
}

@group(0) @binding(0) var<uniform> view: View;
@group(0) @binding(1) var<uniform> lights: Lights;
