//! Bilinear filtering with the weights of texture hardware.

use crate::Image;
use crate::steps::step;

/// Precision of the interpolation weights.
///
/// ```
/// use luthier_lut::{Image, WeightBits, bilinear};
///
/// let ramp = Image { width: 2, height: 1, channels: 1, data: vec![0.0, 1.0] };
/// let at = [0.5 + 0.3, 0.5];
/// assert!((bilinear(&ramp, at, WeightBits::Exact)[0] - 0.3).abs() < 1e-12);
/// assert_eq!(bilinear(&ramp, at, WeightBits::Fixed(8))[0], 77.0 / 256.0);
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum WeightBits {
    /// Weights as precise as the arithmetic (software rasterisers).
    Exact,
    /// Weights rounded to this many fractional bits: 8 on most hardware.
    Fixed(u32),
}

/// Bilinear filtering with clamp-to-edge at a position in texels, where texel `i` has its centre at `i + 0.5`.
/// Channels the image lacks are 0, and 1 for alpha.
pub fn bilinear(image: &Image, position: [f64; 2], weights: WeightBits) -> [f64; 4] {
    let (x0, x1, wx) = footprint(position[0], image.width, weights);
    let (y0, y1, wy) = footprint(position[1], image.height, weights);
    let corners = [image.texel(x0, y0), image.texel(x1, y0), image.texel(x0, y1), image.texel(x1, y1)];
    let mut out = [0.0, 0.0, 0.0, 1.0];
    for (c, value) in out.iter_mut().enumerate().take(image.channels as usize) {
        let [a, b, d, e] = corners.map(|texel| f64::from(texel[c]));
        let top = a + (b - a) * wx;
        let bottom = d + (e - d) * wx;
        *value = top + (bottom - top) * wy;
    }
    out
}

/// [`bilinear`] of texels with steps: exact weights, and along a row a texel with its step to the next ([`crate::TexelFormat::Rgba16FloatSteps`]).
pub(crate) fn stepped(image: &Image, position: [f64; 2]) -> [f64; 4] {
    let (x0, x1, wx) = footprint(position[0], image.width, WeightBits::Exact);
    let (y0, y1, wy) = footprint(position[1], image.height, WeightBits::Exact);
    let [top, bottom] = [y0, y1].map(|y| {
        let [here, next] = [x0, x1].map(|x| image.texel(x, y));
        [0, 1, 2, 3].map(|c: usize| f64::from(here[c]) + wx * step(here[c], next[c]).to_f64())
    });
    [0, 1, 2, 3].map(|c: usize| top[c] + (bottom[c] - top[c]) * wy)
}

/// The two texels around a position, and the weight of the second.
fn footprint(position: f64, size: u32, weights: WeightBits) -> (u32, u32, f64) {
    let last = f64::from(size - 1);
    let p = position - 0.5;
    let base = libm::floor(p);
    let fraction = p - base;
    let weight = match weights {
        WeightBits::Exact => fraction,
        WeightBits::Fixed(bits) => {
            let scale = f64::from(1u32 << bits);
            libm::round(fraction * scale) / scale
        }
    };
    (base.clamp(0.0, last) as u32, (base + 1.0).clamp(0.0, last) as u32, weight)
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    /// Bilinear filtering as a sum over all texels, each weighing by the tent function around its centre; the border
    /// repeats outwards because the position is clamped to the outermost centres.
    fn tent_sum(image: &Image, position: [f64; 2]) -> f64 {
        let clamp = |p: f64, size: u32| p.clamp(0.5, f64::from(size) - 0.5);
        let [px, py] = [clamp(position[0], image.width), clamp(position[1], image.height)];
        let tent = |d: f64| (1.0 - d.abs()).max(0.0);
        let mut sum = 0.0;
        for y in 0..image.height {
            for x in 0..image.width {
                let weight = tent(px - f64::from(x) - 0.5) * tent(py - f64::from(y) - 0.5);
                sum += weight * f64::from(image.texel(x, y)[0]);
            }
        }
        sum
    }

    proptest! {
        #[test]
        fn agrees_with_a_sum_of_tents(data in prop::collection::vec(-4.0..4.0f32, 5 * 3), x in -2.0..7.0, y in -2.0..5.0) {
            let image = Image { width: 5, height: 3, channels: 1, data };
            let found = bilinear(&image, [x, y], WeightBits::Exact)[0];
            prop_assert!((found - tent_sum(&image, [x, y])).abs() < 1e-12);
            // 8-bit weights are off by at most 2^-9 along each axis, over steps of at most 8.
            let coarse = bilinear(&image, [x, y], WeightBits::Fixed(8))[0];
            prop_assert!((found - coarse).abs() <= 2.0 * 8.0 / 512.0 + 1e-12);
        }
    }

    /// By hand: a quarter of the way from 1/2 to 1; and beyond 2048, where half floats are whole and even, a step that is not the difference of both ends.
    #[test]
    fn steps_are_half_floats_of_their_own() {
        let row = |data: &[f32]| Image { width: 2, height: 1, channels: 4, data: data.to_vec() };
        let plain = row(&[0.5, 1.0, 0.0, -1.0, 1.0, 0.5, 0.0, 1.0]);
        assert_eq!(stepped(&plain, [0.75, 0.5]), [0.625, 0.875, 0.0, -0.5]);
        assert_eq!(stepped(&plain, [1.5, 0.5]), [1.0, 0.5, 0.0, 1.0]);
        let far = row(&[0.25, 0.0, 0.0, 0.0, 2050.0, 0.0, 0.0, 0.0]);
        assert_eq!(stepped(&far, [1.0, 0.5])[0], 0.25 + 0.5 * 2050.0);
        // Between two rows both are read.
        let two = Image { height: 2, data: [plain.data, vec![0.0; 8]].concat(), ..far };
        assert_eq!(stepped(&two, [0.75, 0.75])[..2], [0.75 * 0.625, 0.75 * 0.875]);
    }

    #[test]
    fn weights_have_the_given_bits() {
        let image = Image { width: 2, height: 1, channels: 1, data: vec![0.0, 1.0] };
        let read = |x: f64, weights| bilinear(&image, [0.5 + x, 0.5], weights)[0];
        assert!((read(0.3, WeightBits::Exact) - 0.3).abs() < 1e-15);
        assert_eq!(read(0.3, WeightBits::Fixed(8)), 77.0 / 256.0);
        assert_eq!(read(0.3, WeightBits::Fixed(1)), 0.5);
        assert_eq!(read(0.999, WeightBits::Fixed(8)), 1.0);
        assert_eq!(read(0.001, WeightBits::Fixed(8)), 0.0);
    }

    #[test]
    fn absent_channels_are_black_and_opaque() {
        let image = Image { width: 1, height: 1, channels: 2, data: vec![0.25, 0.5] };
        assert_eq!(bilinear(&image, [0.5, 0.5], WeightBits::Exact), [0.25, 0.5, 0.0, 1.0]);
    }
}
