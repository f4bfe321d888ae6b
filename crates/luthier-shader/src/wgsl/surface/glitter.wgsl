/// The word of the Voronoi cell at a place, one random point per square of a lattice (Worley 1996). Exact: the nearest point
/// is in one of the 25 squares around.
fn luthier_voronoi(seed: u32, p: vec2<f32>) -> u32 {
    let corner = floor(p);
    var nearest = 0u;
    var least = 1e30;
    for (var k = 0; k < 25; k++) {
        let square = corner + vec2<f32>(f32(k % 5 - 2), f32(k / 5 - 2));
        let word = luthier_cell(seed, u32(i32(square.x)), u32(i32(square.y)));
        let apart = square - p + vec2<f32>(luthier_unit(word, 0u), luthier_unit(word, 1u));
        let distance_sq = dot(apart, apart);
        if distance_sq < least {
            nearest = word;
            least = distance_sq;
        }
    }
    return nearest;
}

//? glitter
/// Normal of the particle at a texture coordinate, unit: a share of the cells is tilted (Weidlich and Wilkie 2009, section
/// 5.2.1). +z elsewhere and for a material without glitter.
fn luthier_glitter_normal(material: u32, uv: vec2<f32>) -> vec3<f32> {
    let shape = luthier_materials[luthier_header(material) + $word_glitter_cells];
    let cell = luthier_voronoi(u32(shape.x) + u32(shape.y) * 65536u, uv * shape.z);
    if luthier_unit(cell, 3u) >= shape.w {
        return vec3<f32>(0.0, 0.0, 1.0);
    }
    // 1 - cos: no cancellation in small tilts.
    let lack = luthier_unit(cell, 4u) * luthier_materials[luthier_header(material) + $word_glitter_tilt].x;
    let phi = 2.0 * LUTHIER_PI * luthier_unit(cell, 5u);
    return vec3<f32>(sqrt(lack * (2.0 - lack)) * vec2<f32>(cos(phi), sin(phi)), 1.0 - lack);
}
