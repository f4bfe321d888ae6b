//! Scan of phase rows against the interference term of films.

use std::f64::consts::TAU;

use luthier_optics::film_over_f0::WAVES_MAX;

use super::{Measured, Scan, User, coordinates};
use crate::measure::scan::report::Curves;
use crate::measure::subject::{Subject, Table, color};
use crate::measure::table_terms::Weights;

/// Points in every cell of a row.
const POINTS_PER_CELL: u32 = 8;

/// Compares a phase row with `2 cos(2 pi (2 d_max n / lambda) s)` (Granier and Heidrich 2003, eq. 19) of every film that reads it,
/// at the three wavelengths of its material; or, over an F0 of the place, with the means of `2 cos` over the wavelengths of each channel.
pub(super) fn scan(table: &Table<'_>, tile: u32, users: &[User], subject: &Subject<'_>) -> Option<Measured> {
    let axis = &table.entry.layout.x;
    let mut scan = Scan::default();
    for &(material, layer) in users {
        let film = subject.stacks[material].layers.get(layer).and_then(|l| l.films.first())?;
        let entry = &subject.manifest.materials[material];
        let wavelengths_nm = entry.wavelengths_nm;
        let middle_nm = wavelengths_nm[1];
        // Films reflect light of every wavelength of a channel.
        let nodes = if entry.layers[layer].has_film_over_f0() { color(entry).nodes() } else { Vec::new() };
        let ends = wavelengths_nm.map(|nm| 2.0 * film.thickness.max_nm * film.ior.at(nm).re / nm);
        let late = |nm: f64| WAVES_MAX * middle_nm / nm * film.ior.at(nm).re / film.ior.at(middle_nm).re;
        let expected = |channel: usize, s: f64| {
            if nodes.is_empty() {
                return 2.0 * libm::cos(TAU * ends[channel] * s);
            }
            nodes.iter().map(|node| node.weight[channel] * 2.0 * libm::cos(TAU * s * late(node.wavelength_nm))).sum()
        };
        for s in coordinates(axis, POINTS_PER_CELL).into_iter().map(|u| axis.decode(u)) {
            let sampled = table.read(tile, [s, 0.0], Weights::EightBit);
            for (channel, sampled) in sampled.into_iter().take(3).enumerate() {
                scan.add(&[s], channel, expected(channel, s), sampled);
            }
        }
    }
    Some(Measured { scan, curves: Curves::None, uncertainty: None })
}
