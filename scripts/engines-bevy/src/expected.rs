//! What the balls should look like, by quadrature instead of a table.

use luthier_optics::split_sum::{Masking, SplitSum, split_sum};
use luthier_optics::stack::Distribution;

use crate::scene::{F0, ROUGHNESSES, pixels};

/// Lowest cosine that counts. Flatter ones are the outermost 0.13 % of a ball's radius, less than a pixel.
const MIN_COS: f64 = 0.05;

/// The light that reaches the balls.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Light {
    /// Bevy's map of reflections alone: the picture is f0 * scale + bias, as the table has them.
    Reflected,
    /// Bevy's maps of reflections and of irradiance: with its compensation of lost energy.
    All,
}

impl Light {
    /// Radiance towards the eye from a metal in an environment of radiance 1.
    fn radiance(self, f0: f64, sum: SplitSum) -> f64 {
        let single = f0 * sum.scale + sum.bias;
        match self {
            Self::Reflected => single,
            Self::All => {
                // Fdez-Aguera 2019, "A Multiple-Scattering Microfacet Model for Real-Time Image-based Lighting", as Bevy has it.
                let (average, loss) = (f0 + (1.0 - f0) / 21.0, 1.0 - sum.albedo());
                single + single * average / (1.0 - loss * average) * loss
            }
        }
    }
}

/// A pixel that counts.
struct Pixel {
    place: usize,
    ball: usize,
    sum: SplitSum,
}

/// The split sums of all pixels, by quadrature.
pub struct Expected(Vec<Pixel>);

/// Differences of pixels from [`Expected`].
#[derive(Default)]
pub struct Difference {
    /// Largest.
    pub max_abs_err: f64,
    /// Root mean square.
    pub rms_err: f64,
}

impl Expected {
    /// The metals that [`crate::scene`] draws.
    pub fn new() -> Self {
        let pixels = pixels().filter(|&(.., cos)| cos >= MIN_COS).map(|(place, ball, cos)| {
            let roughness = f64::from(ROUGHNESSES[ball]);
            let sum = split_sum(Distribution::Ggx, Masking::SmithCorrelated, roughness * roughness, cos);
            Pixel { place, ball, sum }
        });
        Self(pixels.collect())
    }

    /// Compares a channel of a picture, of one ball or of all.
    pub fn compare(&self, picture: &[[f32; 4]], channel: usize, light: Light, ball: Option<usize>) -> Difference {
        let mut difference = Difference::default();
        let mut count = 0.0;
        for pixel in self.0.iter().filter(|pixel| ball.is_none_or(|ball| pixel.ball == ball)) {
            let expected = light.radiance(f64::from(F0[channel]), pixel.sum);
            let off = (f64::from(picture[pixel.place][channel]) - expected).abs();
            difference.max_abs_err = difference.max_abs_err.max(off);
            difference.rms_err += off * off;
            count += 1.0;
        }
        difference.rms_err = (difference.rms_err / count).sqrt();
        difference
    }
}
