/// Contents of a place of a surface.
struct LuthierPick {
    /// Number of the material.
    material: u32,
    /// Normal of the particle, unit: what `normal` of a `LuthierPlace` takes. +z where the surface is flat.
    normal: vec3<f32>,
}

/// One of some numbers, all as likely, by a random number of a cell.
fn luthier_chosen(cell: u32, count: u32) -> u32 {
    return (u32(luthier_unit(cell, 2u) * 16777216.0) * count) >> 24u;
}

/// Normal of a particle, uniform in solid angle. `most` is 1 - cos of the largest tilt: no cancellation in small tilts.
fn luthier_tilted(cell: u32, most: f32) -> vec3<f32> {
    let lack = luthier_unit(cell, 4u) * most;
    let phi = 2.0 * LUTHIER_PI * luthier_unit(cell, 5u);
    return vec3<f32>(sqrt(lack * (2.0 - lack)) * vec2<f32>(cos(phi), sin(phi)), 1.0 - lack);
}
