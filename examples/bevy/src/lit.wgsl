// The fragment shader around a bake: lights, shadows, fog and tone curve are those of Bevy. The text of the bake follows.

#import bevy_pbr::forward_io::VertexOutput
#import bevy_pbr::mesh_view_bindings::{clustered_lights, fog, lights, view}
#import bevy_pbr::mesh_view_types::{
    DIRECTIONAL_LIGHT_FLAGS_SHADOWS_ENABLED_BIT, POINT_LIGHT_FLAGS_SHADOWS_ENABLED_BIT, POINT_LIGHT_FLAGS_SPOT_LIGHT_Y_NEGATIVE,
}
#import bevy_pbr::clustered_forward as clustering
#import bevy_pbr::lighting::getDistanceAttenuation
#import bevy_pbr::mesh_bindings::mesh
#import bevy_pbr::mesh_types::MESH_FLAGS_SHADOW_RECEIVER_BIT
#import bevy_pbr::pbr_functions::apply_fog
#import bevy_pbr::shadows
#ifdef TONEMAP_IN_SHADER
#import bevy_core_pipeline::tonemapping::tone_mapping
#endif

const LUTHIER_MAPS: u32 = 8u;
// Kind of the normals of flakes.
const LUTHIER_CELLS: u32 = LUTHIER_CELLS_KINDu;

struct LuthierNumbers {
    material: u32,
    slope_variance: f32,
    has_environment: u32,
    base: vec4<f32>,
    kinds: array<vec4<u32>, LUTHIER_MAPS / 4u>,
    rows: array<mat3x3<f32>, LUTHIER_MAPS>,
    factors: array<vec4<f32>, LUTHIER_MAPS>,
}

