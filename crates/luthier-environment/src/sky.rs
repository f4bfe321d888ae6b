//! A sky by formula: a vertical gradient and two soft lights.

use crate::EnvironmentError;
use crate::error::setting;
use crate::vector::{dot, unit};

/// A smooth sky by formula: a vertical gradient and two soft lights. Radiance, linear RGB; +y is up.
///
/// The gradient is the quadratic in the height `y` of the direction that passes through the three colours at -1, 0 and
/// 1. A soft light is a von Mises-Fisher lobe. [`crate::Environment::sky`] makes a map of it.
///
/// ```
/// use luthier_environment::Sky;
///
/// let sky = Sky { zenith: [1.0; 3], ..Sky::uniform([0.0; 3]) };
/// assert_eq!(sky.radiance([0.0, 1.0, 0.0]), [1.0; 3]);
/// assert_eq!(sky.radiance([1.0, 0.0, 0.0]), [0.0; 3]);
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sky {
    /// Radiance straight down.
    pub ground: [f32; 3],
    /// Radiance at the horizon.
    pub horizon: [f32; 3],
    /// Radiance straight up.
    pub zenith: [f32; 3],
    /// Lights, large enough to be seen in reflections.
    pub lights: [SoftLight; 2],
}

/// A light with a soft edge: radiance `radiance exp(sharpness (cos - 1))` at an angle to its centre.
///
/// ```
/// use luthier_environment::{Sky, SoftLight};
///
/// let mut sky = Sky::uniform([0.0; 3]);
/// sky.lights[0] = SoftLight { direction: [0.0, 0.0, 1.0], sharpness: 100.0, radiance: [2.0; 3] };
/// assert_eq!(sky.radiance([0.0, 0.0, 1.0]), [2.0; 3]);
/// assert!(sky.radiance([0.0, 0.0, -1.0])[0] < 1e-9);
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SoftLight {
    /// Direction to the centre of the light, of any length.
    pub direction: [f32; 3],
    /// Concentration, 1 to 1e4: about `1 / spread^2` with the spread in radians.
    pub sharpness: f32,
    /// Radiance at the centre of the light.
    pub radiance: [f32; 3],
}

impl Sky {
    /// A sky of equal radiance from everywhere: the white furnace.
    pub fn uniform(radiance: [f32; 3]) -> Self {
        let dark = SoftLight { direction: [0.0, 1.0, 0.0], sharpness: 1.0, radiance: [0.0; 3] };
        Self { ground: radiance, horizon: radiance, zenith: radiance, lights: [dark; 2] }
    }

    /// Radiance from a unit direction.
    pub fn radiance(&self, direction: [f64; 3]) -> [f64; 3] {
        let y = direction[1];
        // Lagrange's weights of the three colours; they sum to 1.
        let weights = [0.5 * y * (y - 1.0), 1.0 - y * y, 0.5 * y * (y + 1.0)];
        let lobes = self.lights.map(|light| {
            let cosine = dot(unit(light.direction.map(f64::from)), direction);
            libm::exp(f64::from(light.sharpness) * (cosine - 1.0))
        });
        [0, 1, 2].map(|c| {
            let colors = [self.ground[c], self.horizon[c], self.zenith[c]];
            let gradient: f64 = colors.iter().zip(weights).map(|(color, weight)| f64::from(*color) * weight).sum();
            let lights = self.lights.iter().zip(lobes).map(|(light, lobe)| f64::from(light.radiance[c]) * lobe);
            gradient + lights.sum::<f64>()
        })
    }

    /// Concentration of its sharpest light that shines.
    pub(crate) fn sharpness(&self) -> f32 {
        let shining = self.lights.iter().filter(|light| light.radiance.iter().any(|v| *v > 0.0));
        shining.map(|light| light.sharpness).fold(1.0, f32::max)
    }

    pub(crate) fn check(&self) -> Result<(), EnvironmentError> {
        let colors = [self.ground, self.horizon, self.zenith, self.lights[0].radiance, self.lights[1].radiance];
        for color in colors {
            if !color.iter().all(|v| v.is_finite() && *v >= 0.0) {
                return Err(setting("sky", format!("{color:?}"), "radiances are finite and not negative"));
            }
        }
        for light in &self.lights {
            if !(1.0..=1e4).contains(&light.sharpness) {
                return Err(setting("sky.lights.sharpness", light.sharpness.to_string(), "between 1 and 1e4"));
            }
            check_direction("sky.lights.direction", light.direction)?;
        }
        Ok(())
    }
}

impl Default for Sky {
    /// A studio: dark floor, bright horizon, a large soft light above on the right, a smaller one behind on the left.
    fn default() -> Self {
        Self {
            ground: [0.03, 0.028, 0.026],
            horizon: [0.32, 0.32, 0.325],
            zenith: [0.14, 0.155, 0.18],
            lights: [
                SoftLight { direction: [0.65, 0.6, 0.5], sharpness: 28.0, radiance: [3.6, 3.5, 3.35] },
                SoftLight { direction: [-0.95, 0.15, -0.3], sharpness: 22.0, radiance: [2.2, 2.35, 2.6] },
            ],
        }
    }
}

/// Integral of `exp(k (cos - 1))` over the sphere.
#[cfg(test)]
pub(crate) fn lobe_integral(sharpness: f64) -> f64 {
    2.0 * std::f64::consts::PI * (1.0 - libm::exp(-2.0 * sharpness)) / sharpness
}

fn check_direction(name: &'static str, v: [f32; 3]) -> Result<(), EnvironmentError> {
    let length_sq: f32 = v.iter().map(|x| x * x).sum();
    if length_sq.is_normal() { Ok(()) } else { Err(setting(name, format!("{v:?}"), "a finite direction, not zero")) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn gradient_takes_its_three_colours() {
        let sky = Sky { lights: Sky::uniform([0.0; 3]).lights, ..Sky::default() };
        for (y, color) in [(-1.0, sky.ground), (0.0, sky.horizon), (1.0, sky.zenith)] {
            let x = f64::sqrt(1.0 - y * y);
            let got = sky.radiance([x, y, 0.0]);
            (0..3).for_each(|c| assert!((got[c] - f64::from(color[c])).abs() < 1e-6, "{y}: {got:?}"));
        }
    }

    #[test]
    fn nonsense_is_refused() {
        let mut sky = Sky::default();
        sky.lights[1].sharpness = 0.0;
        assert!(sky.check().is_err());
        sky = Sky::default();
        sky.lights[0].direction = [0.0; 3];
        assert!(sky.check().is_err());
        sky = Sky::default();
        sky.zenith[0] = f32::NAN;
        assert!(sky.check().is_err());
        assert!(Sky::default().check().is_ok());
    }
}
