// A pixel shader of shader model 5.1: glslangValidator -D -V -S frag -e main -IBAKE/shaders ball.hlsl -o ball.spv
// Or, untested: dxc -T ps_6_0 -E main -I BAKE/shaders ball.hlsl; fxc /T ps_5_1 /I BAKE\shaders ball.hlsl
// space0 is that of the bake: textures t0 to t9, the sampler s5, the materials t6 as a raw buffer. The rest is in space1.
#include "baked.hlsl"

struct Light {
    float4 to_light;    // unit
    float4 irradiance;  // of a surface that faces the light
};
cbuffer Scene : register(b0, space1) {
    float4 eye;
    uint material;
    uint light_count;
    Light lights[4];
};

struct Varying {
    float4 clip : SV_Position;
    float3 position : POSITION;
    float3 normal : NORMAL;
    float3 tangent : TANGENT;
};

float4 main(Varying varying) : SV_Target0 {
    // The local frame: +z is the normal, +x the tangent. HLSL takes the three vectors as rows.
    float3 normal = normalize(varying.normal);
    float3 tangent = normalize(varying.tangent - normal * dot(normal, varying.tangent));
    float3x3 frame = float3x3(tangent, cross(normal, tangent), normal);

    // With rows, the matrix times the vector goes from the world into the frame.
    float3 wo = mul(frame, normalize(eye.xyz - varying.position));
    float3 radiance = float3(0.0, 0.0, 0.0);
    for (uint i = 0u; i < min(light_count, 4u); i++) {
        float3 wi = mul(frame, lights[i].to_light.xyz);
        radiance += lights[i].irradiance.rgb * luthier_eval(material, wi, wo);
    }
    // The target is sRGB or half floats: no transfer function here.
    return float4(luthier_bounded(radiance), 1.0);
}
