//! The blurring lobe of a rough mirror, as a fixed set of directions.

use std::f64::consts::PI;

/// Slope distribution of a rough mirror.
///
/// ```
/// use luthier_environment::{ALPHAS, Blur, Environment, Sky};
///
/// let environment = Environment::sky(&Sky::uniform([0.25; 3]))?;
/// let [red, ..] = environment.mirrored(Blur::Ggx, 0.5, [0.0, 1.0, 0.0]);
/// assert!((red - 0.25).abs() < 1e-6);
/// assert_eq!(environment.chain(Blur::Ggx).len(), ALPHAS.len());
/// # Ok::<(), luthier_environment::EnvironmentError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Blur {
    /// Trowbridge-Reitz.
    Ggx,
    /// Beckmann.
    Beckmann,
}

/// Slope parameters of the blurred maps, half an octave apart. 1 is the roughest. Maps are mixed between neighbours,
/// and between 0 (the map itself) and the first.
pub const ALPHAS: [f64; 13] = [
    1.0 / 64.0,
    1.0 / 45.254_834,
    1.0 / 32.0,
    1.0 / 22.627_417,
    1.0 / 16.0,
    1.0 / 11.313_708,
    1.0 / 8.0,
    1.0 / 5.656_854_2,
    1.0 / 4.0,
    1.0 / 2.828_427_1,
    1.0 / 2.0,
    1.0 / std::f64::consts::SQRT_2,
    1.0,
];

/// pi (3 - sqrt 5).
const GOLDEN_ANGLE: f64 = 2.399_963_229_728_653;

/// Number of samples of a lobe: wide lobes need more, and their maps are small.
fn samples(alpha: f64) -> u32 {
    match alpha {
        ..0.1 => 128,
        ..0.4 => 256,
        _ => 1024,
    }
}

/// Rows of the map blurred with `alpha`. Bilinear reads lose 2% of the peak of a lobe, and more below alpha = 1/32.
pub(crate) fn level_height(alpha: f64) -> u32 {
    ((8.0 / alpha).ceil() as u32).next_power_of_two().clamp(16, 256)
}

/// Index of the map for a slope parameter, and the weight of the next map. Index 0 is the unblurred map; k is `ALPHAS[k
/// - 1]`.
pub(crate) fn place(alpha: f64) -> (usize, f64) {
    if alpha < ALPHAS[0] {
        return (0, alpha.max(0.0) / ALPHAS[0]);
    }
    let octaves = 2.0 * (libm::log2(alpha) - libm::log2(ALPHAS[0]));
    let octaves = octaves.min((ALPHAS.len() - 1) as f64);
    (1 + octaves.floor() as usize, octaves - octaves.floor())
}

/// Facets of a surface at normal incidence (n = v = r) that mirror light to the eye, weighed by the cavities' masking
/// min(1, 2 cos_theta_i), as in `luthier_eval`. Weights sum to 1.
pub(crate) struct Lobe {
    pub(crate) samples: Vec<Sample>,
}

pub(crate) struct Sample {
    /// Unit; +z is the mirrored direction.
    pub(crate) direction: [f64; 3],
    pub(crate) weight: f64,
    /// Level of the map with texels as large as this sample's share.
    pub(crate) level: f64,
}

impl Lobe {
    /// The lobe for a map with this many rows: facets along a spiral that turns by the golden angle (Vogel 1979), each
    /// at the middle of an equal share of D cos_theta_h. The density over mirrored directions is then D / 4 at n = v.
    pub(crate) fn new(blur: Blur, alpha: f64, rows: u32) -> Self {
        let texel = (PI / f64::from(rows)) * (PI / f64::from(rows));
        let count = samples(alpha);
        let mut samples = Vec::new();
        for i in 0..count {
            let share = (f64::from(i) + 0.5) / f64::from(count);
            let tan_sq = match blur {
                Blur::Ggx => alpha * alpha * share / (1.0 - share),
                Blur::Beckmann => -alpha * alpha * libm::log1p(-share),
            };
            let cos_h_sq = 1.0 / (1.0 + tan_sq);
            let cos_theta_i = 2.0 * cos_h_sq - 1.0;
            if cos_theta_i <= 0.0 {
                continue;
            }
            let sin_theta_i = (1.0 - cos_theta_i * cos_theta_i).max(0.0).sqrt();
            let density = scaled(blur, tan_sq, alpha) / (cos_h_sq * cos_h_sq * 4.0 * PI * alpha * alpha);
            let solid_angle = 1.0 / (f64::from(count) * density);
            let (sin_phi, cos_phi) = libm::sincos(GOLDEN_ANGLE * f64::from(i));
            samples.push(Sample {
                direction: [sin_theta_i * cos_phi, sin_theta_i * sin_phi, cos_theta_i],
                weight: (2.0 * cos_theta_i).min(1.0),
                level: (0.5 * libm::log2(solid_angle / texel)).max(0.0),
            });
        }
        let total: f64 = samples.iter().map(|s| s.weight).sum();
        samples.iter_mut().for_each(|s| s.weight /= total);
        Self { samples }
    }
}

/// `pi alpha^2 D cos^4`: Walter et al. 2007, eq. 25 and 33.
fn scaled(blur: Blur, tan_sq: f64, alpha: f64) -> f64 {
    let x = tan_sq / (alpha * alpha);
    match blur {
        Blur::Ggx => 1.0 / ((1.0 + x) * (1.0 + x)),
        Blur::Beckmann => libm::exp(-x),
    }
}
