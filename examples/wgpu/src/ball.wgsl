// Follows the text of the bake, which declares luthier_eval, and surroundings.wgsl or no_surroundings.wgsl.

struct Light {
    /// To the light, unit.
    direction: vec4<f32>,
    /// Of a surface that faces the light.
    irradiance: vec4<f32>,
}

struct Scene {
    focal: f32,
    eye_distance: f32,
    material: u32,
    light_count: u32,
    lights: array<Light, 4>,
}

@group(1) @binding(0) var<uniform> scene: Scene;

struct Varying {
    @builtin(position) clip: vec4<f32>,
    @location(0) position: vec3<f32>,
    @location(1) normal: vec3<f32>,
}

@vertex
fn ball_vertex(@location(0) position: vec3<f32>) -> Varying {
    // One convex shape without its back faces needs no depth.
    let depth = scene.eye_distance - position.z;
    let clip = vec4<f32>(scene.focal * position.xy, 0.0, depth);
    return Varying(clip, position, position);
}

@fragment
fn ball_fragment(in: Varying) -> @location(0) vec4<f32> {
    // The local frame: +z is the normal, x runs along the parallels of the ball.
    let normal = normalize(in.normal);
    let pole = abs(normal.y) > 0.9999;
    let tangent = normalize(cross(select(vec3<f32>(0.0, 1.0, 0.0), vec3<f32>(1.0, 0.0, 0.0), pole), normal));
    let frame = mat3x3<f32>(tangent, cross(normal, tangent), normal);

    // A vector times a matrix is the transposed matrix times the vector: from the world into the frame.
    let wo = normalize(vec3<f32>(0.0, 0.0, scene.eye_distance) - in.position) * frame;
    var radiance = ball_surroundings(scene.material, wo, frame);
    for (var i = 0u; i < scene.light_count; i++) {
        let wi = scene.lights[i].direction.xyz * frame;
        radiance += scene.lights[i].irradiance.rgb * luthier_eval(scene.material, wi, wo);
    }
    return vec4<f32>(luthier_bounded(radiance), 1.0);
}
