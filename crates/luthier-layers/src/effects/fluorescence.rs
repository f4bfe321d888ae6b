//! A fluorescent diffuse base under a rough coat.
//!
//! A. Wilkie, A. Weidlich, C. Larboulette and W. Purgathofer, "A Reflectance Model for Diffuse Fluorescent Surfaces", GRAPHITE
//! 2006, as the course of 2009 uses it (sec. 5.2.2): the coat's facets reflect at the wavelength of the light. Light that enters meets a base that
//! moves power between wavelengths by a re-radiation matrix.
//!
//! The bounces between base and coat are summed here in matrix form, each wavelength with its own share held back by
//! the coat. The coat transmits as if it were smooth.

use std::f64::consts::FRAC_1_PI;

use glam::DVec3;
use luthier_model::Masking;

use crate::formulas::facets::Facets;
use crate::formulas::plane_stack::{diffuse_return, seen_from_above};
use crate::model::{Claims, Input, Kind, Model, ModelInfo};
use crate::monochrome::{Monochrome, MonochromeBelow};

/// Why a re-radiation matrix was refused.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum FluorescenceError {
    /// The matrix does not fit the bins.
    #[error("re-radiation matrix has {found} entries; {bins} wavelength bins need {expected}")]
    Shape {
        /// Wavelength bins.
        bins: usize,
        /// Entries that they need.
        expected: usize,
        /// Entries that there are.
        found: usize,
    },
    /// An entry is negative or not a number.
    #[error("re-radiation from bin {from} to bin {to} is {value}; it has to be a number from 0 up")]
    Entry {
        /// Bin of the light that falls in.
        from: usize,
        /// Bin of the light that comes out.
        to: usize,
        /// The entry.
        value: f64,
    },
    /// More power comes out than falls in.
    #[error("bin {from} re-radiates {power} of the power that it receives; it has to be 1 at most")]
    Gain {
        /// Bin of the light that falls in.
        from: usize,
        /// Sum of its column.
        power: f64,
    },
    /// The stack of a bin is not one transparent coat over a diffuse base.
    #[error("the stack of bin {bin} is not a single transparent coat over a diffuse base")]
    Stack {
        /// The bin.
        bin: usize,
    },
}

/// Entries of a column may sum to this little above 1.
const GAIN_TOLERANCE: f64 = 1e-9;

/// A coat over a fluorescent base, in wavelength bins.
///
/// ```
/// use luthier_layers::effects::fluorescence::Fluorescent;
/// use luthier_layers::glam::DVec3;
/// use luthier_layers::luthier_optics::stack::Surface;
/// use luthier_layers::monochrome::{Monochrome, MonochromeBelow};
///
/// let base = MonochromeBelow::Diffuse { albedo: 0.0, sigma: 0.0 };
/// let coat = Monochrome::bare(&[MonochromeBelow::dielectric(1.5, 0.0), base].map(|below| (Surface::smooth(), below)));
/// // Bin 0 re-radiates 70% of its power into bin 1, and nothing moves back.
/// let surface = Fluorescent::new(vec![coat.clone(), coat], &[0.1, 0.0, 0.7, 0.2])?;
/// assert!(surface.eval(DVec3::Z, 0, DVec3::Z, 1) > 0.1 && surface.eval(DVec3::Z, 1, DVec3::Z, 0) == 0.0);
/// # Ok::<(), luthier_layers::effects::fluorescence::FluorescenceError>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Fluorescent {
    coats: Vec<Monochrome>,
    /// Albedo with all inner bounces: entry `to * bins + from`.
    inner: Vec<f64>,
}

impl Fluorescent {
    /// The model of one stack per wavelength bin and of a re-radiation matrix. A stack is a coat over a diffuse base, whose albedo the matrix
    /// replaces. Entry `to * bins + from` is the share of the power of bin `from` that comes out, diffusely, in bin `to`. The diagonal is ordinary
    /// reflection.
    ///
    /// # Errors
    ///
    /// When the matrix has another size, a negative entry, or gains power; when a stack has another form.
    pub fn new(coats: Vec<Monochrome>, matrix: &[f64]) -> Result<Self, FluorescenceError> {
        let bins = coats.len();
        if matrix.len() != bins * bins {
            return Err(FluorescenceError::Shape { bins, expected: bins * bins, found: matrix.len() });
        }
        for from in 0..bins {
            let mut power = 0.0;
            for to in 0..bins {
                let value = matrix[to * bins + from];
                if value.is_nan() || value < 0.0 {
                    return Err(FluorescenceError::Entry { from, to, value });
                }
                power += value;
            }
            if power > 1.0 + GAIN_TOLERANCE {
                return Err(FluorescenceError::Gain { from, power });
            }
        }
        let mut held = Vec::with_capacity(bins);
        for (bin, stack) in coats.iter().enumerate() {
            match stack.layers.as_slice() {
                [coat, base]
                    if matches!(coat.below, MonochromeBelow::Dielectric { .. })
                        && matches!(base.below, MonochromeBelow::Diffuse { .. }) =>
                {
                    held.push(diffuse_return(stack, 1));
                }
                _ => return Err(FluorescenceError::Stack { bin }),
            }
        }
        Ok(Self { coats, inner: with_bounces(matrix, &held) })
    }

