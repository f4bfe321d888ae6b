//! Scan of film tiles against the interfaces that read them, at thicknesses of their films.

use luthier_lut::incident_cosine;
use luthier_optics::interface::Interface;
use luthier_optics::stack::FilmThickness;
use rayon::prelude::*;

use super::{Measured, Scan, User, coordinate};
use crate::measure::scan::report::Curves;
use crate::measure::subject::{Subject, Table, color};
use crate::measure::table_terms::Weights;

/// Points along each axis: cosines and thicknesses.
const POINTS: u32 = 96;

/// Compares a film tile with the reflectance of every interface that reads it. The thickness of the top film runs from the thinnest of the material
/// to the end of the axis.
pub(super) fn scan(table: &Table<'_>, tile: u32, users: &[User], subject: &Subject<'_>) -> Option<Measured> {
    let (x, y) = (&table.entry.layout.x, table.entry.layout.y.as_ref()?);
    let mut scan = Scan::default();
    for &(material, layer) in users {
        let entry = &subject.manifest.materials[material];
        let (record, interface) = (&entry.layers[layer], Interface::of(&subject.stacks[material], layer)?);
        let thickness = interface.films.first()?.thickness;
        let color = color(entry);
        let least = y.encode(thickness.min_nm / thickness.max_nm);
        let points: Vec<_> = (0..POINTS)
            .into_par_iter()
            .flat_map_iter(|j| {
                let fraction = y.decode(least + (1.0 - least) * coordinate(j, POINTS));
                let mut here = interface.clone();
                let nm = fraction * thickness.max_nm;
                here.films[0].thickness = FilmThickness { min_nm: nm, max_nm: nm };
                let here = here.sampled(&color);
                (0..POINTS).map(move |i| {
                    let cos_theta = x.decode(coordinate(i, POINTS));
                    ([cos_theta, fraction], here.rgb(incident_cosine(record.critical_cot_sq, cos_theta)))
                })
            })
            .collect();
        for (at, expected) in points {
            let sampled = table.read(tile, at, Weights::EightBit);
            for channel in 0..3 {
                scan.add(&at, channel, expected[channel], sampled[channel]);
            }
        }
    }
    Some(Measured { scan, curves: Curves::None, uncertainty: None })
}
