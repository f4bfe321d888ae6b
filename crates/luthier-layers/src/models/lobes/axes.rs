//! Azimuths of the eye at which an anisotropic stack has rows.

use std::f64::consts::FRAC_PI_2;

use glam::DVec3;
use luthier_optics::stack::Stack;

use super::Row;

/// The tangents in which an anisotropic stack has its lobes, and the azimuths of its rows.
///
/// Half a turn takes every stack to itself, so rows cover half a circle. If all anisotropic interfaces have the same axes, the stack is also its own
/// mirror image in both of them, and a quarter of a circle is enough.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Axes {
    /// Cosine and sine of the angle from the tangent of the stack to the first axis.
    pub turn: [f64; 2],
    /// Whether the stack is its own mirror image in both axes.
    pub is_mirrored: bool,
}

/// Axes whose angles differ by no more than this count as the same, radians.
const ANGLE_MIN: f64 = 1e-6;

/// A in the formula of [`Axes::place`]: the slope of the place at the diagonal, over the tangent of the angle from it.
const BEND: f64 = 1.241;

/// Newton steps by which [`Axes::azimuth`] inverts that formula.
const NEWTON_STEPS: u32 = 6;

impl Axes {
    /// Number of tiles over the azimuth. Without mirror symmetry they span half a turn, so the last tile repeats the first.
    pub const TILES: usize = 8;

    /// The axes of the lowest anisotropic interface, whose lobes are the narrowest; `None` for an isotropic stack.
    pub fn of(stack: &Stack) -> Option<Self> {
        let anisotropic = stack.layers.iter().filter(|layer| layer.is_anisotropic());
        let rotations: Vec<f64> = anisotropic.map(|layer| layer.surface.rotation).collect();
        let last = *rotations.last()?;
        let is_mirrored = rotations.iter().all(|rotation| {
            let quarters = (rotation - last) / FRAC_PI_2;
            (quarters - libm::round(quarters)).abs() * FRAC_PI_2 <= ANGLE_MIN
        });
        let (sin, cos) = libm::sincos(last);
        Some(Self { turn: [cos, sin], is_mirrored })
    }

    /// Number of azimuths at which rows differ.
    pub(super) fn azimuths(self) -> usize {
        Self::TILES - usize::from(!self.is_mirrored)
    }

    /// A direction in the axes.
    pub fn inside(self, w: DVec3) -> DVec3 {
        let [cos, sin] = self.turn;
        DVec3::new(cos * w.x + sin * w.y, cos * w.y - sin * w.x, w.z)
    }

    /// The direction of one in the axes.
    pub fn outside(self, w: DVec3) -> DVec3 {
        let [cos, sin] = self.turn;
        DVec3::new(cos * w.x - sin * w.y, sin * w.x + cos * w.y, w.z)
    }

    /// Fractional number of the tile of a direction in the axes: in proportion to its azimuth, within .3 degrees.
    ///
    /// `v = (|y| - |x|) / (|y| + |x|)` is the tangent of the angle from the diagonal. `v (A + (1 - A) v^2)` is about that angle over an eighth of a
    /// circle, and shaders compute it without an arc tangent.
    pub fn place(self, x: f64, y: f64) -> f64 {
        let length = x.abs() + y.abs();
        if length == 0.0 {
            return 0.0;
        }
        let v = (y.abs() - x.abs()) / length;
        let quarter = 0.5 + 0.5 * v * (BEND + (1.0 - BEND) * v * v);
        let last = (Self::TILES - 1) as f64;
        if self.is_mirrored {
            quarter * last
        } else if x * y < 0.0 {
            (1.0 - 0.5 * quarter) * last
        } else {
            0.5 * quarter * last
        }
    }

