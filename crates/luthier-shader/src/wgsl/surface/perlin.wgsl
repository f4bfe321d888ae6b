/// Rise from a lattice point to a place: its gradient is one of eight, 45 degrees apart and of length sqrt(2).
fn luthier_rise(seed: u32, square: vec2<f32>, offset: vec2<f32>) -> f32 {
    let word = luthier_cell(seed, u32(i32(square.x)), u32(i32(square.y)));
    let turn = u32(luthier_unit(word, 0u) * 8.0);
    let signs = vec2<f32>(select(-1.0, 1.0, (turn & 2u) != 0u), select(-1.0, 1.0, (turn & 4u) != 0u));
    if (turn & 1u) == 0u {
        return dot(signs, offset);
    }
    return 1.4142135 * signs.y * select(offset.x, offset.y, (turn & 2u) != 0u);
}

/// The blend of the rises from the two lattice points of a row of a square.
fn luthier_across(seed: u32, corner: vec2<f32>, t: vec2<f32>, blend: f32, row: f32) -> f32 {
    let left = vec2<f32>(0.0, row);
    let right = vec2<f32>(1.0, row);
    let a = luthier_rise(seed, corner + left, t - left);
    let b = luthier_rise(seed, corner + right, t - right);
    return a + (b - a) * blend;
}

/// Perlin's noise (Perlin 2002, in the plane), summed over octaves of twice the frequency and half the weight: mean 0, within -1..=1. `p`
/// is in lattice cells of the first.
fn luthier_perlin(seed: u32, p: vec2<f32>, octaves: u32) -> f32 {
    var place = p;
    var amplitude = 1.0;
    var sum = 0.0;
    var total = 0.0;
    for (var octave = 0u; octave < octaves; octave++) {
        let corner = floor(place);
        let t = place - corner;
        let blend = t * t * t * (t * (6.0 * t - 15.0) + 10.0);
        let lower = luthier_across(seed + octave, corner, t, blend.x, 0.0);
        let upper = luthier_across(seed + octave, corner, t, blend.x, 1.0);
        sum += amplitude * (lower + (upper - lower) * blend.y);
        total += amplitude;
        place *= 2.0;
        amplitude *= 0.5;
    }
    return sum / total;
}

/// Whether a value is in a range, its ends included.
fn luthier_within(value: f32, least: f32, most: f32) -> bool {
    return value >= least && value <= most;
}
