//! Tone curves, from radiance to display values.

use luthier_lut::Image;

/// Map from radiance to the values of a display, before its transfer function. It treats each channel by itself and keeps 0; the
/// display clips values above 1.
///
/// ```
/// use luthier_gpu::ToneMapping;
///
/// // The default leaves colours of a well exposed picture alone and bends highlights below 1.
/// assert_eq!(ToneMapping::default().value(0.5), 0.5);
/// assert!(ToneMapping::default().value(20.0) < 1.0);
/// // Reinhard: 1 / (1 + 1).
/// assert_eq!(ToneMapping::Reinhard.value(1.0), 0.5);
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum ToneMapping {
    /// Values as they are.
    None,
    /// Values up to 0.8 stay; above, they are bent smoothly towards 1: `0.8 + 0.2 e / (1 + e)` with `e = (x - 0.8) / 0.2`. This is the
    /// default, because it keeps the colours of a well exposed picture.
    #[default]
    Shoulder,
    /// `x / (1 + x)` (Reinhard et al. 2002, eq. 3).
    Reinhard,
    /// Narkowicz's fit (2016) to the film curve of the Academy Color Encoding System:
    /// `x (2.51 x + 0.03) / (x (2.43 x + 0.59) + 0.14)`.
    Aces,
}

/// Value above which highlights are compressed.
const SHOULDER: f32 = 0.8;

impl ToneMapping {
    /// Applies the curve to one value. Negative values become 0.
    pub fn value(self, x: f32) -> f32 {
        let x = x.max(0.0);
        match self {
            Self::None => x,
            Self::Shoulder if x <= SHOULDER => x,
            Self::Shoulder => {
                let excess = (x - SHOULDER) / (1.0 - SHOULDER);
                SHOULDER + (1.0 - SHOULDER) * (1.0 - 1.0 / (1.0 + excess))
            }
            Self::Reinhard => x / (1.0 + x),
            Self::Aces => x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14),
        }
    }

    /// All values of an image.
    pub fn image(self, mut image: Image) -> Image {
        image.data.iter_mut().for_each(|v| *v = self.value(*v));
        image
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const ALL: [ToneMapping; 4] = [ToneMapping::None, ToneMapping::Shoulder, ToneMapping::Reinhard, ToneMapping::Aces];

    #[test]
    fn curves_rise_from_nothing() {
        for curve in ALL {
            assert_eq!(curve.value(0.0), 0.0, "{curve:?}");
            assert_eq!(curve.value(-1.0), 0.0, "{curve:?}");
            let values: Vec<f32> = (0..400).map(|i| curve.value(i as f32 * 0.02)).collect();
            assert!(values.windows(2).all(|pair| pair[1] > pair[0]), "{curve:?}");
        }
    }

    #[test]
    fn values_of_the_formulas() {
        assert_eq!(ToneMapping::None.value(3.0), 3.0);
        assert_eq!(ToneMapping::Shoulder.value(0.5), 0.5);
        assert!((ToneMapping::Shoulder.value(1.0) - 0.9).abs() < 1e-6);
        assert_eq!(ToneMapping::Reinhard.value(1.0), 0.5);
        // 2.54 / 3.16.
        assert!((ToneMapping::Aces.value(1.0) - 0.803_797_5).abs() < 1e-6);
    }
}