@group(#{MATERIAL_BIND_GROUP}) @binding(16) var<uniform> luthier_numbers: LuthierNumbers;
@group(#{MATERIAL_BIND_GROUP}) @binding(17) var luthier_map_0: texture_2d<f32>;
@group(#{MATERIAL_BIND_GROUP}) @binding(18) var luthier_map_1: texture_2d<f32>;
@group(#{MATERIAL_BIND_GROUP}) @binding(19) var luthier_map_2: texture_2d<f32>;
@group(#{MATERIAL_BIND_GROUP}) @binding(20) var luthier_map_3: texture_2d<f32>;
@group(#{MATERIAL_BIND_GROUP}) @binding(21) var luthier_map_4: texture_2d<f32>;
@group(#{MATERIAL_BIND_GROUP}) @binding(22) var luthier_map_5: texture_2d<f32>;
@group(#{MATERIAL_BIND_GROUP}) @binding(23) var luthier_map_6: texture_2d<f32>;
@group(#{MATERIAL_BIND_GROUP}) @binding(24) var luthier_map_7: texture_2d<f32>;
@group(#{MATERIAL_BIND_GROUP}) @binding(25) var luthier_map_sampler: sampler;

var<private> luthier_here: LuthierPlace;
var<private> luthier_frame: mat3x3<f32>;
var<private> luthier_prepared: LuthierPrepared;

fn luthier_unit_normal(t: vec3<f32>) -> vec3<f32> {
    let n = 2.0 * t - 1.0;
    return normalize(vec3(n.xy, max(n.z, 0.001)));
}

// Slopes add up.
fn luthier_lean(own: vec3<f32>, film: vec3<f32>) -> vec3<f32> {
    return normalize(vec3(film.xy * own.z + own.xy * film.z, film.z * own.z));
}

// What the texel of a map says of the place; the new colour and metal.
fn luthier_texel(material: u32, kind: u32, distance: f32, t: vec3<f32>, old: vec4<f32>) -> vec4<f32> {
    var base = old;
    LUTHIER_TEXEL
    return base;
}

// Where a map is read: cells, as of flakes, at the centres of their texels, as without a filter.
fn luthier_at(kind: u32, row: u32, uv: vec2<f32>, size: vec2<u32>) -> vec2<f32> {
    let at = (luthier_numbers.rows[row] * vec3(uv, 1.0)).xy;
    let texels = vec2<f32>(size);
    return select(at, (floor(at * texels) + 0.5) / texels, kind == LUTHIER_CELLS);
}

// What the maps say of the place.
fn luthier_fill(material: u32, uv: vec2<f32>, distance: f32) {
    luthier_here = luthier_place();
    luthier_here.slope_variance = luthier_numbers.slope_variance;
    var base = luthier_numbers.base;
    LUTHIER_BEFORE
    LUTHIER_READS
    LUTHIER_AFTER
}

// Tangent, bitangent and normal; bitangents are against v. Without a tangent of the mesh it follows u.
fn luthier_make_frame(normal: vec3<f32>, given: vec4<f32>, position: vec3<f32>, uv: vec2<f32>) -> mat3x3<f32> {
    let p0 = dpdx(position);
    let p1 = dpdy(position);
    let t0 = dpdx(uv);
    let t1 = dpdy(uv);
    let e0 = cross(p1, normal);
    let e1 = cross(normal, p0);
    let side = select(1.0, -1.0, dot(p0, e0) < 0.0);
    var along = side * (e0 * t0.x + e1 * t1.x);
    var w = select(1.0, -1.0, side * dot(cross(normal, along), e0 * t0.y + e1 * t1.y) > 0.0);
    if (given.w != 0.0) {
        along = given.xyz;
        w = sign(given.w);
    }
    along -= normal * dot(normal, along);
    let across = cross(normal, select(vec3<f32>(1.0, 0.0, 0.0), vec3<f32>(0.0, 0.0, 1.0), abs(normal.x) > 0.9));
    let tangent = normalize(select(across, along, dot(along, along) > 1e-30));
    return mat3x3<f32>(tangent, cross(normal, tangent) * w, normal);
}

// Light of one lamp that goes to the eye.
fn luthier_lit(direction: vec3<f32>, color: vec3<f32>) -> vec3<f32> {
    if (all(color == vec3<f32>(0.0))) {
        return vec3<f32>(0.0);
    }
    LUTHIER_LIGHT
}

// Irradiance of a lamp in the scene, without shadows, and its direction.
struct LuthierLamp {
    direction: vec3<f32>,
    color: vec3<f32>,
}

fn luthier_lamp(id: u32, position: vec3<f32>) -> LuthierLamp {
    let light = &clustered_lights.data[id];
    let to_light = (*light).position_radius.xyz - position;
    let falloff = getDistanceAttenuation(dot(to_light, to_light), (*light).color_inverse_square_range.w);
    return LuthierLamp(normalize(to_light), (*light).color_inverse_square_range.rgb * falloff);
}

// How much of a spot's light goes in a direction.
fn luthier_cone(id: u32, direction: vec3<f32>) -> f32 {
    let light = &clustered_lights.data[id];
    let custom = (*light).light_custom_data;
    var axis = vec3<f32>(custom.x, sqrt(max(0.0, 1.0 - custom.x * custom.x - custom.y * custom.y)), custom.y);
    if (((*light).flags & POINT_LIGHT_FLAGS_SPOT_LIGHT_Y_NEGATIVE) != 0u) {
        axis.y = -axis.y;
    }
    let inside = saturate(dot(-axis, direction) * custom.z + custom.w);
    return inside * inside;
}

@fragment
fn fragment(in: VertexOutput, @builtin(front_facing) is_front: bool) -> @location(0) vec4<f32> {
    let position = in.world_position;
    let is_orthographic = view.clip_from_view[3].w == 1.0;
    let to_eye = view.world_position - position.xyz;
    let wo = select(normalize(to_eye), normalize(view.world_from_view[2].xyz), is_orthographic);
    let facing = normalize(in.world_normal) * select(-1.0, 1.0, is_front);
    // No normal is seen from behind.
    let normal = normalize(facing + max(0.02 - dot(facing, wo), 0.0) * wo);
#ifdef VERTEX_UVS_A
    let uv = in.uv;
#else
    let uv = vec2<f32>(0.0);
#endif
#ifdef VERTEX_TANGENTS
    let tangent = in.world_tangent;
#else
    let tangent = vec4<f32>(0.0);
#endif
#ifdef VERTEX_OUTPUT_INSTANCE_INDEX
    let receives = (mesh[in.instance_index].flags & MESH_FLAGS_SHADOW_RECEIVER_BIT) != 0u;
#else
    let receives = true;
#endif

    let material = luthier_numbers.material;
    luthier_frame = luthier_make_frame(normal, tangent, -to_eye, uv);
    luthier_fill(material, uv, length(to_eye));
    luthier_prepared = luthier_prepare_at(luthier_here, material, wo * luthier_frame);

    var radiance = vec3<f32>(0.0);
    let view_z = dot(vec4<f32>(view.view_from_world[0].z, view.view_from_world[1].z, view.view_from_world[2].z, view.view_from_world[3].z), position);
    let cluster = clustering::view_fragment_cluster_index(in.position.xy, view_z, is_orthographic);
    let ranges = clustering::unpack_clusterable_object_index_ranges(cluster);
    for (var i = ranges.first_point_light_index_offset; i < ranges.first_reflection_probe_index_offset; i++) {
        let id = clustering::get_clusterable_object_id(i);
        var lamp = luthier_lamp(id, position.xyz);
        let casts = receives && (clustered_lights.data[id].flags & POINT_LIGHT_FLAGS_SHADOWS_ENABLED_BIT) != 0u;
        if (i < ranges.first_spot_light_index_offset) {
            if (casts) {
                lamp.color *= shadows::fetch_point_shadow(id, position, facing, in.position.xy);
            }
        } else {
            lamp.color *= luthier_cone(id, lamp.direction);
            if (casts) {
                lamp.color *= shadows::fetch_spot_shadow(id, position, facing, clustered_lights.data[id].shadow_map_near_z, in.position.xy);
            }
        }
        radiance += luthier_lit(lamp.direction, lamp.color);
    }
    for (var i = 0u; i < lights.n_directional_lights; i++) {
        let light = &lights.directional_lights[i];
        var color = (*light).color.rgb;
        if (receives && ((*light).flags & DIRECTIONAL_LIGHT_FLAGS_SHADOWS_ENABLED_BIT) != 0u) {
            color *= shadows::fetch_directional_shadow(i, position, facing, view_z, in.position.xy);
        }
        radiance += luthier_lit((*light).direction_to_light, color);
    }
    LUTHIER_AROUND

    // Bevy's picture is of half floats.
    var color = vec4<f32>(luthier_bounded(radiance * view.exposure), 1.0);
#ifdef DISTANCE_FOG
    color = apply_fog(fog, color, position.xyz, view.world_position, in.position.xy);
#endif
#ifdef TONEMAP_IN_SHADER
    color = tone_mapping(color, view.color_grading);
#endif
    return color;
}
