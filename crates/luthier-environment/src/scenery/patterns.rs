//! Random numbers, noise and shapes of surroundings.

use crate::vector::{cross, dot};

/// A number in 0..1 for three whole numbers: PCG's output function (Jarzynski and Olano 2020), three times.
pub(super) fn random(x: i64, y: i64, z: i64) -> f64 {
    let hash = [x, y, z].into_iter().fold(0, |hash: u32, v| {
        let state = (hash ^ v as u32).wrapping_mul(747_796_405).wrapping_add(2_891_336_453);
        let word = ((state >> ((state >> 28) + 4)) ^ state).wrapping_mul(277_803_737);
        (word >> 22) ^ word
    });
    f64::from(hash) / f64::from(u32::MAX)
}

/// Smooth noise in 0..1 between the points of a lattice.
pub(super) fn noise(at: [f64; 3]) -> f64 {
    let cell = at.map(f64::floor);
    let weight = [0, 1, 2].map(|i| {
        let t = at[i] - cell[i];
        t * t * (3.0 - 2.0 * t)
    });
    let corners = (0..8).map(|i: usize| {
        let step = [i & 1, i >> 1 & 1, i >> 2];
        let value =
            random(cell[0] as i64 + step[0] as i64, cell[1] as i64 + step[1] as i64, cell[2] as i64 + step[2] as i64);
        (0..3).map(|c| if step[c] == 1 { weight[c] } else { 1.0 - weight[c] }).product::<f64>() * value
    });
    corners.sum()
}

/// Five octaves of noise, in 0..1.
pub(super) fn clouds(d: [f64; 3], scale: f64) -> f64 {
    (0..5).map(|k: i32| noise(d.map(|v| (v + 3.0) * scale * f64::from(1 << k))) * f64::from(16 >> k) / 31.0).sum()
}

pub(super) fn mix(a: [f64; 3], b: [f64; 3], weight: f64) -> [f64; 3] {
    [0, 1, 2].map(|c| a[c] + weight * (b[c] - a[c]))
}

pub(super) fn smooth(from: f64, to: f64, x: f64) -> f64 {
    let t = ((x - from) / (to - from)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

/// The meeting of a ray from the middle of a room and a rectangle, in half sides from its middle.
pub(super) fn meets(d: [f64; 3], middle: [f64; 3], along: [f64; 3], across: [f64; 3]) -> Option<[f64; 2]> {
    let normal = cross(along, across);
    let facing = dot(d, normal);
    let t = dot(middle, normal) / facing;
    if facing == 0.0 || t <= 0.0 {
        return None;
    }
    let at = [0, 1, 2].map(|c| t * d[c] - middle[c]);
    let [u, v] = [dot(at, along) / dot(along, along), dot(at, across) / dot(across, across)];
    (u.abs() <= 1.0 && v.abs() <= 1.0).then_some([u, v])
}
