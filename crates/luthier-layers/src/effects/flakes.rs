//! Metal flakes in a coat, each with its own normal.

use std::f64::consts::PI;

use glam::{DVec2, DVec3};

use crate::model::{Claims, Input, Inputs, Kind, Model, ModelInfo};
use crate::models::elek::Elek;
use crate::monochrome::Monochrome;
use crate::noise::hash;

/// Flakes below the first interface, one per cell of a grid, each with its own normal (Elek 2010, section 4.1).
///
/// ```
/// use luthier_layers::effects::flakes::FlakeMean;
/// use luthier_layers::glam::{DVec2, DVec3};
///
/// let flakes = FlakeMean::default().flakes;
/// let tilt = |distance: f64| flakes.normal(DVec2::new(0.3, 0.7), distance).dot(DVec3::Z).acos();
/// // Flakes fade out with distance: the normal turns back to that of the surface.
/// assert!(tilt(1.0) > 2.0 * tilt(9.0) && tilt(1e9) < 1e-6);
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Flakes {
    /// Seed of the flakes.
    pub seed: u32,
    /// Cells along one repeat.
    pub count: u32,
    /// Repeats per unit of texture coordinate.
    pub tiling: f64,
    /// Standard deviation of the flakes' slope angle, radians.
    pub spread: f64,
    /// Weight of the flakes' normal against the surface's.
    pub scale: f64,
    /// Distance from the eye up to which flakes keep their full weight; the paper's is 1. Above 0.
    pub fade_start: f64,
}

impl Flakes {
    /// The normal of the flake at a texture coordinate, unit: its slope angle is normal with deviation `spread`.
    pub fn flake(&self, uv: DVec2) -> DVec3 {
        let count = i64::from(self.count.max(1));
        let [x, y] = (uv * self.tiling)
            .to_array()
            .map(|repeat| hash::floor((repeat - repeat.floor()) * count as f64).clamp(0, count - 1));
        let cell = hash::cell(self.seed, x, y);
        // Box and Muller.
        let radius = libm::sqrt(-2.0 * libm::log(1.0 - hash::unit(cell, 0)));
        let angle = (self.spread * radius * libm::cos(2.0 * PI * hash::unit(cell, 1))).clamp(-0.5 * PI, 0.5 * PI);
        let phi = PI * hash::unit(cell, 2);
        let sin = libm::sin(angle);
        DVec3::new(sin * libm::cos(phi), sin * libm::sin(phi), libm::cos(angle))
    }

    /// The normal that the layers below see from a distance: `normalize(z + max(distance / fade_start, 1) z + scale m)`, m the
    /// flake's. The flakes fade out with distance as more of them share a pixel.
    ///
    /// The paper's code adds both further terms to the surface's normal z (`N += ...`); its text has these two terms alone. With the code, a flake of
    /// scale 1 that is tilted by a small angle tilts the lobe below by a third of it; with the text it would be half.
    pub fn normal(&self, uv: DVec2, distance: f64) -> DVec3 {
        self.tilted(self.flake(uv), distance)
    }

    /// [`Self::normal`] for a known normal of the flake.
    pub fn tilted(&self, flake: DVec3, distance: f64) -> DVec3 {
        let weight = 1.0 + (distance / self.fade_start).max(1.0);
        (DVec3::new(0.0, 0.0, weight) + self.scale * flake).normalize_or(DVec3::Z)
    }

    /// The normal of a texel of a height field, from the heights of its neighbours to the left, to the right, above and below (rows count
    /// down, against the bitangent): central differences over two texels of the given sides, in units of the heights.
    pub fn of_heights([left, right, above, below]: [f64; 4], [width, height]: [f64; 2]) -> DVec3 {
        let (along, across) = ((right - left) / (2.0 * width), (above - below) / (2.0 * height));
        DVec3::new(-along, -across, 1.0).normalize()
    }

    /// `f cos_theta_i` of Elek's model with the flakes at a texture coordinate, seen from a distance. The flake tilts the layers below the first
    /// interface and nothing else.
    pub fn eval(&self, stack: &Monochrome, uv: DVec2, distance: f64, wi: DVec3, wo: DVec3) -> f64 {
        Elek::default().eval_tinted(stack, [1.0; 2], wi, wo, self.normal(uv, distance))
    }
}

/// Many flakes at once, as one pixel shows them: the mean over the first cells of the grid.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FlakeMean {
    /// The flakes.
    pub flakes: Flakes,
    /// Number of flakes.
    pub samples: u32,
    /// Distance of the eye.
    pub distance: f64,
}

/// The one flake at a place, as a model.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FlakeAt {
    /// The flakes.
    pub flakes: Flakes,
    /// Texture coordinate of the place.
    pub uv: DVec2,
    /// Distance of the eye.
    pub distance: f64,
}

