//! Slope parameters of the interfaces of a family at a place, along two tangents.

use luthier_optics::stack::Surface;

use super::Family;
use crate::layers::ALPHA_MIN;

/// Slope parameters of an interface at a place.
///
/// Rows of a family are those of isotropic interfaces. An anisotropic one reads the row of the mean of its two slope parameters, and its lobes are stretched:
/// their squared widths are multiplied by a matrix ([`Stretch`]).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Slopes {
    /// Slope parameters along the tangent and the bitangent of the interface.
    pub along: [f64; 2],
    /// Cosine and sine of the angle from the tangent of the surface to that of the interface.
    pub turn: [f64; 2],
}

/// For each lobe a symmetric matrix in tangents, by which its squared widths are multiplied: along x, along y, and between them.
pub type Stretch = [[f64; 3]; 2];

impl From<f64> for Slopes {
    /// An isotropic interface.
    fn from(alpha: f64) -> Self {
        Self { along: [alpha; 2], turn: [1.0, 0.0] }
    }
}

impl From<Surface> for Slopes {
    fn from(surface: Surface) -> Self {
        let (sin, cos) = libm::sincos(surface.rotation);
        Self { along: [surface.alpha_x, surface.alpha_y], turn: [cos, sin] }
    }
}

impl Slopes {
    /// The slope parameter whose row it reads: the mean of both, each within the range of layer records.
    pub fn mean(self) -> f64 {
        let [x, y] = self.clamped().along;
        0.5 * (x + y)
    }

    fn clamped(self) -> Self {
        Self { along: self.along.map(|alpha| alpha.clamp(ALPHA_MIN, 1.0)), ..self }
    }

    /// Both slope parameters times a factor.
    #[must_use]
    pub fn scaled(self, factor: f64) -> Self {
        Self { along: self.along.map(|alpha| alpha * factor), ..self }
    }

    /// These slope parameters along another tangent, by cosine and sine of its angle.
    #[must_use]
    pub fn turned(self, turn: [f64; 2]) -> Self {
        Self { turn, ..self }
    }

    /// A surface with these slope parameters.
    pub(super) fn on(self, surface: Surface) -> Surface {
        let ([alpha_x, alpha_y], [cos, sin]) = (self.along, self.turn);
        let rotation = if alpha_x == alpha_y { 0.0 } else { libm::atan2(sin, cos) };
        Surface { alpha_x, alpha_y, rotation, ..surface }
    }

    /// Squared slope parameters as a matrix in tangents.
    fn squares(self) -> [f64; 3] {
        let ([x, y], [cos, sin]) = (self.along.map(|alpha| alpha * alpha), self.turn);
        [cos * cos * x + sin * sin * y, sin * sin * x + cos * cos * y, cos * sin * (x - y)]
    }
}

impl Family {
    /// The stretch of both lobes, for slope parameters of coat and base; `None` where both are isotropic. Squared widths of a lobe are in proportion to the sum of
    /// the squared slope parameters that [`Self::spreads`] names.
    pub fn stretch(self, slopes: [Slopes; 2]) -> Option<Stretch> {
        let slopes = if self.is_coated() { slopes } else { [Slopes::from(0.0), slopes[1]] }.map(Slopes::clamped);
        if slopes.iter().all(|slopes| slopes.along[0] == slopes.along[1]) {
            return None;
        }
        // Slope parameters beyond the range of the rows are held to it, as those of isotropic interfaces are.
        let held = self.held(slopes.map(Slopes::mean));
        let [coat, base] = [0, 1].map(|i: usize| slopes[i].scaled(held[i] / slopes[i].mean()).squares());
        let [of_coat, of_base] = held.map(|alpha| alpha * alpha);
        Some([(BASE_ONCE, COAT_ONCE), (BASE_MORE, COAT_MORE)].map(|(by_base, by_coat)| {
            let whole = by_base * of_base + by_coat * of_coat;
            [0, 1, 2].map(|i: usize| (by_base * base[i] + by_coat * coat[i]) / whole)
        }))
    }

    /// Slope parameters about as wide as the lobes: of light that the base reflects once, and more often. Rows have the slopes of lobes over these.
    pub fn spreads([coat, base]: [f64; 2]) -> [f64; 2] {
        let [coat, base] = [coat * coat, base * base];
        let once = BASE_ONCE * base + COAT_ONCE * coat;
        let more = BASE_MORE * base + COAT_MORE * coat;
        [once.sqrt(), more.sqrt().min(1.0)]
    }
}

/// Shares of the squared slope parameters of base and coat in the squared width of light that the base reflected once.
const BASE_ONCE: f64 = 1.0;
const COAT_ONCE: f64 = 0.09;

/// Those of light that it reflected more often.
const BASE_MORE: f64 = 4.84;
const COAT_MORE: f64 = 1.0;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::models::lobes::SlopeAxis;

    const FAMILY: Family = Family {
        coat: SlopeAxis { least: 0.01, most: 0.8, nodes: 5 },
        base: SlopeAxis { least: 0.01, most: 1.0, nodes: 8 },
        interface: 1,
        is_metallic: true,
        is_tinted: false,
        has_tail: false,
        sent_back: [0.0; 3],
        has_lengths: false,
    };

    /// Oracle: by hand. An isotropic coat of .2 over a base of .1 and .3 whose tangent is turned by a quarter of a circle.
    #[test]
    fn squared_widths_are_sums() {
        let base = Slopes { along: [0.1, 0.3], turn: [0.0, 1.0] };
        let [once, more] = FAMILY.stretch([0.2.into(), base]).unwrap();
        let expected = [[0.09 + 0.0036, 0.01 + 0.0036], [4.84 * 0.09 + 0.04, 4.84 * 0.01 + 0.04]];
        for (found, (expected, whole)) in
            [once, more].iter().zip(expected.iter().zip([0.04 + 0.0036, 4.84 * 0.04 + 0.04]))
        {
            assert!((found[0] - expected[0] / whole).abs() < 1e-12, "{found:?}");
            assert!((found[1] - expected[1] / whole).abs() < 1e-12 && found[2].abs() < 1e-12, "{found:?}");
        }
        assert_eq!(FAMILY.stretch([0.2.into(), 0.3.into()]), None);
        // Beyond the range both are held to it, in their ratio.
        let family = Family { base: SlopeAxis { most: 0.1, ..FAMILY.base }, ..FAMILY };
        let [wide, _] = family.stretch([0.2.into(), base]).unwrap();
        assert!((wide[0] - (0.0225 + 0.0036) / (0.01 + 0.0036)).abs() < 1e-12, "{wide:?}");
    }
}
