//! The lobe that levels are blurred by, as a fixed set of directions.

use std::f64::consts::PI;

use crate::vector::{dot, unit};

/// pi (3 - sqrt 5).
const GOLDEN_ANGLE: f64 = 2.399_963_229_728_653;

/// Directions of a lobe.
const SAMPLES: u32 = 128;

/// Exponent at which a lobe ends: all but a third of a thousandth of it lies within.
const END: f64 = 8.0;

/// Variance, over that of its texel, that a bilinear read of an average over a texel has along an axis: 1/6 and 1/12.
const READ: f64 = 0.25;

/// A von Mises-Fisher lobe `exp((cos - 1) / width^2)`: directions with equal solid angles along a spiral that turns by the golden angle (Vogel 1979).
///
/// Every read blurs by as much as the others, so that the sum is a lobe of the same kind, and wider. Directions with equal shares would want the wider
/// reads the farther out they are, whose sum has a long tail.
pub(crate) struct Kernel {
    /// Unit; +z is the middle. With each its weight; their sum is 1.
    samples: Vec<([f64; 3], f64)>,
}

impl Kernel {
    /// A lobe for levels whose texels have a side of `texel` radians, over a source whose texels have one of `source_texel`. Texture units blur by
    /// their texels when they read (a sixth of the squared side along an axis), and so do the reads of this lobe: it is narrower by as much.
    pub(crate) fn new(width: f64, texel: f64, source_texel: f64) -> Self {
        let variance_of_all = width * width;
        let narrowed = variance_of_all - READ * source_texel * source_texel - texel * texel / 6.0;
        let variance = narrowed.max(0.25 * variance_of_all);
        let depth = depth(width);
        let mut samples: Vec<([f64; 3], f64)> = (0..SAMPLES)
            .map(|i| {
                let fall = depth * (f64::from(i) + 0.5) / f64::from(SAMPLES);
                let sin = (fall * (2.0 - fall)).max(0.0).sqrt();
                let (sin_phi, cos_phi) = libm::sincos(GOLDEN_ANGLE * f64::from(i));
                ([sin * cos_phi, sin * sin_phi, 1.0 - fall], libm::exp(-fall / variance))
            })
            .collect();
        let sum: f64 = samples.iter().map(|(_, weight)| weight).sum();
        samples.iter_mut().for_each(|(_, weight)| *weight /= sum);
        Self { samples }
    }

    /// Side of the square that each direction of a lobe stands for, radians.
    pub(crate) fn side(width: f64) -> f64 {
        (2.0 * PI * depth(width) / f64::from(SAMPLES)).sqrt()
    }

    /// Mean of a function over the lobe around a unit direction.
    pub(crate) fn mean(&self, middle: [f64; 3], read: impl Fn([f64; 3]) -> [f64; 3]) -> [f64; 3] {
        let [t, b] = frame(middle);
        let mut sum = [0.0; 3];
        for ([x, y, z], weight) in &self.samples {
            let value = read([0, 1, 2].map(|c| x * t[c] + y * b[c] + z * middle[c]));
            (0..3).for_each(|c| sum[c] += weight * value[c]);
        }
        sum
    }
}

/// 1 less the cosine at which a lobe ends.
fn depth(width: f64) -> f64 {
    (END * width * width).min(2.0)
}

/// Two unit vectors that make a right-handed frame with a unit `n`.
fn frame(n: [f64; 3]) -> [[f64; 3]; 2] {
    let axis = if n[1].abs() < 0.9 { [0.0, 1.0, 0.0] } else { [1.0, 0.0, 0.0] };
    let along = dot(axis, n);
    let t = unit([0, 1, 2].map(|c| axis[c] - along * n[c]));
    [t, crate::vector::cross(n, t)]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The mean cosine of a von Mises-Fisher lobe of concentration k is coth k - 1 / k.
    #[test]
    fn directions_have_the_mean_cosine_of_the_lobe() {
        for width in [0.02, 0.1, 0.25, 0.5, 1.0] {
            let k = 1.0 / (width * width);
            let mean = Kernel::new(width, 0.0, 0.0).mean([0.0, 0.0, 1.0], |direction| direction)[2];
            let expected = 1.0 / libm::tanh(k) - 1.0 / k;
            let error = (1.0 - mean) / (1.0 - expected) - 1.0;
            assert!(error.abs() < 0.01, "{width}: {error}");
        }
    }
}
