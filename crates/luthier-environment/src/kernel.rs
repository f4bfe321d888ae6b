//! The lobe that levels are blurred by, as a fixed set of directions.

use std::f64::consts::PI;

use crate::vector::{dot, unit};

/// pi (3 - sqrt 5).
const GOLDEN_ANGLE: f64 = 2.399_963_229_728_653;

/// Directions of a lobe.
const SAMPLES: u32 = 96;

/// Variance, over that of its texel, that a bilinear read of an average over a texel has along an axis: 1/6 and 1/12.
const READ: f64 = 0.25;

/// A von Mises-Fisher lobe `exp((cos - 1) / width^2)`: equal shares along a spiral that turns by the golden angle (Vogel 1979).
pub(crate) struct Kernel {
    /// Unit; +z is the middle. With each the side of a square of its share, in radians.
    samples: Vec<([f64; 3], f64)>,
}

impl Kernel {
    /// A lobe for levels whose texels have a side of `texel` radians. Texture units blur by their texels when they read (a sixth of the
    /// squared side along an axis), and so do the reads of this lobe: it is narrower by as much.
    pub(crate) fn new(width: f64, texel: f64) -> Self {
        let read = Self::read();
        let narrowed = width * width * (1.0 - read).max(0.5) - texel * texel / 6.0;
        let variance = narrowed.max(0.25 * width * width);
        let samples = (0..SAMPLES).map(|i| {
            let share = (f64::from(i) + 0.5) / f64::from(SAMPLES);
            // Of exp(y) with y from -2 / variance to 0.
            let lowest = libm::expm1(-2.0 / variance);
            let fall = variance * libm::log1p(share * lowest);
            let cos = 1.0 + fall;
            let sin = (-fall * (2.0 + fall)).max(0.0).sqrt();
            let density = libm::exp(fall / variance) / (-2.0 * PI * variance * lowest);
            let (sin_phi, cos_phi) = libm::sincos(GOLDEN_ANGLE * f64::from(i));
            let side = (1.0 / (density * f64::from(SAMPLES))).sqrt();
            ([sin * cos_phi, sin * sin_phi, cos], side)
        });
        Self { samples: samples.collect() }
    }

    /// Variance that the reads of a narrow lobe add, over its own. A share is the larger the farther out it is.
    fn read() -> f64 {
        let shares: f64 = (0..SAMPLES).map(|i| 1.0 / (f64::from(i) + 0.5)).sum();
        READ * 2.0 * PI / f64::from(SAMPLES) * shares
    }

    /// Mean of a function over the lobe around a unit direction. The function is told a direction and the number of the sample.
    pub(crate) fn mean(&self, middle: [f64; 3], read: impl Fn([f64; 3], usize) -> [f64; 3]) -> [f64; 3] {
        let [t, b] = frame(middle);
        let mut sum = [0.0; 3];
        for (i, ([x, y, z], _)) in self.samples.iter().enumerate() {
            let value = read([0, 1, 2].map(|c| x * t[c] + y * b[c] + z * middle[c]), i);
            (0..3).for_each(|c| sum[c] += value[c]);
        }
        sum.map(|v| v / f64::from(SAMPLES))
    }

    /// Sides of the samples' shares, in radians.
    pub(crate) fn sides(&self) -> impl Iterator<Item = f64> {
        self.samples.iter().map(|(_, side)| *side)
    }
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
        for width in [0.02, 0.1, 0.5, 1.0] {
            let kernel = Kernel::new(width, 0.0);
            let k = 1.0 / (width * width * (1.0 - Kernel::read()));
            let mean: f64 = kernel.samples.iter().map(|(d, _)| d[2]).sum::<f64>() / f64::from(SAMPLES);
            let expected = 1.0 / libm::tanh(k) - 1.0 / k;
            let error = (1.0 - mean) / (1.0 - expected) - 1.0;
            assert!(error.abs() < 0.005, "{width}: {error}");
        }
    }
}