    /// The row of a direction, between those of two tiles.
    pub fn row(self, wo: DVec3, of_tile: impl Fn(usize) -> Row) -> Row {
        let at = self.inside(wo);
        let place = self.place(at.x, at.y);
        let first = (place as usize).min(Self::TILES - 2);
        of_tile(first).between(&of_tile(first + 1), place - first as f64)
    }

    /// Cosine and sine of the azimuth of a place, in the axes.
    pub fn azimuth(self, place: f64) -> [f64; 2] {
        let quarters = place * if self.is_mirrored { 1.0 } else { 2.0 } / (Self::TILES - 1) as f64;
        let eighths = 2.0 * quarters.min(2.0 - quarters) - 1.0;
        let mut v = eighths;
        for _ in 0..NEWTON_STEPS {
            v -= (v * (BEND + (1.0 - BEND) * v * v) - eighths) / (BEND + 3.0 * (1.0 - BEND) * v * v);
        }
        let length = libm::hypot(1.0 - v, 1.0 + v);
        let x = if quarters > 1.0 { v - 1.0 } else { 1.0 - v };
        [x / length, (1.0 + v) / length]
    }

    /// Sign of a shear as seen from a direction in the axes. Quadrants share rows if the stack is a mirror image; a shear is odd in both axes.
    pub(super) fn sign(self, x: f64, y: f64) -> f64 {
        if self.is_mirrored && x * y < 0.0 { -1.0 } else { 1.0 }
    }
}

#[cfg(test)]
mod tests {
    use luthier_optics::ior::Ior;
    use luthier_optics::stack::{Base, Distribution, Layer, Surface};

    use super::*;

    fn stack(rotations: &[f64]) -> Stack {
        let layer = |rotation: &f64| Layer {
            films: vec![],
            surface: Surface { distribution: Distribution::Ggx, alpha_x: 0.1, alpha_y: 0.3, rotation: *rotation },
            base: Base::Conductor { ior: Ior::constant(0.2, 3.0).unwrap() },
        };
        Stack { exterior: Ior::vacuum(), layers: rotations.iter().map(layer).collect() }
    }

    #[test]
    fn places_and_azimuths_are_inverse() {
        for is_mirrored in [true, false] {
            let axes = Axes { turn: [1.0, 0.0], is_mirrored };
            for place in [1e-9, 0.3, 2.5, 3.5, 5.0, 6.9] {
                let [x, y] = axes.azimuth(place);
                assert!((libm::hypot(x, y) - 1.0).abs() < 1e-12 && y >= 0.0);
                for [x, y] in [[x, y], [-x, -y]] {
                    assert!((axes.place(0.3 * x, 0.3 * y) - place).abs() < 1e-12, "{axes:?} {place}");
                }
                if is_mirrored {
                    assert!((axes.place(-x, y) - place).abs() < 1e-12, "{place}");
                }
            }
            assert_eq!(axes.place(0.0, 0.0), 0.0);
            let [x, y] = axes.azimuth(if is_mirrored { 2.3 } else { 1.15 });
            assert!((libm::atan2(y, x) - 2.3 / 7.0 * FRAC_PI_2).abs() < 0.006, "{axes:?}");
            // Over the seam: the last tile is the first.
            assert!((axes.place(-1.0, 1e-9) - if is_mirrored { 0.0 } else { 7.0 }).abs() < 1e-6);
        }
    }

    #[test]
    fn axes_are_those_of_the_lowest_interface() {
        let axes = |rotations: &[f64]| Axes::of(&stack(rotations)).unwrap();
        assert!(axes(&[0.3]).is_mirrored && axes(&[0.3, 0.3 + 3.0 * FRAC_PI_2]).is_mirrored);
        let crossed = axes(&[0.3, 0.8]);
        assert!(!crossed.is_mirrored && (crossed.turn[0] - libm::cos(0.8)).abs() < 1e-12);
        let mut level = stack(&[0.4]);
        level.layers[0].surface.alpha_y = 0.1;
        assert_eq!(Axes::of(&level), None);
    }
}
