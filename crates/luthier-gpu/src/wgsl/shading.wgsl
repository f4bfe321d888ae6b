// What a place sends to the eye.

// One layer, in words: kind (0 dielectric, 1 conductor, 2 diffuse base), alpha, eta, first blurred map;
// Fresnel tile, FGD tile, film tile, fraction of the film's greatest thickness; optical depth, squared cotangent of the critical angle;
// albedo.
struct ShadingLayer {
    kind: f32,
    alpha: f32,
    eta: f32,
    chain: f32,
    fresnel_tile: f32,
    fgd_tile: f32,
    film_tile: f32,
    film_fraction: f32,
    optical_depth: vec3<f32>,
    critical_cot_sq: f32,
    albedo: vec3<f32>,
}

const SHADING_LAYER_WORDS: u32 = 4u;

// Mean cosine of light that reaches a patch evenly from its hemisphere.
const SHADING_MEAN_COSINE: f32 = 2.0 / 3.0;

// What the maps of a material say about a place.
struct ShadingMaps {
    uv: vec2<f32>,
    // Unit, in the frame of the shape.
    normal: vec3<f32>,
    roughness: f32,
    thickness: f32,
    patina: f32,
    flake: vec3<f32>,
    has_flakes: bool,
}

// What a part shows at a place: a material, and the normal of a particle.
struct ShadingPick {
    material: u32,
    normal: vec3<f32>,
}

// The same in numbers that do not hang on the shader.
struct ShadingFactors {
    normal: vec3<f32>,
    alpha: f32,
    slab: f32,
    film: f32,
    // Normal below the first interface, in the frame of `normal`.
    below: vec3<f32>,
    // Below 0: none.
    patina: f32,
}

// Texture coordinates of a map. `header.w` names the rows that make them of the surface's; 0: they are the same.
fn shading_map_uv(header: vec4<u32>, uv: vec2<f32>) -> vec2<f32> {
    if header.w == 0u {
        return uv;
    }
    let at = vec3<f32>(uv, 1.0);
    return vec2<f32>(dot(kernel_inputs.words[header.w].xyz, at), dot(kernel_inputs.words[header.w + 1u].xyz, at));
}

// Texel of a map that repeats. `header`: word offset, columns, rows, word of its transformation.
fn shading_texel(header: vec4<u32>, at: vec2<f32>) -> vec4<f32> {
    let size = vec2<f32>(header.yz);
    let wrapped = vec2<u32>(clamp(at - floor(at / size) * size, vec2<f32>(0.0), size - 1.0));
    return kernel_inputs.words[header.x + wrapped.y * header.y + wrapped.x];
}

fn shading_bilinear(header: vec4<u32>, uv: vec2<f32>) -> vec4<f32> {
    let position = fract(shading_map_uv(header, uv)) * vec2<f32>(header.yz) - 0.5;
    let corner = floor(position);
    let weight = position - corner;
    let above = mix(shading_texel(header, corner), shading_texel(header, corner + vec2<f32>(1.0, 0.0)), weight.x);
    let below = mix(shading_texel(header, corner + vec2<f32>(0.0, 1.0)), shading_texel(header, corner + 1.0), weight.x);
    return mix(above, below, weight.y);
}

fn shading_map_header(material: u32, slot: u32) -> vec4<u32> {
    let maps = bitcast<u32>(kernel_inputs.words[kernel_inputs.materials + material].z);
    return bitcast<vec4<u32>>(kernel_inputs.words[maps + slot]);
}

// The maps at a texture coordinate: filtered, but those of flakes are not.
fn shading_maps(material: u32, uv: vec2<f32>) -> ShadingMaps {
    var maps = ShadingMaps(uv, vec3<f32>(0.0, 0.0, 1.0), 1.0, 1.0, 0.5, vec3<f32>(0.0), false);
    let normal = shading_map_header(material, 0u);
    if normal.y > 0u {
        let n = 2.0 * shading_bilinear(normal, uv).xyz - 1.0;
        maps.normal = normalize(vec3<f32>(n.xy, max(n.z, 1e-3)));
    }
    let roughness = shading_map_header(material, 1u);
    if roughness.y > 0u {
        maps.roughness = shading_bilinear(roughness, uv).x;
    }
    let thickness = shading_map_header(material, 2u);
    if thickness.y > 0u {
        maps.thickness = shading_bilinear(thickness, uv).x;
    }
    let patina = shading_map_header(material, 3u);
    if patina.y > 0u {
        maps.patina = shading_bilinear(patina, uv).x;
    }
    let flakes = shading_map_header(material, 4u);
    if flakes.y > 0u {
        let tiling = luthier_materials[luthier_header(material) + 4u].w;
        maps.flake = 2.0 * shading_texel(flakes, floor(fract(shading_map_uv(flakes, uv * tiling)) * vec2<f32>(flakes.yz))).xyz - 1.0;
        maps.has_flakes = true;
    }
    return maps;
}

