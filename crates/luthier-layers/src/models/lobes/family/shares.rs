//! Shares above the horizon of lobes whose tails are not those of GGX: rows have what an estimate lacks.

use glam::DVec3;

use super::Family;
use super::texels::DARK;
use crate::models::lobes::half_vector::refracted;
use crate::models::lobes::leaving::Leaving;
use crate::models::lobes::{Lobe, Lobes, Row};

/// Part by which a share between rows may be less than that of the shape there. Such lobes have less than two fifths of the light: a fifth of a hundredth more leaves.
const LACK: f64 = 5e-3;

impl Family {
    /// Raises shares of rows so that half way between views and nodes none is less than that of the shape there: no light comes from interpolation.
    pub(in crate::models::lobes) fn hold_shares(self, nodes: &mut [Lobes]) {
        let (axis, index) = (nodes[0].axis, nodes[0].frame.index);
        let halves = |count: usize| (0..2 * count - 1).map(|i| (i / 2, i % 2));
        let grid = halves(self.coat.nodes).flat_map(|coat| {
            halves(self.base.nodes).flat_map(move |base| halves(axis.size()).map(move |view| [coat, base, view]))
        });
        for place in grid.filter(|place| place.iter().any(|(_, half)| *half > 0)) {
            let [coat, base, view] = place.map(|(node, half)| node as f64 + 0.5 * half as f64);
            let ends = place.map(|(node, half)| if half > 0 { vec![node, node + 1] } else { vec![node] });
            let [coats, bases, views] = &ends;
            let corners: Vec<(usize, usize)> = (coats.iter())
                .flat_map(|coat| bases.iter().map(move |base| coat * self.base.nodes + base))
                .flat_map(|node| views.iter().map(move |view| (node, *view)))
                .collect();
            let cos_theta = axis.cos_theta(view);
            let wo = DVec3::new(((1.0 - cos_theta) * (1.0 + cos_theta)).max(0.0).sqrt(), 0.0, cos_theta);
            let leaving = Leaving::new(refracted(wo, index), index);
            let spreads = Self::spreads([self.coat.alpha(coat), self.base.alpha(base)]);
            for (lobe, spread) in spreads.into_iter().enumerate() {
                let here = spread_by(mean_of(corners.iter().map(|&(node, row)| &nodes[node].rows[row]), lobe), spread);
                let wanted = leaving.summed(&here, wo.x) / leaving.in_plane(&here, wo.x);
                let lack = wanted * (1.0 - LACK) - here.share;
                if lack > 0.0 {
                    corners.iter().for_each(|&(node, row)| nodes[node].rows[row].lobes[lobe].share += lack);
                }
            }
        }
    }
}

/// The lobe half way between rows, as shaders have it.
fn mean_of<'a>(rows: impl Iterator<Item = &'a Row> + Clone, lobe: usize) -> Lobe {
    let count = rows.clone().count() as f64;
    let lobes = rows.map(|row| row.lobes[lobe]);
    let first = Lobe { share: 0.0, shift: 0.0, sharpness: [0.0; 2], ..lobes.clone().next().unwrap_or(DARK) };
    lobes.fold(first, |sum, own| Lobe {
        share: sum.share + own.share / count,
        shift: sum.shift + own.shift / count,
        sharpness: [0, 1].map(|i: usize| sum.sharpness[i] + own.sharpness[i] / count),
        ..sum
    })
}

/// A lobe of a row at a place where lobes are about this wide.
pub(super) fn spread_by(lobe: Lobe, spread: f64) -> Lobe {
    Lobe {
        shift: lobe.shift * spread,
        sharpness: lobe.sharpness.map(|sharpness| sharpness / spread),
        shear: 0.0,
        ..lobe
    }
}
