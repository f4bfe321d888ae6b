//! Scan of phase rows against the interference term of films.

use std::f64::consts::TAU;

use super::{Measured, Scan, User, coordinates};
use crate::measure::scan::report::Curves;
use crate::measure::subject::{Subject, Table};
use crate::measure::table_terms::Weights;

/// Points in every cell of a row.
const POINTS_PER_CELL: u32 = 8;

/// Compares a phase row with `2 cos(2 pi (2 d_max n / lambda) s)` (Granier and Heidrich 2003, eq. 19) of every film that reads it,
/// at the three wavelengths of its material.
pub(super) fn scan(table: &Table<'_>, tile: u32, users: &[User], subject: &Subject<'_>) -> Option<Measured> {
    let axis = &table.entry.layout.x;
    let mut scan = Scan::default();
    for &(material, layer) in users {
        let film = subject.stacks[material].layers.get(layer).and_then(|l| l.films.first())?;
        let wavelengths_nm = subject.manifest.materials[material].wavelengths_nm;
        let waves = wavelengths_nm.map(|nm| 2.0 * film.thickness.max_nm * film.ior.at(nm).re / nm);
        for s in coordinates(axis, POINTS_PER_CELL).into_iter().map(|u| axis.decode(u)) {
            let sampled = table.read(tile, [s, 0.0], Weights::EightBit);
            for channel in 0..3 {
                scan.add(&[s], channel, 2.0 * libm::cos(TAU * waves[channel] * s), sampled[channel]);
            }
        }
    }
    Some(Measured { scan, curves: Curves::None, uncertainty: None })
}