impl Default for FlakeMean {
    /// 256 flakes of the paper's weight, 0.2 radians of spread.
    fn default() -> Self {
        let flakes = Flakes { seed: 0, count: 256, tiling: 1.0, spread: 0.2, scale: 1.0, fade_start: 1.0 };
        Self { flakes, samples: 256, distance: 0.0 }
    }
}

impl Model for FlakeMean {
    fn info(&self) -> ModelInfo {
        ModelInfo {
            name: "flakes",
            kind: Kind::Place,
            claims: Claims::RECIPROCAL,
            source: "Elek 2010, section 4.1",
            domain: "a tinted coat over a metal; flakes of 0.2 rad spread: the one at a place, or the mean over 256",
            leaves_out: "what Elek's model leaves out; light that passes from one flake to another",
            inputs: &[Input::Uv, Input::Distance],
        }
    }

    fn eval(&self, stack: &Monochrome, wi: DVec3, wo: DVec3) -> f64 {
        let count = f64::from(self.flakes.count.max(1));
        let sum: f64 = (0..self.samples)
            .map(|i| {
                let (x, y) = (f64::from(i % self.flakes.count.max(1)), f64::from(i / self.flakes.count.max(1)));
                let uv = DVec2::new(x + 0.5, y + 0.5) / (count * self.flakes.tiling);
                self.flakes.eval(stack, uv, self.distance, wi, wo)
            })
            .sum();
        if self.samples == 0 { 0.0 } else { sum / f64::from(self.samples) }
    }

    fn with_inputs(&self, inputs: &Inputs) -> Option<Box<dyn Model>> {
        let (flakes, distance) = (self.flakes, inputs.distance.unwrap_or(self.distance));
        Some(match inputs.uv {
            Some(uv) => Box::new(FlakeAt { flakes, uv, distance }),
            None => Box::new(Self { distance, ..*self }),
        })
    }
}

impl Model for FlakeAt {
    fn info(&self) -> ModelInfo {
        FlakeMean::default().info()
    }

    fn eval(&self, stack: &Monochrome, wi: DVec3, wo: DVec3) -> f64 {
        self.flakes.eval(stack, self.uv, self.distance, wi, wo)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const FLAKES: Flakes = Flakes { seed: 5, count: 64, tiling: 10.0, spread: 0.2, scale: 1.0, fade_start: 1.0 };

    #[test]
    fn slope_angles_have_the_stated_deviation() {
        let angles: Vec<f64> = (0..64)
            .flat_map(|x| (0..64).map(move |y| DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5) / 640.0))
            .map(|uv| libm::acos(FLAKES.flake(uv).z))
            .collect();
        let variance = angles.iter().map(|a| a * a).sum::<f64>() / angles.len() as f64;
        // Standard error of the deviation of 4096 normal numbers: 1/sqrt(2 n) = 1.1%.
        assert!((libm::sqrt(variance) / 0.2 - 1.0).abs() < 0.045, "{variance}");
    }

    /// Oracle: a plane, whose normal is that of its gradient.
    #[test]
    fn normals_of_heights_are_those_of_planes() {
        let (slope_x, slope_y, width, height) = (0.3, -0.2, 0.01, 0.02);
        // Above is towards +y.
        let at = |x: f64, y: f64| 0.5 + slope_x * x * width + slope_y * y * height;
        let found = Flakes::of_heights([at(-1.0, 0.0), at(1.0, 0.0), at(0.0, 1.0), at(0.0, -1.0)], [width, height]);
        assert!((found - DVec3::new(-slope_x, -slope_y, 1.0).normalize()).length() < 1e-12, "{found}");
    }

    #[test]
    fn flakes_repeat_and_fade() {
        let uv = DVec2::new(0.0123, 0.0456);
        assert!((FLAKES.flake(uv) - FLAKES.flake(uv + DVec2::new(0.1, -0.3))).length() < 1e-12);
        let tilt = |distance| libm::acos(FLAKES.normal(uv, distance).z);
        assert_eq!(tilt(0.2), tilt(1.0));
        assert!(tilt(2.0) < tilt(1.0) && tilt(1e6) < 1e-5);
        // N += max(distance, 1) z + m with N = z: tangents of 2 z + m, and of 6 z + m at distance 5.
        let m = FLAKES.flake(uv);
        let tangent = libm::hypot(m.x, m.y);
        assert!((libm::tan(tilt(1.0)) - tangent / (2.0 + m.z)).abs() < 1e-12);
        assert!((libm::tan(tilt(5.0)) - tangent / (6.0 + m.z)).abs() < 1e-12);
    }
}
