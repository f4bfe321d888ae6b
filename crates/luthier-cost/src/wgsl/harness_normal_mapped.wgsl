// luthier_eval as a pixel shader with a normal map and a reflected environment has it. What would be interpolated is made from
// the number of the thread, by one instruction per component.

@group(1) @binding(0) var<storage, read_write> harness_values: array<vec4<f32>>;
@group(1) @binding(1) var<uniform> harness_material: vec4<u32>;
@group(1) @binding(2) var harness_normals: texture_2d<f32>;
@group(1) @binding(3) var harness_environment: texture_cube<f32>;
@group(1) @binding(4) var harness_sampler: sampler;

@compute @workgroup_size(64)
fn harness(@builtin(global_invocation_id) thread: vec3<u32>) {
    // To the light and to the eye in the frame of the tangents, and that frame in the world.
    let light = normalize(bitcast<vec3<f32>>(thread.xxx ^ vec3<u32>(0x3eaaaaabu, 0x3ecccccdu, 0x3f19999au)));
    let eye = normalize(bitcast<vec3<f32>>(thread.xxx ^ vec3<u32>(0x3dcccccdu, 0x3f0ccccdu, 0x3f333333u)));
    let uv = bitcast<vec2<f32>>(thread.xx ^ vec2<u32>(0x3e4ccccdu, 0x3e99999au));
    let tangent = bitcast<vec3<f32>>(thread.xxx ^ vec3<u32>(0x3f666666u, 0x3d4ccccdu, 0x3e19999au));
    let bitangent = bitcast<vec3<f32>>(thread.xxx ^ vec3<u32>(0x3d8f5c29u, 0x3f5eb852u, 0x3e051eb8u));
    let normal = bitcast<vec3<f32>>(thread.xxx ^ vec3<u32>(0x3db851ecu, 0x3dae147bu, 0x3f70a3d7u));

    // The mapped normal, and a frame about it.
    let bump = normalize(textureSampleLevel(harness_normals, harness_sampler, uv, 0.0).xyz * 2.0 - 1.0);
    let across = normalize(vec3<f32>(bump.z, 0.0, -bump.x));
    let along = cross(bump, across);
    let wi = vec3<f32>(dot(light, across), dot(light, along), dot(light, bump));
    let wo = vec3<f32>(dot(eye, across), dot(eye, along), dot(eye, bump));
    let value = luthier_eval(harness_material.x, wi, wo);

    let mirrored = 2.0 * dot(eye, bump) * bump - eye;
    let there = mirrored.x * tangent + mirrored.y * bitangent + mirrored.z * normal;
    let environment = textureSampleLevel(harness_environment, harness_sampler, there, 0.0).rgb;
    harness_values[thread.x] = vec4<f32>(value + 0.5 * environment, 0.0);
}