    /// Number of wavelength bins.
    pub fn bins(&self) -> usize {
        self.coats.len()
    }

    /// `f cos_theta_i` for light from `wi` in bin `from`, seen from `wo` in bin `to`: power per bin out for power per bin in.
    /// Zero at or below the horizon, and for bins that there are not.
    pub fn eval(&self, wi: DVec3, from: usize, wo: DVec3, to: usize) -> f64 {
        let (Some(entry), Some(exit)) = (self.coats.get(from), self.coats.get(to)) else { return 0.0 };
        if wi.z <= 0.0 || wo.z <= 0.0 {
            return 0.0;
        }
        let mut value = 0.0;
        if let (true, Some(coat)) = (from == to, entry.layers.first())
            && let Some(lobe) = Facets::new(&coat.surface).lobe(Masking::Smith, wi, wo)
        {
            value += coat.reflectance(lobe.cos_theta_d) * lobe.value;
        }
        if let (Some((down, _)), Some((up, _))) = (seen_from_above(entry, 1, wi.z), seen_from_above(exit, 1, wo.z)) {
            // Radiance spreads by the index of the wavelength that leaves.
            let index = exit.layers.first().map_or(1.0, |coat| coat.eta());
            let inner = self.inner[to * self.bins() + from];
            value += wi.z * down.transmittance * inner * up.transmittance * FRAC_1_PI / (index * index);
        }
        value
    }
}

/// The model without a re-radiation matrix: one wavelength, at which the base returns its albedo. Zero for a stack that is not one
/// transparent coat over a diffuse base. With a matrix it takes two wavelengths: [`Fluorescent`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Fluorescence;

impl Model for Fluorescence {
    fn info(&self) -> ModelInfo {
        ModelInfo {
            name: "fluorescence",
            kind: Kind::Layered,
            claims: Claims::BOTH,
            source: "Wilkie et al. 2006; Weidlich and Wilkie 2009, section 5.2.2",
            domain: "one transparent coat over a diffuse base with a re-radiation matrix, by default its albedo; exact for a smooth \
                     coat; alpha from 1e-4; returns up to 1.003 of the light where a rough coat reflects more than the smooth one that \
                     transmits",
            leaves_out: "blur by refraction; bounces inside the coat's micro-surface; the base's roughness",
            inputs: &[Input::Matrix, Input::Excitation],
        }
    }

    fn eval(&self, stack: &Monochrome, wi: DVec3, wo: DVec3) -> f64 {
        let Some(MonochromeBelow::Diffuse { albedo, .. }) = stack.layers.last().map(|layer| layer.below) else {
            return 0.0;
        };
        Fluorescent::new(vec![stack.clone()], &[albedo]).map_or(0.0, |surface| surface.eval(wi, 0, wo, 0))
    }
}

/// A fluorescent surface between two of its bins, as a model. It evaluates the surface's own stacks and ignores the one that it is given.
#[derive(Debug, Clone, PartialEq)]
pub struct Reradiated {
    /// The surface.
    pub surface: Fluorescent,
    /// Bin of the light.
    pub from: usize,
    /// Bin that is seen.
    pub to: usize,
}

impl Model for Reradiated {
    fn info(&self) -> ModelInfo {
        Fluorescence.info()
    }

    fn eval(&self, _: &Monochrome, wi: DVec3, wo: DVec3) -> f64 {
        self.surface.eval(wi, self.from, wo, self.to)
    }
}

