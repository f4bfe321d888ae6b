//! Scan of Fresnel rows against the interfaces that read them.

use luthier_layers::terms::Terms;
use luthier_layers::twins::terms::Exact;
use luthier_lut::{TableKind, incident_cosine};
use luthier_manifest::LayerRecord;
use luthier_optics::Rgb;
use luthier_optics::interface::Interface;

use super::{Measured, Scan, User, coordinate, coordinates};
use crate::error::ReportError;
use crate::measure::readers::bare_users;
use crate::measure::references::bare_stack;
use crate::measure::scan::report::{Curves, ReflectanceCurve};
use crate::measure::subject::{Subject, Table, color};
use crate::measure::table_terms::{AngleAxis, Weights};
use crate::text::format::rounded;

/// Reflectance of an interface over the cosine.
type Reflectance<'a> = Box<dyn Fn(f64) -> Rgb + 'a>;

/// Points in every cell of a row.
const POINTS_PER_CELL: u32 = 8;
/// Extra cosines below 0.1, log-uniform down to 1e-6: the first cells hold the steepest part.
const GRAZING_POINTS: u32 = 256;
/// Degrees between the points of a drawn curve.
const CURVE_STEP_DEG: f64 = 1.5;

/// Compares a Fresnel row with every interface that reads it, those of bare layers under a patina or a coat among them. A row that two different interfaces share is wrong for one of them.
pub(super) fn scan(
    table: &Table<'_>,
    tile: u32,
    users: &[User],
    subject: &Subject<'_>,
    exact: &[&Exact],
) -> Result<Measured, ReportError> {
    let axis = &table.entry.layout.x;
    let angle = AngleAxis::of(table)?;
    let regular = coordinates(axis, POINTS_PER_CELL).into_iter().map(|u| angle.cos_and_sin_sq(axis.decode(u)).0);
    let grazing = (0..GRAZING_POINTS).map(|n| 1e-6 * libm::pow(1e5, coordinate(n, GRAZING_POINTS)));
    let cosines: Vec<f64> = regular.chain(grazing).map(|c| c.clamp(0.0, 1.0)).collect();
    let mut scan = Scan::default();
    let materials = &subject.manifest.materials;
    let layers = users.iter().map(|&(material, layer)| {
        let expected: Reflectance<'_> = Box::new(move |c| exact[material].fresnel(layer, c));
        (&materials[material].layers[layer], expected)
    });
    let bare = bare_users(subject, TableKind::Fresnel, tile).into_iter().filter_map(|material| {
        let (entry, stack) = (&materials[material], &subject.stacks[material]);
        // What the first layer does not cover meets the light without it.
        let interface = Interface::of(&bare_stack(entry, stack), 0)?.sampled(&color(entry));
        let expected: Reflectance<'_> = Box::new(move |c| interface.rgb(c));
        Some((entry.constants.bare()?, expected))
    });
    let readers: Vec<(&LayerRecord, Reflectance<'_>)> = layers.chain(bare).collect();
    for (record, expected) in &readers {
        // Rows over the cosine below the interface are also read at their nodes.
        let inside = cosines.iter().map(|&c| incident_cosine(record.critical_cot_sq, c));
        let inside = inside.filter(|_| record.critical_cot_sq > 0.0);
        for cos_theta in cosines.iter().copied().chain(inside) {
            let expected = expected(cos_theta);
            let value = angle.value_at(record.row_cosine(cos_theta));
            let sampled = table.read(tile, [value, 0.0], Weights::EightBit);
            for channel in 0..3 {
                scan.add(&[value], channel, expected[channel], sampled[channel]);
            }
        }
    }
    let first = readers.first().map(|(record, _)| *record);
    let steps = (90.0 / CURVE_STEP_DEG) as u32;
    let rgb = (0..=steps).map(|n| {
        let cos_theta = libm::cos((CURVE_STEP_DEG * f64::from(n)).to_radians());
        let value = angle.value_at(first.map_or(cos_theta, |record| record.row_cosine(cos_theta)));
        let [r, g, b, _] = table.read(tile, [value, 0.0], Weights::Exact);
        [r, g, b].map(|c| rounded(c, 4))
    });
    let curve = ReflectanceCurve { step_deg: CURVE_STEP_DEG, rgb: rgb.collect() };
    Ok(Measured { scan, curves: Curves::Reflectance(curve), uncertainty: None })
}
