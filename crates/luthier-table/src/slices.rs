//! Tables of three axes: the slices of the third lie one below the other in one image.

use luthier_lut::{Comparison, ErrorStats, Image, Scan, WeightBits, bilinear, measure_at, measure_scan};
use rayon::prelude::*;

/// Fraction bits of the sampler's weights.
pub(crate) const BITS: u32 = 8;

/// A sampler's read at a position in texels of each axis: bilinear in two slices of `rows` rows, then between them.
pub(crate) fn read(texels: &Image, position: [f64; 3], [_, rows, slices]: [u32; 3]) -> [f64; 4] {
    let rows = f64::from(rows);
    let y = position[1].clamp(0.5, rows - 0.5);
    let last = f64::from(slices - 1);
    let z = (position[2] - 0.5).clamp(0.0, last);
    let low = libm::floor(z);
    let scale = f64::from(1u32 << BITS);
    let t = libm::round((z - low) * scale) / scale;
    let [near, far] = [low, (low + 1.0).min(last)]
        .map(|slice| bilinear(texels, [position[0], slice * rows + y], WeightBits::Fixed(BITS)));
    [0, 1, 2, 3].map(|c: usize| near[c] + (far[c] - near[c]) * t)
}

/// The error over a box of coordinates: a scan of `points` points along each axis, then a climb from the worst ones of
/// the worst slice. `named` gives the values of the axes at a coordinate.
pub(crate) fn measure(
    points: u32,
    ends: [[f64; 2]; 3],
    refinements: u32,
    compare: impl Fn([f64; 3]) -> Comparison + Sync,
    named: impl Fn([f64; 3]) -> Vec<f64> + Sync,
) -> ErrorStats {
    let [x, y, [from, to]] = ends;
    let scan = Scan { points: [points; 2], from: [x[0], y[0]], to: [x[1], y[1]], nodes: [0, 0], refinements };
    let thirds: Vec<f64> = (0..points).map(|i| from + (to - from) * (f64::from(i) + 0.5) / f64::from(points)).collect();
    let flat: Vec<[f64; 2]> = scan.coordinates().collect();
    let all: Vec<(Vec<f64>, Comparison)> = (0..thirds.len() * flat.len())
        .into_par_iter()
        .map(|i| {
            let [u, v] = flat[i % flat.len()];
            let u = [u, v, thirds[i / flat.len()]];
            (u.to_vec(), compare(u))
        })
        .collect();
    let mut stats = measure_at(all);
    let worst = stats.worst.at.clone();
    let third = worst.get(2).copied().unwrap_or(0.5);
    stats.worst.at = named([0, 1, 2].map(|k: usize| worst.get(k).copied().unwrap_or(0.5)));
    stats.with_worst_of(measure_scan(&scan, |[u, v]| compare([u, v, third]), |[u, v]| named([u, v, third])))
}