/// `(1 - M H)^-1 M` with a diagonal H: all light that the base sends up, if the coat sends the share `held[k]` of bin k back each time.
///
/// Gauss elimination needs no exchange of rows: columns of M H sum to at most `held` < 1, so the diagonal dominates every column.
fn with_bounces(matrix: &[f64], held: &[f64]) -> Vec<f64> {
    let n = held.len();
    let mut left: Vec<f64> =
        (0..n * n).map(|at| if at / n == at % n { 1.0 } else { 0.0 } - matrix[at] * held[at % n]).collect();
    let mut right = matrix.to_vec();
    for pivot in 0..n {
        let scale = 1.0 / left[pivot * n + pivot];
        for row in 0..n {
            if row == pivot {
                continue;
            }
            let factor = left[row * n + pivot] * scale;
            for column in 0..n {
                left[row * n + column] -= factor * left[pivot * n + column];
                right[row * n + column] -= factor * right[pivot * n + column];
            }
        }
    }
    (0..n * n).map(|at| right[at] / left[(at / n) * n + at / n]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use luthier_optics::stack::{Distribution, Surface};

    fn coat(n: f64, alpha: f64) -> Monochrome {
        let diffuse = MonochromeBelow::Diffuse { albedo: 0.5, sigma: 0.0 };
        let surface = Surface::isotropic(Distribution::Ggx, alpha);
        Monochrome::bare(&[MonochromeBelow::dielectric(n, 0.0), diffuse].map(|below| (surface, below)))
    }

    /// Directional albedo from bin to bin: the light is at the normal; midpoints in cosine squared. Only exact without a narrow lobe.
    fn albedo(f: &Fluorescent, from: usize, to: usize) -> f64 {
        let n = 4000;
        (0..n)
            .map(|i| {
                let cos = libm::sqrt((f64::from(i) + 0.5) / f64::from(n));
                let wo = DVec3::new(libm::sqrt(1.0 - cos * cos), 0.0, cos);
                std::f64::consts::PI / f64::from(n) * f.eval(DVec3::Z, from, wo, to)
            })
            .sum()
    }

    /// Oracle: closed form of a smooth coat on Lambert's surface at normal incidence, n = 1.5, less the mirrored 0.04.
    #[test]
    fn without_fluorescence_it_is_a_coated_lambert_surface() {
        let rho = [0.18, 0.8];
        let matrix = [rho[0], 0.0, 0.0, rho[1]];
        let f = Fluorescent::new(vec![coat(1.5, 0.0), coat(1.5, 0.0)], &matrix).unwrap();
        for (bin, expected) in [(0, 0.11813908), (1, 0.63283341)] {
            // The first midpoint is 0.011 off the normal: the tail of the coat's lobe that begins there holds 2e-5.
            let found = albedo(&f, bin, bin);
            assert!((found - (expected - 0.04)).abs() < 6e-5, "{bin}: {found}");
        }
        assert_eq!(f.eval(DVec3::Z, 0, DVec3::Z, 1), 0.0);
        // The model by name has the stack's own albedo.
        let half = Fluorescent::new(vec![coat(1.5, 0.0)], &[0.5]).unwrap();
        let wo = DVec3::new(0.6, 0.0, 0.8);
        assert_eq!(Fluorescence.eval(&coat(1.5, 0.0), DVec3::Z, wo), half.eval(DVec3::Z, 0, wo, 0));
    }

    /// Oracle: the bounces one after the other.
    #[test]
    fn bounces_are_summed() {
        let matrix = [0.3, 0.0, 0.0, 0.4, 0.2, 0.0, 0.2, 0.5, 0.9];
        let held = [0.5, 0.6, 0.55];
        let product = |a: &[f64], b: &[f64]| -> Vec<f64> {
            (0..9).map(|at| (0..3).map(|k| a[at / 3 * 3 + k] * b[k * 3 + at % 3]).sum()).collect()
        };
        let mut term = matrix.to_vec();
        let mut sum = vec![0.0; 9];
        for _ in 0..200 {
            sum = sum.iter().zip(&term).map(|(a, b)| a + b).collect();
            let back: Vec<f64> = (0..9).map(|at| held[at / 3] * term[at]).collect();
            term = product(&matrix, &back);
        }
        for (found, expected) in with_bounces(&matrix, &held).into_iter().zip(sum) {
            assert!((found - expected).abs() < 1e-12, "{found} {expected}");
        }
    }

    /// The laser experiment of the course: green light, orange pigment. The lobe stays green, the orange has no lobe; towards
    /// grazing angles less of it comes out.
    #[test]
    fn the_lobe_keeps_its_colour() {
        let matrix = [0.1, 0.0, 0.7, 0.2];
        let f = Fluorescent::new(vec![coat(1.5, 0.3), coat(1.5, 0.3)], &matrix).unwrap();
        let wi = DVec3::new(libm::sqrt(0.5), 0.0, libm::sqrt(0.5));
        let (mirror, back) = (DVec3::new(-wi.x, 0.0, wi.z), wi);
        let (green, orange) = (f.eval(wi, 0, mirror, 0), f.eval(wi, 0, mirror, 1));
        assert!(green > 2.0 * f.eval(wi, 0, back, 0));
        assert!((orange - f.eval(wi, 0, back, 1)).abs() < 1e-15);
        assert_eq!(f.eval(wi, 1, mirror, 0), 0.0);
        // No more comes out than falls in: 0.04 is mirrored.
        assert!(albedo(&f, 0, 0) + albedo(&f, 0, 1) < 1.0);
    }

    #[test]
    fn matrices_that_cannot_be_are_refused() {
        let coats = || vec![coat(1.5, 0.1), coat(1.5, 0.1)];
        let refused = |coats, matrix: &[f64]| Fluorescent::new(coats, matrix).unwrap_err();
        assert!(matches!(refused(coats(), &[0.1; 3]), FluorescenceError::Shape { expected: 4, found: 3, .. }));
        assert!(matches!(refused(coats(), &[0.7, 0.0, 0.7, 0.0]), FluorescenceError::Gain { from: 0, .. }));
        assert!(matches!(refused(coats(), &[0.1, -0.1, 0.0, 0.0]), FluorescenceError::Entry { from: 1, to: 0, .. }));
        let mut bare = coats();
        bare[1].layers.remove(0);
        assert!(matches!(refused(bare, &[0.1; 4]), FluorescenceError::Stack { bin: 1 }));
    }
}
