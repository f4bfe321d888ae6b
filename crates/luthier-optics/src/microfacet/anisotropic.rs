//! Beckmann and GGX with two slope parameters.

use glam::DVec3;

use super::lambda;
use crate::ndf::{NdfError, positive};
use crate::stack::{Distribution, Surface};

/// The isotropic distribution of alpha 1 with its slopes stretched by `alpha_x` and `alpha_y`.
///
/// Beckmann: Ward 1992 as normalised by Heitz 2014, eq. 81. GGX: Burley 2012, eq. 13; Heitz 2014, eq. 85.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Anisotropic {
    distribution: Distribution,
    alpha_x: f64,
    alpha_y: f64,
}

impl Anisotropic {
    /// The distribution of slope parameters along the tangent (x) and the bitangent (y). GGX stands in for distributions that no
    /// stretching makes from alpha 1 ([`Distribution::walked`]).
    ///
    /// # Errors
    /// [`NdfError::NotPositive`] unless both are positive and finite.
    pub fn new(distribution: Distribution, alpha_x: f64, alpha_y: f64) -> Result<Self, NdfError> {
        let distribution = distribution.walked();
        Ok(Self { distribution, alpha_x: positive("alpha_x", alpha_x)?, alpha_y: positive("alpha_y", alpha_y)? })
    }

    /// The distribution of a surface in the frame of its layer; the caller rotates directions into it (see [`to_layer`]).
    ///
    /// # Errors
    /// [`NdfError::NotPositive`] for a surface that is smooth along a tangent.
    pub fn of(surface: &Surface) -> Result<Self, NdfError> {
        Self::new(surface.distribution, surface.alpha_x, surface.alpha_y)
    }

    /// Kind of slopes.
    pub fn kind(&self) -> Distribution {
        self.distribution
    }

    /// Slope parameters along tangent and bitangent.
    pub fn alphas(&self) -> [f64; 2] {
        [self.alpha_x, self.alpha_y]
    }

    /// D in 1/sr at a unit micro-normal; 0 for `wh.z <= 0`. Takes sines from the tangent components, so it keeps its digits at the
    /// peak of small alphas.
    pub fn density(&self, wh: DVec3) -> f64 {
        if wh.z <= 0.0 {
            return 0.0;
        }
        let (x, y) = (wh.x / self.alpha_x, wh.y / self.alpha_y);
        scaled_density(self.distribution, wh.z, x * x + y * y) / (std::f64::consts::PI * self.alpha_x * self.alpha_y)
    }

    /// Slope parameter seen along the azimuth of a direction (Heitz 2014, eq. 80).
    pub fn alpha_along(&self, w: DVec3) -> f64 {
        let across = w.x * w.x + w.y * w.y;
        if across == 0.0 {
            return libm::sqrt(self.alpha_x * self.alpha_y);
        }
        let (x, y) = (self.alpha_x * w.x, self.alpha_y * w.y);
        libm::sqrt((x * x + y * y) / across)
    }

    /// Smith's Lambda for a unit direction with `w.z >= 0` (infinite at 0).
    pub fn lambda(&self, w: DVec3) -> f64 {
        lambda(self.distribution, self.alpha_along(w), w.z)
    }
}

/// pi alpha_x alpha_y D from the cosine and sin^2 over the squared alphas.
fn scaled_density(distribution: Distribution, cos: f64, scaled_sin_sq: f64) -> f64 {
    let cos_sq = cos * cos;
    match distribution {
        Distribution::Beckmann => libm::exp(-scaled_sin_sq / cos_sq) / (cos_sq * cos_sq),
        _ => {
            let sum = cos_sq + scaled_sin_sq;
            1.0 / (sum * sum)
        }
    }
}

/// A direction of the surface's frame in that of a layer whose tangent is turned by `rotation` radians, counter-clockwise.
pub fn to_layer(rotation: f64, w: DVec3) -> DVec3 {
    let (sin, cos) = (libm::sin(rotation), libm::cos(rotation));
    DVec3::new(cos * w.x + sin * w.y, cos * w.y - sin * w.x, w.z)
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use super::*;

    const BOTH: [Distribution; 2] = [Distribution::Beckmann, Distribution::Ggx];

    /// The integral of D times a function of the normal, in polar slopes over the alphas: r through its arc tangent.
    fn integral(ndf: &Anisotropic, f: impl Fn(DVec3) -> f64) -> f64 {
        let (radii, azimuths) = (600, 512);
        let [alpha_x, alpha_y] = ndf.alphas();
        let mut sum = 0.0;
        for i in 0..radii {
            let u = (f64::from(i) + 0.5) / f64::from(radii);
            let r = libm::tan(0.5 * PI * u);
            for j in 0..azimuths {
                let phi = 2.0 * PI * (f64::from(j) + 0.5) / f64::from(azimuths);
                let wh = DVec3::new(-alpha_x * r * libm::cos(phi), -alpha_y * r * libm::sin(phi), 1.0).normalize();
                // Solid angle is cos^3 times the area of slopes.
                let measure = alpha_x * alpha_y * r * (1.0 + r * r) * wh.z * wh.z * wh.z;
                sum += ndf.density(wh) * f(wh) * measure;
            }
        }
        sum * PI * PI / f64::from(radii * azimuths)
    }

    #[test]
    fn projected_area_is_one() {
        for distribution in BOTH {
            for (alpha_x, alpha_y) in [(0.005, 0.3), (0.2, 0.2), (1.0, 0.1)] {
                let ndf = Anisotropic::new(distribution, alpha_x, alpha_y).unwrap();
                let area = integral(&ndf, |wh| wh.z);
                assert!((area - 1.0).abs() < 1e-5, "{distribution:?} {alpha_x} {alpha_y}: {area}");
            }
        }
    }

    #[test]
    fn smith_matches_projected_visible_area() {
        for distribution in BOTH {
            let ndf = Anisotropic::new(distribution, 0.6, 0.15).unwrap();
            for (cos, phi) in [(0.9, 0.3), (0.3, 0.0), (0.3, 1.2), (0.1, 0.8)] {
                let sin = libm::sqrt(1.0 - cos * cos);
                let w = DVec3::new(sin * libm::cos(phi), sin * libm::sin(phi), cos);
                let visible = integral(&ndf, |wh| wh.dot(w).max(0.0)) / (1.0 + ndf.lambda(w));
                assert!((visible - cos).abs() < 2e-5, "{distribution:?} {cos} {phi}: {visible}");
            }
        }
    }

    #[test]
    fn equal_alphas_are_isotropic() {
        for distribution in BOTH {
            let ndf = Anisotropic::new(distribution, 0.3, 0.3).unwrap();
            let wh = DVec3::new(0.2, -0.3, 0.8).normalize();
            let isotropic = super::super::distribution(distribution, 0.3, wh.z, wh.x * wh.x + wh.y * wh.y);
            assert!((ndf.density(wh) / isotropic - 1.0).abs() < 1e-14);
        }
    }

    #[test]
    fn a_turned_layer_sees_a_turned_direction() {
        let w = to_layer(0.5 * PI, DVec3::Y);
        assert!((w - DVec3::X).length() < 1e-15);
    }
}
