//! The reflectance of the first interface as a polynomial.

use glam::DVec3;

use super::Row;
use crate::least_squares::solve;
use crate::models::lobes::{FirstInterface, Lobes};

/// A reflectance as a polynomial of u, the cube of 1 less the cosine of a facet: `f + u (p + u (q + (1 - f - p - q) u))`. For indices of 1.2 to 1.9 this is within .003 of
/// Fresnel's equations, where Schlick's form is within .03 to .11. It takes no root and no quotient.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Curve(pub [f64; 3]);

/// Cosines at which a reflectance is approximated.
const COSINES: u32 = 256;

/// The most that a curve may differ from a reflectance where it stands for it in forms of lobes that have a remainder.
const NEAR: f64 = 0.01;

impl Curve {
    /// The reflectance at the cosine of a facet.
    pub fn at(self, cos_theta_d: f64) -> f64 {
        let Self([f, p, q]) = self;
        let away = 1.0 - cos_theta_d;
        let cube = away * away * away;
        f + cube * (p + cube * (q + cube * (1.0 - f - p - q)))
    }

    /// The curve nearest to a reflectance, by least squares over the cosine. That of an index next to 1 leaves 0..=1, and is none.
    pub(super) fn nearest(reflectance: impl Fn(f64) -> f64) -> Option<Self> {
        let f = reflectance(1.0);
        let (mut matrix, mut right) = (vec![vec![0.0; 2]; 2], vec![0.0; 2]);
        for cos_theta in cosines() {
            let [without, p, q] =
                [[f, 0.0, 0.0], [f, 1.0, 0.0], [f, 0.0, 1.0]].map(|numbers| Self(numbers).at(cos_theta));
            let slopes = [p - without, q - without];
            for (row, own) in slopes.into_iter().enumerate() {
                right[row] += own * (reflectance(cos_theta) - without);
                (0..2).for_each(|column| matrix[row][column] += own * slopes[column]);
            }
        }
        let found = solve(matrix, right);
        let curve = Self([f, found[0], found[1]]);
        let ends = (0..=COSINES).map(|i| curve.at(f64::from(i) / f64::from(COSINES)));
        ends.into_iter().all(|reflected| (-1e-12..=1.0 + 1e-12).contains(&reflected)).then_some(curve)
    }

    /// The curve nearest to the mean of the channels of a first interface.
    pub(super) fn of(first: &FirstInterface) -> Option<Self> {
        Self::nearest(|cos_theta| first.reflectance.rgb(cos_theta).iter().sum::<f64>() / 3.0)
    }

    /// Whether all channels of a first interface are within [`NEAR`].
    fn is_near(self, first: &FirstInterface) -> bool {
        let within = |cos_theta| {
            let channels = first.reflectance.rgb(cos_theta);
            channels.iter().all(|reflected| (reflected - self.at(cos_theta)).abs() <= NEAR)
        };
        cosines().all(within)
    }
}

fn cosines() -> impl Iterator<Item = f64> {
    (0..COSINES).map(|i| (f64::from(i) + 0.5) / f64::from(COSINES))
}

impl Lobes {
    /// Lobes whose first interface reflects by a [`Curve`]. What that reflects too much or too little is taken from all light from below in proportion, so that energies stay those of
    /// the simulation. `None` for axes, a critical angle, and a reflectance that no curve is near to.
    #[must_use]
    pub fn of_curve(mut self) -> Option<Self> {
        let first = self.first.as_ref().filter(|_| self.frame.axes.is_none() && self.axis.critical().cot_sq == 0.0)?;
        let curve = Curve::of(first).filter(|curve| curve.is_near(first))?;
        let places = (0..self.rows.len()).map(|row| self.axis.cos_theta(row as f64));
        let excesses: Vec<[f64; 3]> = places.map(|cos| first.excess(seen_at(cos), curve)).collect();
        self.rows.iter_mut().zip(excesses).for_each(|(row, excess)| row.give(excess));
        self.frame.curve = Some(curve);
        Some(self)
    }
}

/// The eye at a cosine.
pub(super) fn seen_at(cos_theta: f64) -> DVec3 {
    DVec3::new(((1.0 - cos_theta) * (1.0 + cos_theta)).sqrt(), 0.0, cos_theta)
}

impl Row {
    /// Takes energy from all light from below, by channel. More than there is becomes albedo.
    fn give(&mut self, taken: [f64; 3]) {
        for (c, taken) in taken.into_iter().enumerate() {
            let below = self.wide[c] + self.lobes.iter().map(|lobe| lobe.strength[c] * lobe.share).sum::<f64>();
            let left = if below > 0.0 { (1.0 - taken / below).max(0.0) } else { 1.0 };
            self.albedo_dir[c] += taken - below * (1.0 - left);
            self.wide[c] *= left;
            self.lobes.iter_mut().for_each(|lobe| lobe.strength[c] *= left);
            if let Some(base) = &mut self.base {
                base.energy[c] *= left;
            }
        }
    }
}

impl FirstInterface {
    /// Energy that single facets send to `wo` by a curve less that by their own reflectance, by channel.
    pub(super) fn excess(&self, wo: DVec3, curve: Curve) -> [f64; 3] {
        let (own, other) = (self.energy(wo), self.energy_by(wo, |cos_theta| [curve.at(cos_theta); 3]));
        [0, 1, 2].map(|c: usize| other[c] - own[c])
    }
}

#[cfg(test)]
mod tests {
    use luthier_optics::dielectric_albedo::fresnel_dielectric;

    use super::*;
    use crate::models::lobes::rows::Lobe;

    /// The reflectance of an index next to 1 begins late, and a polynomial has waves below 0 before.
    #[test]
    fn curves_below_0_are_none() {
        let of = |index| Curve::nearest(|cos_theta| fresnel_dielectric(index, cos_theta)).is_some();
        assert!(of(1.1) && of(1.5) && of(2.5));
        assert!(!of(1.01));
    }

    /// Oracle: Fresnel's equations.
    #[test]
    fn a_curve_is_near_to_fresnels() {
        for (index, within) in [(1.2, 0.003), (1.5, 0.002), (1.9, 0.003)] {
            let curve = Curve::nearest(|cos_theta| fresnel_dielectric(index, cos_theta)).unwrap();
            for cos_theta in cosines() {
                let (found, expected) = (curve.at(cos_theta), fresnel_dielectric(index, cos_theta));
                assert!((found - expected).abs() < within, "{index} {cos_theta}: {found} {expected}");
            }
            let root = (index - 1.0) / (index + 1.0);
            assert!((curve.at(0.0) - 1.0).abs() < 1e-12 && (curve.at(1.0) - root * root).abs() < 1e-12);
        }
    }

    /// Energy that is given is missing below, in proportion; what is not there becomes albedo.
    #[test]
    fn rows_give_what_they_have() {
        let lobe =
            Lobe { strength: [1.0, 0.5, 0.0], share: 0.5, shift: 0.0, sharpness: [4.0; 2], shear: 0.0, tail: 1.0 };
        let mut row = Row { albedo_dir: [0.9, 0.6, 0.1], lobes: vec![lobe], wide: [0.25, 0.0, 0.0], base: None };
        row.give([0.075, 0.5, -0.02]);
        let close =
            |found: [f64; 3], expected: [f64; 3]| found.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-12);
        assert!(close(row.lobes[0].strength, [0.9, 0.0, 0.0]) && close(row.wide, [0.225, 0.0, 0.0]), "{row:?}");
        assert!(close(row.albedo_dir, [0.9, 0.85, 0.08]), "{row:?}");
    }
}
