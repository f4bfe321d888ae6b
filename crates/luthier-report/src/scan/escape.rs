use luthier_layers::statistics::total_reflection::escaping_share;
use rayon::prelude::*;

use super::{DOMAIN_ALPHA, DOMAIN_COS_THETA, Measured, Scan, User, coordinate};
use crate::Subject;
use crate::report::Curves;
use crate::subject::Table;
use crate::table_terms::Weights;

/// Points along each axis in every cell of a tile.
const POINTS_PER_CELL: u32 = 2;

/// An escape tile against the share of a lobe inside the medium below the layers that read it that is not totally reflected there (Belcour
/// 2018, sec. 5), over the cosine outside, in the domain of the albedos.
pub(super) fn scan(table: &Table<'_>, tile: u32, users: &[User], subject: &Subject<'_>) -> Option<Measured> {
    let layout = &table.entry.layout;
    let (x, y) = (&layout.x, layout.y.as_ref()?);
    let [columns, rows] = [x, y].map(|axis| axis.intervals() * POINTS_PER_CELL);
    let [from_x, from_y] = [x.encode(DOMAIN_COS_THETA), y.encode(DOMAIN_ALPHA)];
    let within = |from: f64, n: u32, count: u32| from + (1.0 - from) * coordinate(n, count);
    let mut scan = Scan::default();
    for &(material, layer) in users {
        let eta = 1.0 / subject.manifest.materials[material].layers[layer].eta;
        let points: Vec<([f64; 2], f64)> = (0..rows * columns)
            .into_par_iter()
            .map(|n| {
                let at = [x.decode(within(from_x, n % columns, columns)), y.decode(within(from_y, n / columns, rows))];
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
