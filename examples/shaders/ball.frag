// A fragment shader for Vulkan: glslangValidator -V -IBAKE/shaders ball.frag -o ball.spv
#version 450
#extension GL_GOOGLE_include_directive : require

// Set 0 is that of the bake: combined image samplers and storage buffers, with the numbers of `bindings[]` of the manifest.
#include "baked.450.glsl"

struct Light {
    vec4 to_light;    // unit
    vec4 irradiance;  // of a surface that faces the light
};
layout(set = 1, binding = 0, std140) uniform Scene {
    vec4 eye;
    uint material;
    uint light_count;
    Light lights[4];
} scene;

layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal_of_vertex;
layout(location = 2) in vec3 tangent_of_vertex;
layout(location = 0) out vec4 color;

void main() {
    // The local frame: +z is the normal, +x the tangent.
    vec3 normal = normalize(normal_of_vertex);
    vec3 tangent = normalize(tangent_of_vertex - normal * dot(normal, tangent_of_vertex));
    mat3 frame = mat3(tangent, cross(normal, tangent), normal);

    // A vector times a matrix is the transposed matrix times the vector: from the world into the frame.
    vec3 wo = normalize(scene.eye.xyz - position) * frame;
    vec3 radiance = vec3(0.0);
    for (uint i = 0u; i < min(scene.light_count, 4u); i++) {
        vec3 wi = scene.lights[i].to_light.xyz * frame;
        radiance += scene.lights[i].irradiance.rgb * luthier_eval(scene.material, wi, wo);
    }
    // The attachment is sRGB or half floats: no transfer function here.
    color = vec4(luthier_bounded(radiance), 1.0);
}
