//! Rows with one lobe of one width.

use glam::DVec3;

use super::{Lobe, Row, Shaping};
use crate::models::lobes::Lobes;
use crate::models::lobes::half_vector::refracted;
use crate::models::lobes::leaving::{LEAVING_MIN, Leaving};

/// Rows with one lobe of one width: its sharpness across the plane of the eye is that along it times `1 + rise sin^2` of the view, and all have one tail. Along
/// the normal a lobe is round, and away from it stretched, in fits by a factor that follows the squared sine. Rows then have the sharpness along the plane
/// over the root of the tail, in both places, and a tail of 1.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct OneWidth {
    /// Growth of the factor over the squared sine of the view.
    pub rise: f64,
    /// 1 over the tail, as [`Row::inverse_tails`] has it.
    pub inverse_tail: f64,
}

/// Least factor at flat views.
const FACTOR_MIN: f64 = 0.1;

impl OneWidth {
    /// Rise and tail of rows with at most one lobe in the plane of the eye, seen at these sines: by least squares, weighed by energies.
    pub fn of(rows: &[Row], sines: &[f64]) -> Option<Self> {
        if rows.iter().any(|row| row.lobes.len() > 1) {
            return None;
        }
        let (mut sum, mut squares) = (0.0, 0.0);
        for (lobe, sin) in rows.iter().zip(sines).filter_map(|(row, sin)| Some((row.lobes.first()?, sin))) {
            let (energy, square) = (lobe.strength.iter().sum::<f64>() * lobe.share, sin * sin);
            sum += energy * square * (lobe.sharpness[1] / lobe.sharpness[0] - 1.0);
            squares += energy * square * square;
        }
        let rise = if squares > 0.0 { (sum / squares).max(FACTOR_MIN - 1.0) } else { 0.0 };
        let inverse_tail = rows.first().map_or(0.0, |row| row.inverse_tails()[0]).max(1.0);
        Some(Self { rise, inverse_tail })
    }

    /// The lobe of a row in this form, with both widths multiplied by one factor so that it is as dense as it was.
    fn stored(self, lobe: Lobe, sin_theta: f64) -> Lobe {
        let [x, y] = lobe.sharpness;
        let along = (x * y / (self.factor(sin_theta) * self.inverse_tail)).sqrt();
        Lobe { sharpness: [along; 2], tail: 1.0, ..lobe }
    }

    /// The lobe that a stored one is at this view. Among rows of two widths its width stands in the place of a shear, too.
    pub(super) fn shaped(self, stored: Lobe, sin_theta: f64) -> Lobe {
        let along = stored.sharpness[0] * self.inverse_tail.sqrt();
        Lobe { sharpness: [along, along * self.factor(sin_theta)], shear: 0.0, tail: 1.0 / self.inverse_tail, ..stored }
    }

    fn factor(self, sin_theta: f64) -> f64 {
        1.0 + self.rise * sin_theta * sin_theta
    }
}

impl Lobes {
    /// Lobes with [`OneWidth`], each with the energy that it had. `None` with two lobes or axes.
    #[must_use]
    pub fn of_one_width(mut self) -> Option<Self> {
        let place = |row: usize| self.axis.cos_theta(row as f64);
        let sines: Vec<f64> = (0..self.rows.len()).map(place).map(|cos| ((1.0 - cos) * (1.0 + cos)).sqrt()).collect();
        let one_width = OneWidth::of(&self.rows, &sines).filter(|_| self.frame.axes.is_none())?;
        for (row, sin) in self.rows.iter_mut().zip(&sines) {
            let leaving = Leaving::new(
                refracted(DVec3::new(*sin, 0.0, (1.0 - sin * sin).max(0.0).sqrt()), self.frame.index),
                self.frame.index,
            );
            for lobe in &mut row.lobes {
                let stored = one_width.stored(*lobe, *sin);
                let share = leaving.summed(&one_width.shaped(stored, *sin), *sin).clamp(LEAVING_MIN, 1.0);
                *lobe = Lobe { share, strength: lobe.strength.map(|strength| strength * lobe.share / share), ..stored };
            }
        }
        self.frame.shaping = Shaping::OneWidth(one_width);
        Some(self)
    }
}
