//! Slope distributions by their own parameters, each normalised: the integral of D cos_theta_h over the hemisphere is 1. Layers have them as a
//! [`Distribution`](crate::stack::Distribution) and a slope parameter ([`microfacet`](crate::microfacet)); [`Shape`] is between the two.
//!
//! Masking for any [`Ndf`] is in [`masking`](crate::masking).

mod abc;
mod blinn_phong;
mod sgd;
mod shape;

pub use abc::Abc;
pub use blinn_phong::BlinnPhong;
pub use sgd::Sgd;
pub use shape::Shape;

use thiserror::Error;

/// An isotropic distribution of micro-normals.
pub trait Ndf {
    /// D, in 1/sr; 0 for `cos_theta_h <= 0`. The squared sine comes apart, because `1 - cos^2` has no digits left for small
    /// angles.
    fn density(&self, cos_theta_h: f64, sin_theta_h_sq: f64) -> f64;
}

/// Why parameters make no distribution.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
#[non_exhaustive]
pub enum NdfError {
    /// A parameter that must be positive and finite is not.
    #[error("`{name}` must be positive and finite, not {value}")]
    NotPositive {
        /// Name of the parameter.
        name: &'static str,
        /// Value given.
        value: f64,
    },
    /// The normalisation is not a positive finite number in double precision.
    #[error("these parameters cannot be normalised in double precision")]
    NotNormalisable,
    /// D is less than 1/pi at the normal.
    #[error(
        "the distribution is wider than one that is even, 1/pi: its peak is that of a slope parameter of {alpha:.3}"
    )]
    TooWide {
        /// Slope parameter of the peak, above 1.
        alpha: f64,
    },
}

pub(crate) fn positive(name: &'static str, value: f64) -> Result<f64, NdfError> {
    if value > 0.0 && value.is_finite() { Ok(value) } else { Err(NdfError::NotPositive { name, value }) }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use super::*;
    use crate::microfacet::{Anisotropic, Isotropic};
    use crate::stack::Distribution;

    /// Projected area by Simpson's rule over the angle, graded towards the normal.
    fn projected_area(ndf: &impl Ndf) -> f64 {
        let m = 20_000;
        let f = |i: u32| {
            let u = f64::from(i) / f64::from(m);
            let theta = 0.5 * PI * u * u * u;
            let (sin, cos) = (libm::sin(theta), libm::cos(theta));
            ndf.density(cos, sin * sin) * cos * sin * 2.0 * PI * 1.5 * PI * u * u
        };
        let sum: f64 = (1..m).map(|i| if i % 2 == 0 { 2.0 } else { 4.0 } * f(i)).sum::<f64>() + f(0) + f(m);
        sum / (3.0 * f64::from(m))
    }

    #[test]
    fn projected_areas_are_one() {
        for exponent in [1.0, 20.0, 3000.0] {
            let area = projected_area(&BlinnPhong::new(exponent).unwrap());
            assert!((area - 1.0).abs() < 1e-9, "Blinn-Phong {exponent}: {area}");
        }
        for (b, c) in [(1e-3, 2.0), (0.5, 1.0), (40.0, 1.5), (1e4, 1.2), (1e6, 0.7), (300.0, 2.0), (1e3, 40.0)] {
            let area = projected_area(&Abc::new(b, c).unwrap());
            assert!((area - 1.0).abs() < 1e-7, "ABC {b} {c}: {area}");
        }
        for (alpha, p) in [(1e-3, 0.7), (0.01, 1.2), (0.1, 0.5), (0.3, 2.0), (2.0, 1.0)] {
            let area = projected_area(&Sgd::new(alpha, p).unwrap());
            assert!((area - 1.0).abs() < 1e-7, "SGD {alpha} {p}: {area}");
        }
        for distribution in [Distribution::Beckmann, Distribution::Ggx, Distribution::Blinn] {
            let area = projected_area(&Isotropic::new(distribution, 0.1).unwrap());
            assert!((area - 1.0).abs() < 1e-9, "{distribution:?}: {area}");
        }
    }

    #[test]
    fn parameters_are_checked() {
        for bad in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            assert!(BlinnPhong::new(bad).is_err());
            assert!(Abc::new(bad, 1.0).is_err());
            assert!(Sgd::new(bad, 1.0).is_err() && Sgd::new(0.1, bad).is_err());
            assert!(Isotropic::new(Distribution::Ggx, bad).is_err());
            assert!(Anisotropic::new(Distribution::Ggx, 0.1, bad).is_err());
        }
    }
}
