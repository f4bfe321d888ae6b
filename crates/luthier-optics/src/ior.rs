//! Complex refractive indices as functions of wavelength.

use num_complex::Complex64;
use thiserror::Error;

use crate::Rgb;
use crate::schlick::F82;

/// One sample of a complex index `n + i k` (`k >= 0` absorbs; phase convention e^{+i beta}).
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct IorSample {
    /// Vacuum wavelength.
    pub wavelength_nm: f64,
    /// Real part, not negative; 0 in tables of some metals.
    pub n: f64,
    /// Extinction coefficient, not negative.
    pub k: f64,
}

/// Why a list of samples is not an index.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum IorError {
    /// An index without samples.
    #[error("an index needs at least one sample")]
    Empty,
    /// A wavelength repeats or descends.
    #[error("wavelengths must ascend: {0} nm is followed by {1} nm")]
    NotAscending(f64, f64),
    /// `n < 0`, `k < 0`, both 0, or not finite.
    #[error("the index {n} + {k}i at {wavelength_nm} nm is not physical: n and k must not be negative, nor both 0")]
    NotPhysical {
        /// Where.
        wavelength_nm: f64,
        /// Real part given.
        n: f64,
        /// Extinction coefficient given.
        k: f64,
    },
}

/// A complex index as a function of wavelength: samples joined by straight lines in `n` and `k`,
/// held constant outside their range.
///
/// The built-in data were resampled by straight lines, too; a monotone cubic would move the normal-incidence
/// reflectance of the built-in metals by at most 0.004.
///
/// An index may carry an F0 ([`Ior::with_f0`]), and an edge tint with it ([`Ior::with_f82_tint`]). The interface to its medium then reflects by Schlick's
/// formula, and the index bends directions only.
///
/// ```
/// use luthier_optics::ior::{Ior, IorSample};
///
/// let samples = [(450.0, 1.53), (650.0, 1.51)].map(|(wavelength_nm, n)| IorSample { wavelength_nm, n, k: 0.0 });
/// let glass = Ior::sampled(samples.to_vec()).unwrap();
/// assert!((glass.at(550.0).re - 1.52).abs() < 1e-12);
/// assert_eq!(glass.at(800.0).re, 1.51);
/// // An index is physical: nothing has n = k = 0.
/// assert!(Ior::constant(0.0, 0.0).is_err());
/// ```
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Ior {
    samples: Vec<IorSample>,
    f0: Option<Rgb>,
    f82_tint: Rgb,
    over_above: Option<f64>,
    // Not stored: models make stacks with such indices from others, and nothing keeps them.
    #[cfg_attr(feature = "serde", serde(skip))]
    in_air: bool,
}

impl Ior {
    /// Vacuum, and air for our purposes.
    pub fn vacuum() -> Self {
        Self {
            samples: vec![IorSample { wavelength_nm: 550.0, n: 1.0, k: 0.0 }],
            f0: None,
            f82_tint: [1.0; 3],
            over_above: None,
            in_air: false,
        }
    }

    /// An index that is equal at every wavelength.
    ///
    /// # Errors
    /// [`IorError::NotPhysical`] unless `n >= 0`, `k >= 0`, one of them is positive and both are finite.
    pub fn constant(n: f64, k: f64) -> Result<Self, IorError> {
        Self::sampled(vec![IorSample { wavelength_nm: 550.0, n, k }])
    }

    /// An index from samples in strictly ascending wavelength.
    ///
    /// # Errors
    /// See [`IorError`].
    pub fn sampled(samples: Vec<IorSample>) -> Result<Self, IorError> {
        if samples.is_empty() {
            return Err(IorError::Empty);
        }
        for pair in samples.windows(2) {
            if pair[1].wavelength_nm <= pair[0].wavelength_nm {
                return Err(IorError::NotAscending(pair[0].wavelength_nm, pair[1].wavelength_nm));
            }
        }
        for s in &samples {
            let physical = s.n >= 0.0 && s.k >= 0.0 && s.n + s.k > 0.0 && s.n.is_finite() && s.k.is_finite();
            if !physical || !s.wavelength_nm.is_finite() {
                return Err(IorError::NotPhysical { wavelength_nm: s.wavelength_nm, n: s.n, k: s.k });
            }
        }
        Ok(Self { samples, f0: None, f82_tint: [1.0; 3], over_above: None, in_air: false })
    }

    /// The index of a `metallic-roughness` surface: a multiple of the real index of the medium above, whatever that is ([`crate::stack::Stack::without_first`]).
    #[must_use]
    pub fn engine(above: &Self, index: f64) -> Self {
        let samples = above.samples.iter().map(|s| IorSample { n: s.n * index, k: 0.0, ..*s }).collect();
        Self { samples, over_above: Some(index), ..Self::vacuum() }
    }

