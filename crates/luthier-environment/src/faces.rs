//! The six square faces of a cube around a direction, in the order and orientation that graphics interfaces and KTX2 give to cube maps.

use std::f64::consts::PI;
use std::ops::Range;

use crate::vector::{dot, unit};

/// The direction (not unit) of a point of a face. Both coordinates run from -1 to 1 from the top left. The faces look
/// along +x, -x, +y, -y, +z, -z.
pub(crate) fn direction(face: usize, [s, t]: [f64; 2]) -> [f64; 3] {
    match face {
        0 => [1.0, -t, -s],
        1 => [-1.0, -t, s],
        2 => [s, 1.0, t],
        3 => [s, -1.0, -t],
        4 => [s, -t, 1.0],
        _ => [-s, -t, -1.0],
    }
}

/// A cap around a direction: its half angle.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Cap {
    sin: f64,
    is_narrow: bool,
    /// Cosine of the least angle between the middles of cap and face at which the cap misses the face.
    cos_missed: f64,
}

impl Cap {
    /// The cap of directions within an angle.
    pub(crate) fn new(angle: f64) -> Self {
        // The corner of a face is less than 0.96 from its middle.
        Self { sin: libm::sin(angle), is_narrow: angle < 0.5 * PI, cos_missed: libm::cos((angle + 0.96).min(PI)) }
    }

    /// Columns and rows of a face whose texels may lie within the cap around a unit direction.
    pub(crate) fn window(&self, face: usize, size: u32, middle: [f64; 3]) -> Option<[Range<u32>; 2]> {
        let out = direction(face, [0.0, 0.0]);
        let depth = dot(middle, out);
        if depth < self.cos_missed {
            return None;
        }
        let [columns, rows] = [[1.0, 0.0], [0.0, 1.0]].map(|at| {
            let beside = direction(face, at);
            let side = dot(middle, [0, 1, 2].map(|c| beside[c] - out[c]));
            // Sine of the cap's angle, seen along the other axis.
            let sine = self.sin / (side * side + depth * depth).sqrt();
            if !self.is_narrow || sine >= 1.0 {
                return 0..size;
            }
            let (turn, half) = (libm::atan2(side, depth), libm::asin(sine));
            let [low, high] = [turn - half, turn + half].map(|angle| {
                let at = libm::tan(angle.clamp(-0.25 * PI, 0.25 * PI));
                0.5 * (at + 1.0) * f64::from(size)
            });
            (low - 0.5).round().max(0.0) as u32..((high + 0.5).round() as u32).min(size)
        });
        (!columns.is_empty() && !rows.is_empty()).then_some([columns, rows])
    }
}

/// Coordinates of the centre of a texel.
fn centre(texel: u32, size: u32) -> f64 {
    (2.0 * f64::from(texel) + 1.0) / f64::from(size) - 1.0
}

/// Solid angles of the texels of a face, row by row.
pub(crate) fn solid_angles(size: u32) -> Vec<f64> {
    // Solid angles of the rectangles between the middle of the face and each corner; texels are differences of four.
    let corners: Vec<f64> = (0..=size)
        .flat_map(|y| (0..=size).map(move |x| [x, y].map(|i| 2.0 * f64::from(i) / f64::from(size) - 1.0)))
        .map(|[s, t]| libm::atan2(s * t, (1.0 + s * s + t * t).sqrt()))
        .collect();
    let rows: Vec<&[f64]> = corners.chunks_exact(size as usize + 1).collect();
    let pairs = rows.windows(2).flat_map(|rows| rows[0].windows(2).zip(rows[1].windows(2)));
    pairs.map(|(upper, lower)| lower[1] - lower[0] - upper[1] + upper[0]).collect()
}

/// A unit direction for each texel of a face, row by row.
pub(crate) fn texel_direction(face: usize, size: u32, x: u32, y: u32) -> [f64; 3] {
    unit(direction(face, [x, y].map(|i| centre(i, size))))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn texels_fill_the_sphere() {
        for size in [1, 2, 5, 64] {
            let total: f64 = solid_angles(size).iter().sum();
            assert!((6.0 * total / (4.0 * PI) - 1.0).abs() < 1e-12, "{size}: {total}");
        }
    }

    /// A window leaves out no texel within the angle.
    #[test]
    fn windows_have_all_texels_within_an_angle() {
        for (i, angle) in (0..400).zip([0.02, 0.1, 0.3, 0.8, 1.4, 2.0].into_iter().cycle()) {
            let middle = unit([f64::from(i % 13) - 6.1, f64::from(i % 17) - 8.2, f64::from(i % 11) - 5.3]);
            for face in 0..6 {
                let found = Cap::new(angle).window(face, 16, middle);
                for (y, x) in (0..16).flat_map(|y| (0..16).map(move |x| (y, x))) {
                    if dot(texel_direction(face, 16, x, y), middle) > libm::cos(angle) {
                        let [columns, rows] = found.as_ref().unwrap();
                        assert!(columns.contains(&x) && rows.contains(&y), "{middle:?} {angle}: {face} {x} {y}");
                    }
                }
            }
        }
    }
}