fn shading_layer_count(material: u32) -> u32 {
    return bitcast<u32>(kernel_inputs.words[kernel_inputs.materials + material].y);
}

fn shading_layer(material: u32, index: u32) -> ShadingLayer {
    let first = bitcast<u32>(kernel_inputs.words[kernel_inputs.materials + material].x);
    let at = first + index * SHADING_LAYER_WORDS;
    let head = kernel_inputs.words[at];
    let tiles = kernel_inputs.words[at + 1u];
    let slab = kernel_inputs.words[at + 2u];
    let base = kernel_inputs.words[at + 3u];
    return ShadingLayer(head.x, head.y, head.z, head.w, tiles.x, tiles.y, tiles.z, tiles.w, slab.xyz, slab.w, base.xyz);
}

// The frame whose +z is `n` (unit, in the frame): turned the shortest way, as luthier_eval_at does.
fn shading_turned_frame(frame: mat3x3<f32>, n: vec3<f32>) -> mat3x3<f32> {
    let a = 1.0 / (1.0 + max(n.z, 0.0));
    let shear = -n.x * n.y * a;
    return frame * mat3x3<f32>(vec3<f32>(1.0 - n.x * n.x * a, shear, -n.x), vec3<f32>(shear, 1.0 - n.y * n.y * a, -n.y), n);
}

// A direction mirrored at a facet of a GGX surface, or one by its cosine.
fn shading_sample(alpha: f32, u: vec2<f32>, wo: vec3<f32>) -> vec3<f32> {
    let phi = 2.0 * ENVIRONMENT_PI * u.y;
    let around = vec2<f32>(cos(phi), sin(phi));
    if alpha == 0.0 {
        return vec3<f32>(around * sqrt(u.x), sqrt(1.0 - u.x));
    }
    let tan_sq = alpha * alpha * u.x / max(1.0 - u.x, 1e-7);
    let wh = vec3<f32>(around * sqrt(tan_sq), 1.0) * inverseSqrt(1.0 + tan_sq);
    return reflect(-wo, wh);
}

fn shading_hash(x: u32) -> u32 {
    // PCG output function (Jarzynski and Olano 2020).
    let state = x * 747796405u + 2891336453u;
    let word = ((state >> ((state >> 28u) + 4u)) ^ state) * 277803737u;
    return (word >> 22u) ^ word;
}

fn shading_unit(x: u32) -> f32 {
    return f32(x >> 8u) * (1.0 / 16777216.0);
}

// Radiance along the ray that left the eye in the direction -wo_world.
fn shading_radiance(part: u32, place: Place, wo_world: vec3<f32>, seed: u32) -> vec3<f32> {
    let pick = shading_pick(bitcast<vec4<u32>>(kernel_inputs.words[kernel_inputs.parts + part]), place.uv);
    let material = pick.material;
    var maps = shading_maps(material, place.uv);
    if pick.normal.z < 1.0 {
        maps.normal = pick.normal;
    }
    let normal = place.normal;
    let frame = mat3x3<f32>(place.tangent, cross(normal, place.tangent)$sign, normal);
    let wo = wo_world * frame;
    let surface = shading_surface(material, maps, length(kernel_inputs.eye - place.position));
    var total = vec3<f32>(0.0);
    let light_count = select(0u, kernel_inputs.light_count, kernel_inputs.first_direction == 0u);
    for (var i = 0u; i < light_count; i++) {
        let light = kernel_inputs.words[kernel_inputs.lights + 2u * i];
        let color = kernel_inputs.words[kernel_inputs.lights + 2u * i + 1u].rgb;
        // A directional light is 1 away.
        let to_light = select(light.xyz, light.xyz - place.position, light.w == 1.0);
        let distance_sq = dot(to_light, to_light);
        let wi = (to_light * inverseSqrt(distance_sq)) * frame;
        // The second half of the materials has its slopes widened by the size of the lights.
        total += shading_lit(material + kernel_inputs.material_count, surface, wi, wo, color) / distance_sq$sees;
    }
    return total + shading_around(material, surface, frame, wo, seed$here);
}
