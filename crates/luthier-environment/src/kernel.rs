//! The blurring lobe of levels.

use std::f64::consts::PI;

use crate::cube::Cube;
use crate::faces::{Cap, solid_angles, texel_direction};
use crate::vector::dot;

/// Exponent at which a lobe ends: all but a third of a thousandth of it lies inside.
const END: f64 = 8.0;

/// Steps of the table of `exp(-x)` from 0 to the end. Between them, linear interpolation is within 5e-7.
const STEPS: usize = 4096;

/// A von Mises-Fisher lobe `exp((cos - 1) / width^2)` over the texels of a cube. Each texel counts as light from its
/// middle.
///
/// Texels of the levels and of their cube are half as wide as the lobe. Sums over either follow it within a thousandth,
/// so a level has the mean of its cube.
pub(crate) struct Kernel<'a> {
    source: &'a Cube,
    /// For each texel of the cube, face by face.
    directions: Vec<[f64; 3]>,
    /// For each texel of a face.
    solid_angles: Vec<f64>,
    variance: f64,
    /// `exp(-x)` at the ends of all steps.
    falloff: Vec<f64>,
    /// End of the lobe.
    cap: Cap,
}

impl<'a> Kernel<'a> {
    /// A lobe for levels with texels of `texel` radians. Texture units blur by their texels when they read (a sixth of
    /// the squared side along an axis), and so do the texels of the cube (a twelfth). The lobe is narrower by as much.
    pub(crate) fn new(source: &'a Cube, width: f64, texel: f64) -> Self {
        let of_all = width * width;
        let variance = (of_all - source.texel() * source.texel() / 12.0 - texel * texel / 6.0).max(0.25 * of_all);
        let size = source.size();
        let texels = (0..6).flat_map(|face| (0..size).flat_map(move |y| (0..size).map(move |x| (face, x, y))));
        Self {
            source,
            directions: texels.map(|(face, x, y)| texel_direction(face, size, x, y)).collect(),
            solid_angles: solid_angles(size),
            variance,
            falloff: (0..=STEPS).map(|i| libm::exp(-END * i as f64 / STEPS as f64)).collect(),
            cap: Cap::new(if END * variance < 2.0 { libm::acos(1.0 - END * variance) } else { PI }),
        }
    }

    /// Mean of the cube over the lobe around a unit direction.
    pub(crate) fn mean(&self, middle: [f64; 3]) -> [f64; 3] {
        let size = self.source.size();
        let to_step = STEPS as f64 / (END * self.variance);
        let (mut sum, mut total) = ([0.0; 3], 0.0);
        for face in 0..6 {
            let Some([columns, rows]) = self.cap.window(face, size, middle) else { continue };
            for y in rows {
                let first = y * size;
                for x in columns.clone() {
                    let texel = (first + x) as usize;
                    let step = (1.0 - dot(self.directions[face * (size * size) as usize + texel], middle)) * to_step;
                    let whole = step as usize;
                    if whole >= STEPS {
                        continue;
                    }
                    let (near, far) = (self.falloff[whole], self.falloff[whole + 1]);
                    let weight = self.solid_angles[texel] * (near + (step - whole as f64) * (far - near));
                    total += weight;
                    for (sum, value) in sum.iter_mut().zip(self.source.texel_at(face, x, y)) {
                        *sum += weight * f64::from(*value);
                    }
                }
            }
        }
        sum.map(|v| v / total)
    }
}
