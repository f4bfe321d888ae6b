//! Comparison of two pictures, in numbers and by visibility; contact sheets of many.

pub(crate) mod ball;
pub(crate) mod flip;
mod sheet;

use luthier_lut::Image;

use crate::error::ReportError;
use crate::picture::flip::flip;

pub use sheet::sheet;

/// Pixels per degree of the default viewing conditions of FLIP: 0.7 m from a monitor 0.7 m wide with 3840 pixels.
pub const PIXELS_PER_DEGREE: f64 = 67.020_643_276_582_26;

/// Two pictures compared.
#[derive(Debug, Clone, PartialEq)]
pub struct PictureComparison {
    /// Root of the mean squared difference over all pixels and channels, in the unit of the pictures.
    pub rms_err: f64,
    /// Largest difference.
    pub max_abs_err: f64,
    /// Mean of the FLIP map, 0 to 1.
    pub flip_mean: f64,
    /// Its largest value.
    pub flip_max: f64,
    /// One channel, 0 to 1.
    pub flip: Image,
}

/// Compares two linear RGB pictures. FLIP compares them as a display shows them, after the tone curve `shown`.
///
/// # Errors
/// [`ReportError::Pictures`] unless both are RGB of the same size.
pub fn compare_pictures(a: &Image, b: &Image, shown: impl Fn(f32) -> f32) -> Result<PictureComparison, ReportError> {
    let [shape, other] = [a, b].map(|image| (image.width, image.height, image.channels));
    if shape != other || a.channels != 3 || a.data.is_empty() {
        return Err(ReportError::Pictures { a: shape, b: other });
    }
    let differences = a.data.iter().zip(&b.data).map(|(a, b)| f64::from(*a) - f64::from(*b));
    let square_sum: f64 = differences.clone().map(|d| d * d).sum();
    let [first, second] =
        [a, b].map(|image| Image { data: image.data.iter().map(|v| shown(*v)).collect(), ..image.clone() });
    let flip = flip(&first, &second, PIXELS_PER_DEGREE);
    let flip_values = flip.data.iter().map(|v| f64::from(*v));
    Ok(PictureComparison {
        rms_err: (square_sum / a.data.len() as f64).sqrt(),
        max_abs_err: differences.map(f64::abs).fold(0.0, f64::max),
        flip_mean: flip_values.clone().sum::<f64>() / flip.data.len() as f64,
        flip_max: flip_values.fold(0.0, f64::max),
        flip,
    })
}

/// Absolute difference of two pictures on a display, after the tone curve `shown`. It is brightened by the largest power of two that keeps it within 1;
/// the power is returned too.
pub fn brightened_difference(a: &Image, b: &Image, shown: impl Fn(f32) -> f32) -> (Image, u32) {
    let mut image = a.clone();
    image.data.iter_mut().zip(&b.data).for_each(|(a, b)| *a = (shown(*a).min(1.0) - shown(*b).min(1.0)).abs());
    let largest = image.data.iter().copied().fold(0.0, f32::max);
    let mut gain = 1;
    while gain < 1 << 16 && largest > 0.0 && largest * (2 * gain) as f32 <= 1.0 {
        gain *= 2;
    }
    image.data.iter_mut().for_each(|v| *v *= gain as f32);
    (image, gain)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_known_difference() {
        let a = Image { data: vec![0.5; 12], ..Image::zeros(2, 2, 3) };
        let mut b = a.clone();
        b.data[4] = 0.8;
        let compared = compare_pictures(&a, &b, |v| v).unwrap();
        // One value of twelve is 0.3 off.
        assert!((compared.rms_err - 0.3 / 12.0_f64.sqrt()).abs() < 1e-7, "{}", compared.rms_err);
        assert!((compared.max_abs_err - 0.3).abs() < 1e-7);
        assert!(compared.flip_mean > 0.0 && compared.flip_max <= 1.0);
        let same = compare_pictures(&a, &a, |v| v).unwrap();
        assert_eq!((same.rms_err, same.max_abs_err, same.flip_mean, same.flip_max), (0.0, 0.0, 0.0, 0.0));
    }

    #[test]
    fn pictures_of_other_shapes_are_refused() {
        let refused = |a: Image, b: Image| matches!(compare_pictures(&a, &b, |v| v), Err(ReportError::Pictures { .. }));
        assert!(refused(Image::zeros(2, 2, 3), Image::zeros(2, 3, 3)));
        assert!(refused(Image::zeros(2, 2, 1), Image::zeros(2, 2, 1)));
        assert!(refused(Image::zeros(0, 0, 3), Image::zeros(0, 0, 3)));
    }
}
