//! Width, shape and place of highlights.

use luthier_lut::Image;
use luthier_optics::color::luminance;

use super::{across, pixels, rgb};

/// Part of a picture that is at least half as bright as its brightest pixel. Places are from -1 to 1, +x right and +y up.
#[derive(Clone, Copy)]
pub(crate) struct Spot {
    /// Share of the picture.
    pub(crate) share: f64,
    /// Mean place, weighted by the value.
    pub(crate) middle: [f64; 2],
    /// Variance along x, covariance, variance along y.
    covariance: [f64; 3],
}

impl Spot {
    /// Standard deviation along a direction, which need not be unit.
    pub(crate) fn deviation(&self, [x, y]: [f64; 2]) -> f64 {
        let [xx, xy, yy] = self.covariance;
        ((x * x * xx + 2.0 * x * y * xy + y * y * yy) / (x * x + y * y)).max(0.0).sqrt()
    }

    /// Standard deviation along x over that along y.
    pub(crate) fn elongation(&self) -> f64 {
        self.deviation([1.0, 0.0]) / self.deviation([0.0, 1.0]).max(1e-9)
    }

    /// Root mean square distance from the middle.
    pub(crate) fn scatter(&self) -> f64 {
        (self.covariance[0] + self.covariance[2]).max(0.0).sqrt()
    }

    /// Angle of the longer axis to x in degrees, -90 to 90.
    pub(crate) fn axis_deg(&self) -> f64 {
        let [xx, xy, yy] = self.covariance;
        0.5 * libm::atan2(2.0 * xy, xx - yy).to_degrees()
    }
}

/// The brightest part of a picture.
pub(crate) fn spot(image: &Image) -> Spot {
    spot_of(image, luminance)
}

/// A picture with each pixel averaged with its neighbours, so that its brightest pixel is not made by noise.
pub(crate) fn softened(image: &Image) -> Image {
    let mut soft = image.clone();
    for (x, y) in pixels(image) {
        let (mut sum, mut count) = (vec![0.0; image.channels as usize], 0.0);
        for j in (y.max(1) - 1)..=(y + 1).min(image.height - 1) {
            for i in (x.max(1) - 1)..=(x + 1).min(image.width - 1) {
                sum.iter_mut().zip(image.texel(i, j)).for_each(|(sum, value)| *sum += value);
                count += 1.0;
            }
        }
        soft.texel_mut(x, y).iter_mut().zip(sum).for_each(|(soft, sum)| *soft = sum / count);
    }
    soft
}

/// The part of a picture where a value of its pixels is at least half of the greatest.
pub(crate) fn spot_of(image: &Image, value: impl Fn([f64; 3]) -> f64) -> Spot {
    let values: Vec<f64> = image.texels().map(|texel| value(rgb(texel))).collect();
    spot_in(&values, image.width)
}

/// As [`spot_of`], of values row by row.
pub(crate) fn spot_in(values: &[f64], width: u32) -> Spot {
    let most = values.iter().copied().fold(0.0, f64::max);
    weighed(values, width, |value| if value >= 0.5 * most { value } else { 0.0 })
}

/// Mean place of the light of each channel of a picture.
pub(crate) fn centres(image: &Image) -> [[f64; 2]; 3] {
    [0, 1, 2].map(|c: usize| {
        let values: Vec<f64> = image.texels().map(|texel| f64::from(texel[c])).collect();
        weighed(&values, image.width, |value| value).middle
    })
}

fn weighed(values: &[f64], width: u32, weight: impl Fn(f64) -> f64) -> Spot {
    let height = values.len() as f64 / f64::from(width.max(1));
    let (mut sum, mut count, mut first, mut second) = (0.0, 0.0, [0.0; 2], [0.0; 3]);
    for (i, value) in (0_u32..).zip(values) {
        let weight = weight(*value);
        if weight > 0.0 {
            let x = across(i % width, width);
            let y = 1.0 - 2.0 * (f64::from(i / width) + 0.5) / height;
            (sum, count) = (sum + weight, count + 1.0);
            first = [first[0] + weight * x, first[1] + weight * y];
            second = [second[0] + weight * x * x, second[1] + weight * x * y, second[2] + weight * y * y];
        }
    }
    let sum = f64::max(sum, 1e-300);
    let middle = first.map(|v| v / sum);
    let [xx, xy, yy] = second.map(|v| v / sum);
    let [x, y] = middle;
    Spot { share: count / values.len().max(1) as f64, middle, covariance: [xx - x * x, xy - x * y, yy - y * y] }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A Gaussian that is turned and beside the middle. Within half of its peak it holds half of its light, and the variance
    /// along each axis is that of the whole times 1 - ln 2.
    #[test]
    fn a_gaussian_has_its_width_and_axes() {
        let (size, middle, deviations, turn) = (256_u32, [0.1, -0.2], [0.2, 0.1], 30.0_f64.to_radians());
        let (sin, cos) = libm::sincos(turn);
        let mut image = Image::zeros(size, size, 3);
        for i in 0..size * size {
            let x = 2.0 * (f64::from(i % size) + 0.5) / f64::from(size) - 1.0 - middle[0];
            let y = 1.0 - 2.0 * (f64::from(i / size) + 0.5) / f64::from(size) - middle[1];
            let [along, across] = [(x * cos + y * sin) / deviations[0], (y * cos - x * sin) / deviations[1]];
            let value = libm::exp(-0.5 * (along * along + across * across)) as f32;
            image.texel_mut(i % size, i / size).fill(value);
        }
        let found = spot(&image);
        let ln_2 = std::f64::consts::LN_2;
        // The ellipse of radius sqrt(2 ln 2) deviations, in a square of side 2.
        let share = std::f64::consts::PI * 2.0 * ln_2 * deviations[0] * deviations[1] / 4.0;
        assert!((found.share / share - 1.0).abs() < 0.01, "{}", found.share);
        assert!(found.middle.iter().zip(middle).all(|(a, b)| (a - b).abs() < 1e-3), "{:?}", found.middle);
        let shrunk = (1.0 - ln_2).sqrt();
        for (direction, deviation) in [([cos, sin], deviations[0]), ([-sin, cos], deviations[1])] {
            assert!((found.deviation(direction) / (shrunk * deviation) - 1.0).abs() < 0.01);
        }
        assert!((found.axis_deg() - 30.0).abs() < 0.5, "{}", found.axis_deg());
        assert!((found.scatter() / (shrunk * libm::hypot(0.2, 0.1)) - 1.0).abs() < 0.01);
        assert!(centres(&image).iter().flatten().zip([0.1, -0.2].repeat(3)).all(|(a, b)| (a - b).abs() < 1e-3));
    }

    #[test]
    fn a_stripe_is_long_along_itself() {
        let mut image = Image::zeros(8, 8, 3);
        for x in 0..8 {
            image.texel_mut(x, 3).fill(2.0);
        }
        let found = spot(&image);
        assert!(found.elongation() > 1e3 && (found.share - 0.125).abs() < 1e-12);
        // Three rows of a third.
        let soft = softened(&image);
        assert!((soft.texel(4, 2)[0] - 2.0 / 3.0).abs() < 1e-6 && (soft.texel(0, 4)[2] - 2.0 / 3.0).abs() < 1e-6);
        assert!((spot(&soft).share - 0.375).abs() < 1e-12);
    }
}
