/// A well-mixed word: PCG's output function after one step (Jarzynski and Olano 2020).
fn luthier_mix(x: u32) -> u32 {
    let state = x * 747796405u + 2891336453u;
    let word = ((state >> ((state >> 28u) + 4u)) ^ state) * 277803737u;
    return (word >> 22u) ^ word;
}

/// The word of a lattice cell.
fn luthier_cell(seed: u32, x: u32, y: u32) -> u32 {
    return luthier_mix(luthier_mix(luthier_mix(seed) + x) + y);
}

/// The number `index` of a cell, in 0..1.
fn luthier_unit(cell: u32, index: u32) -> f32 {
    return f32(luthier_mix(cell + index * 2654435769u) >> 8u) / 16777216.0;
}