    /// The index of a `metallic-roughness` surface over that of the medium above; `None` of any other medium.
    pub fn of_engine(&self) -> Option<f64> {
        self.over_above
    }

    /// The index of a medium whose interface reflects `f0 + (1 - f0)(1 - cos)^5` (Schlick 1994), by colour channel (linear Rec.709,
    /// each in 0..=1), whatever lies above it. Films on it interfere by the index of its F0 ([`crate::schlick::index_below_film`]).
    #[must_use]
    pub fn with_f0(self, f0: Rgb) -> Self {
        Self { f0: Some(f0), ..self }
    }

    /// The index of a medium whose interface, if it reflects by an F0, has this share of Schlick's reflectance at 81.8 degrees ([`crate::schlick::F82`]), by
    /// colour channel, each in 0..=1; 1 is Schlick's formula.
    #[must_use]
    pub fn with_f82_tint(self, f82_tint: Rgb) -> Self {
        // Stores keep 2 less the tint, which is exact of such numbers.
        Self { f82_tint: f82_tint.map(|tint| 2.0 - (2.0 - tint)), ..self }
    }

    /// The index of a medium whose interface reflects as if air lay above it; directions are bent by the medium that does. See
    /// [`crate::stack::Stack::with_lower_in_air`].
    #[must_use]
    pub fn reflecting_as_in_air(self) -> Self {
        Self { in_air: true, ..self }
    }

    /// Whether its interface reflects as if air lay above it.
    pub fn reflects_as_in_air(&self) -> bool {
        self.in_air
    }

    /// The reflectance at normal incidence by colour channel, where Schlick's formula stands in for the index; else `None`.
    pub fn f0(&self) -> Option<Rgb> {
        self.f0
    }

    /// The share of Schlick's reflectance at 81.8 degrees by colour channel, of an interface with an F0; 1 of any other.
    pub fn f82_tint(&self) -> Rgb {
        self.f82_tint
    }

    /// The index of a medium whose interface reflects by curves of an F0 and an edge tint.
    #[must_use]
    pub fn with_f82(self, curves: [F82; 3]) -> Self {
        self.with_f0(curves.map(|curve| curve.f0)).with_f82_tint(curves.map(|curve| curve.tint))
    }

    /// The curve of one colour channel, where the interface reflects by an F0.
    pub fn f82(&self, channel: usize) -> Option<F82> {
        self.f0.map(|f0| F82 { f0: f0[channel], tint: self.f82_tint[channel] })
    }

    /// The curves of all colour channels, where the interface reflects by an F0.
    pub fn f82_rgb(&self) -> Option<[F82; 3]> {
        Some([self.f82(0)?, self.f82(1)?, self.f82(2)?])
    }

    /// Whether all colour channels reflect by the F0 alike, or there is none.
    pub fn is_grey_f0(&self) -> bool {
        self.f82(0) == self.f82(1) && self.f82(1) == self.f82(2)
    }

    /// An index of other samples in strictly ascending wavelength, with the F0 and the edge tint of this one.
    ///
    /// # Errors
    /// See [`IorError`].
    pub fn with_samples(&self, samples: Vec<IorSample>) -> Result<Self, IorError> {
        Ok(Self { samples: Self::sampled(samples)?.samples, ..self.clone() })
    }

    /// The samples, ascending in wavelength.
    pub fn samples(&self) -> &[IorSample] {
        &self.samples
    }

    /// Whether the index is the same at every wavelength.
    pub fn is_constant(&self) -> bool {
        self.samples.iter().all(|s| s.n == self.samples[0].n && s.k == self.samples[0].k)
    }

    /// First and last wavelength of the samples, or `None` for a constant, which holds everywhere.
    pub fn range_nm(&self) -> Option<(f64, f64)> {
        match self.samples.as_slice() {
            [_] => None,
            [first, .., last] => Some((first.wavelength_nm, last.wavelength_nm)),
            [] => None,
        }
    }

    /// The index at a vacuum wavelength; clamped outside the range of the samples.
    pub fn at(&self, wavelength_nm: f64) -> Complex64 {
        let after = self.samples.partition_point(|s| s.wavelength_nm <= wavelength_nm);
        if after == 0 {
            let s = self.samples[0];
            return Complex64::new(s.n, s.k);
        }
        let a = self.samples[after - 1];
        match self.samples.get(after) {
            None => Complex64::new(a.n, a.k),
            Some(b) => {
                let t = (wavelength_nm - a.wavelength_nm) / (b.wavelength_nm - a.wavelength_nm);
                Complex64::new(a.n + (b.n - a.n) * t, a.k + (b.k - a.k) * t)
            }
        }
    }
}
