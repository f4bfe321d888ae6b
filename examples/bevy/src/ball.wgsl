// The text of the bake follows: luthier_eval is declared there.

#import bevy_pbr::forward_io::VertexOutput
#import bevy_pbr::mesh_view_bindings::{lights, view}

@group(#{MATERIAL_BIND_GROUP}) @binding(16) var<uniform> material: u32;

@fragment
fn fragment(in: VertexOutput) -> @location(0) vec4<f32> {
    // The local frame: +z is the normal, x runs along the parallels of the ball.
    let normal = normalize(in.world_normal);
    let pole = abs(normal.y) > 0.9999;
    let tangent = normalize(cross(select(vec3<f32>(0.0, 1.0, 0.0), vec3<f32>(1.0, 0.0, 0.0), pole), normal));
    let frame = mat3x3<f32>(tangent, cross(normal, tangent), normal);

    // A vector times a matrix is the transposed matrix times the vector: from the world into the frame.
    let wo = normalize(view.world_position - in.world_position.xyz) * frame;
    var radiance = vec3<f32>(0.0);
    for (var i = 0u; i < lights.n_directional_lights; i++) {
        let wi = lights.directional_lights[i].direction_to_light * frame;
        radiance += lights.directional_lights[i].color.rgb * luthier_eval(material, wi, wo);
    }
    // Bevy's picture is of half floats.
    return vec4<f32>(luthier_bounded(radiance * view.exposure), 1.0);
}
