//! Rows over the view.

use luthier_optics::Rgb;

/// Power of the axis: `v = cos_theta^(1 / POWER)`. Between 1, which leaves grazing angles few nodes, and 2, which leaves the normal few.
const POWER: f64 = 1.5;

/// Grazing view of the first row, degrees: flatter ones are seen as this one.
const FLATTEST_DEG: f64 = 89.0;

/// The axis of rows over the view: nodes at equal distances in `c^(1/1.5)`, up to the normal.
///
/// c is the cosine of the view, from 89 degrees on. Where a smooth first interface reflects flat light totally, everything from below has
/// a kink at the critical angle; there c is the cosine of the refracted view, from 0 on.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ViewAxis {
    size: usize,
    critical_cot_sq: f64,
}

impl ViewAxis {
    /// An axis of so many nodes, at least two, for a first interface with the squared cotangent of a critical angle, or 0.
    pub fn new(size: usize, critical_cot_sq: f64) -> Self {
        Self { size: size.max(2), critical_cot_sq }
    }

    /// Number of nodes.
    pub fn size(self) -> usize {
        self.size
    }

    /// Squared cotangent of the critical angle; 0 without one.
    pub fn critical_cot_sq(self) -> f64 {
        self.critical_cot_sq
    }

    /// The cosine c of a direction.
    pub fn cosine(self, cos_theta: f64) -> f64 {
        let sin_sq = (1.0 - cos_theta) * (1.0 + cos_theta);
        (cos_theta * cos_theta - self.critical_cot_sq * sin_sq).clamp(0.0, 1.0).sqrt()
    }

    fn least(self) -> f64 {
        if self.critical_cot_sq > 0.0 { 0.0 } else { libm::pow(libm::cos(FLATTEST_DEG.to_radians()), 1.0 / POWER) }
    }

    /// Fractional number of the node of a view.
    pub fn place(self, cos_theta: f64) -> f64 {
        let least = self.least();
        let v = libm::pow(self.cosine(cos_theta), 1.0 / POWER);
        ((v - least) / (1.0 - least)).clamp(0.0, 1.0) * (self.size - 1) as f64
    }

    /// The view of a fractional number.
    pub fn cos_theta(self, place: f64) -> f64 {
        let least = self.least();
        let c = libm::pow(least + (1.0 - least) * place / (self.size - 1) as f64, POWER).min(1.0);
        ((c * c + self.critical_cot_sq) / (1.0 + self.critical_cot_sq)).sqrt()
    }
}

/// Energies and shapes at a view.
#[derive(Debug, Clone, PartialEq)]
pub struct Row {
    /// Directional albedo of one facet of the first interface.
    pub first_facet: Rgb,
    /// The lobes.
    pub lobes: Vec<Lobe>,
    /// Energy of the wide remainder.
    pub wide: Rgb,
}

/// A lobe at a view.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Lobe {
    /// Energy.
    pub energy: Rgb,
    /// Share of the shape above the horizon.
    pub share: f64,
    /// Shift of the middle over the sine of the view.
    pub shift: f64,
    /// Reciprocal widths in the plane of the eye and across it.
    pub sharpness: [f64; 2],
}

impl Row {
    /// The row between two others.
    pub(super) fn between(&self, other: &Self, t: f64) -> Self {
        let mix = |a: f64, b: f64| a + t * (b - a);
        let rgb = |a: Rgb, b: Rgb| [0, 1, 2].map(|c: usize| mix(a[c], b[c]));
        let lobe = |(a, b): (&Lobe, &Lobe)| Lobe {
            energy: rgb(a.energy, b.energy),
            share: mix(a.share, b.share),
            shift: mix(a.shift, b.shift),
            sharpness: [0, 1].map(|i: usize| mix(a.sharpness[i], b.sharpness[i])),
        };
        Self {
            first_facet: rgb(self.first_facet, other.first_facet),
            lobes: self.lobes.iter().zip(&other.lobes).map(lobe).collect(),
            wide: rgb(self.wide, other.wide),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_and_views_are_inverse() {
        let axis = ViewAxis::new(20, 0.0);
        for place in [0.0, 0.3, 7.5, 19.0] {
            for axis in [axis, ViewAxis::new(20, 1.25)] {
                assert!((axis.place(axis.cos_theta(place)) - place).abs() < 1e-6, "{axis:?} {place}");
            }
        }
        // From index 1.5 to 1: the critical angle has a sine of two thirds.
        let critical = ViewAxis::new(20, 1.25).cos_theta(0.0);
        assert!((critical * critical - 5.0 / 9.0).abs() < 1e-12);
        assert_eq!(axis.place(0.0), 0.0);
        assert!((axis.cos_theta(19.0) - 1.0).abs() < 1e-15);
        assert!((libm::acos(axis.cos_theta(0.0)).to_degrees() - 89.0).abs() < 1e-9);
    }
}
