//! Scan of escape tiles against the share of a lobe that is not totally reflected.

use luthier_layers::models::statistics::total_reflection::escaping_share;
use rayon::prelude::*;

use super::{DOMAIN_ALPHA, DOMAIN_COS_THETA, Measured, Scan, User, coordinates};
use crate::measure::scan::report::Curves;
use crate::measure::subject::{Subject, Table};
use crate::measure::table_terms::Weights;

/// Points along each axis in every cell of a tile.
const POINTS_PER_CELL: u32 = 2;

/// Compares an escape tile with the share of a lobe that is not totally reflected (Belcour 2018, sec. 5), in the domain of the albedos. The lobe
/// lies in the medium below the layers that read the tile; the axis is the cosine outside.
pub(super) fn scan(table: &Table<'_>, tile: u32, users: &[User], subject: &Subject<'_>) -> Option<Measured> {
    let layout = &table.entry.layout;
    let (x, y) = (&layout.x, layout.y.as_ref()?);
    // In the domain; nodes below it are left out.
    let [cosines, alphas] = [(x, DOMAIN_COS_THETA), (y, DOMAIN_ALPHA)].map(|(axis, least)| {
        let from = axis.encode(least);
        let all = coordinates(axis, POINTS_PER_CELL);
        let (between, nodes) = all.split_at((axis.intervals() * POINTS_PER_CELL) as usize);
        let between = between.iter().map(|u| from + (1.0 - from) * u);
        between.chain(nodes.iter().copied().filter(|u| *u >= from)).map(|u| axis.decode(u)).collect::<Vec<f64>>()
    });
    let mut scan = Scan::default();
    for &(material, layer) in users {
        let eta = 1.0 / subject.manifest.materials[material].layers[layer].eta;
        let points: Vec<([f64; 2], f64)> = (0..alphas.len() * cosines.len())
            .into_par_iter()
            .map(|n| {
                let at = [cosines[n % cosines.len()], alphas[n / cosines.len()]];
                let sin_sq = (1.0 - at[0]) * (1.0 + at[0]) * eta * eta;
                (at, escaping_share((1.0 - sin_sq).max(0.0).sqrt(), at[1], eta))
            })
            .collect();
        for (at, expected) in points {
            scan.add(&at, 0, expected, table.read(tile, at, Weights::EightBit)[0]);
        }
    }
    Some(Measured { scan, curves: Curves::None, uncertainty: None })
}
