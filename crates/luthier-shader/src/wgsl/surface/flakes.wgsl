/// Normal of the flake at a texture coordinate, unit: one per cell of a grid (Elek 2010, section 4.1).
fn luthier_flake(material: u32, uv: vec2<f32>) -> vec3<f32> {
    let grid = luthier_materials[luthier_header(material) + $word_flakes_grid];
    let spread = luthier_materials[luthier_header(material) + $word_flakes_shape].x;
    let at = clamp(floor(fract(uv * grid.w) * grid.z), vec2<f32>(0.0), vec2<f32>(max(grid.z - 1.0, 0.0)));
    let cell = luthier_cell(u32(grid.x) + u32(grid.y) * 65536u, u32(at.x), u32(at.y));
    // Box and Muller.
    let radius = sqrt(-2.0 * log(1.0 - luthier_unit(cell, 0u)));
    let normal_number = radius * cos(2.0 * LUTHIER_PI * luthier_unit(cell, 1u));
    let angle = clamp(spread * normal_number, -0.5 * LUTHIER_PI, 0.5 * LUTHIER_PI);
    let phi = LUTHIER_PI * luthier_unit(cell, 2u);
    return vec3<f32>(sin(angle) * vec2<f32>(cos(phi), sin(phi)), max(cos(angle), 0.0));
}

/// `LuthierPlace::flake_normal` for a flake's normal, seen from a distance: normalize(z + max(distance / fade_start, 1) z + scale m).
fn luthier_flake_tilt(material: u32, flake: vec3<f32>, distance: f32) -> vec3<f32> {
    let shape = luthier_materials[luthier_header(material) + $word_flakes_shape];
    let up = vec3<f32>(0.0, 0.0, 1.0);
    if shape.z <= 0.0 {
        return up;
    }
    let sum = (1.0 + max(distance / shape.z, 1.0)) * up + shape.y * flake;
    let length_sq = dot(sum, sum);
    return select(up, sum * inverseSqrt(max(length_sq, 1e-12)), length_sq > 1e-12);
}

/// `LuthierPlace::flake_normal` of a material whose flakes are a grid of cells; those of a normal map go through
/// `luthier_flake_tilt` as 2 texel - 1. +z for other materials.
fn luthier_flake_normal(material: u32, uv: vec2<f32>, distance: f32) -> vec3<f32> {
    if luthier_materials[luthier_header(material) + $word_flakes_grid].z < 0.5 {
        return vec3<f32>(0.0, 0.0, 1.0);
    }
    return luthier_flake_tilt(material, luthier_flake(material, uv), distance);
}
