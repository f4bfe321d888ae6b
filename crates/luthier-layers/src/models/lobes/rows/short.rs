//! Rows with one short lobe.

use glam::DVec3;

use super::curve::seen_at;
use super::{Curve, Lobe, Row, Shaping};
use crate::least_squares::solve;
use crate::models::lobes::half_vector::refracted;
use crate::models::lobes::leaving::{LEAVING_MIN, Leaving};
use crate::models::lobes::{Lobes, Wide};

/// One short lobe: all but its energy and its shift follows from the view, it has the tail of GGX, and no remainder is beside it. A row is the energy with the
/// shift, which is one read.
///
/// With s, the squared sine of the view, its sharpness is `a + b s + c s^2` along the plane of the eye, and `1 + rise s` times as much across it. The first interface
/// reflects by a [`Curve`].
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Short {
    /// The a, b and c of the sharpness.
    pub sharpness: [f64; 3],
    /// Growth of the ratio of the widths over the squared sine of the view.
    pub rise: f64,
}

/// Least share of the sharpness of a row that its curve may leave, and the inverse of the greatest.
const SHARE_MIN: f64 = 0.3;

/// The most widths that the middle of a lobe may be from the normal. Shaders sum terms of the square of that number, which cancel at the peak: it loses up to
/// four of the digits of f32 there.
const WIDTHS_MAX: f64 = 24.0;

impl Short {
    /// Number of the first of the parts of rows, which are those of [`OneWidth`](super::OneWidth) from there on. No other rows begin there.
    pub const FIRST_PART: i32 = 1;

    /// The numbers of rows with one lobe each, seen at these sines; `None` where the curves are not near enough to the rows. Least squares weigh by energies.
    fn of(rows: &[Row], sines: &[f64]) -> Option<Self> {
        let (mut matrix, mut right) = (vec![vec![0.0; 3]; 3], vec![0.0; 3]);
        let (mut sum, mut squares) = (0.0, 0.0);
        for (row, sin) in rows.iter().zip(sines) {
            let [lobe] = row.lobes.as_slice() else { return None };
            let (energy, s, [x, y]) =
                (lobe.strength.iter().sum::<f64>().max(0.0) * lobe.share, sin * sin, lobe.sharpness);
            // Relative to the sharpness of the row.
            let terms = [1.0 / x, s / x, s * s / x];
            for i in 0..3 {
                right[i] += energy * terms[i];
                (0..3).for_each(|j| matrix[i][j] += energy * terms[i] * terms[j]);
            }
            sum += energy * s * (y / x - 1.0);
            squares += energy * s * s;
        }
        if squares <= 0.0 {
            return None;
        }
        let found = solve(matrix, right);
        let short = Self { sharpness: [found[0], found[1], found[2]], rise: sum / squares };
        let is_near = rows.iter().zip(sines).all(|(row, sin)| {
            let (lobe, [along, across]) = (row.lobes[0], short.widths(sin * sin));
            let shares = [along / lobe.sharpness[0], across / lobe.sharpness[1]];
            shares.iter().all(|share| (SHARE_MIN..=1.0 / SHARE_MIN).contains(share))
                && (lobe.shift * sin * along).abs() <= WIDTHS_MAX
        });
        is_near.then_some(short)
    }

    /// Sharpness along the plane of the eye and across it, at a squared sine of the view.
    fn widths(self, s: f64) -> [f64; 2] {
        let [a, b, c] = self.sharpness;
        let along = a + s * (b + s * c);
        [along, along * (1.0 + self.rise * s)]
    }

    /// The lobe that a stored one is at this view.
    pub(super) fn shaped(self, stored: Lobe, sin_theta: f64) -> Lobe {
        Lobe { sharpness: self.widths(sin_theta * sin_theta), tail: 1.0, ..stored }
    }
}

impl Lobes {
    /// Lobes with one short lobe each, which keeps the energy of all light from below, and makes up for what the first interface reflects too much or too little.
    /// `None` where rows have another number of lobes, axes, a critical angle or a diffuse base, or where curves are not near enough, or no reflectance.
    #[must_use]
    pub fn of_short(mut self) -> Option<Self> {
        let first = self
            .first
            .as_ref()
            .filter(|_| self.frame.axes.is_none() && self.frame.base.is_none() && self.axis.critical().cot_sq == 0.0)?;
        let views: Vec<DVec3> = (0..self.rows.len()).map(|row| seen_at(self.axis.cos_theta(row as f64))).collect();
        let sines: Vec<f64> = views.iter().map(|view| view.x).collect();
        let curve = Curve::of(first)?;
        let short = Short::of(&self.rows, &sines)?;
        for (row, view) in self.rows.iter_mut().zip(&views) {
            let energies = row.energies();
            let excess = first.excess(*view, curve);
            let leaving = Leaving::new(refracted(*view, self.frame.index), self.frame.index);
            let stored = Lobe { sharpness: [1.0; 2], shear: 0.0, tail: 1.0, ..row.lobes[0] };
            let share = leaving.summed(&short.shaped(stored, view.x), view.x).clamp(LEAVING_MIN, 1.0);
            let energy = [0, 1, 2].map(|c: usize| energies[1][c] + energies[3][c] - excess[c]);
            // No light is below 0: what the interface reflects beyond that is in the albedo.
            (0..3).for_each(|c| row.albedo_dir[c] += (-energy[c]).max(0.0));
            row.lobes = vec![Lobe { share, strength: energy.map(|energy| energy.max(0.0) / share), ..stored }];
            row.wide = [0.0; 3];
        }
        self.frame.wide = Wide::new([0.0; 2], self.axis);
        self.frame.shaping = Shaping::Short(short);
        self.frame.curve = Some(curve);
        Some(self)
    }
}
