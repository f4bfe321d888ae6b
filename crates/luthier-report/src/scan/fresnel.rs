use luthier_layers::elek::Terms;
use luthier_layers::terms::Exact;

use super::{Measured, Scan, User, coordinate};
use crate::ReportError;
use crate::format::rounded;
use crate::report::{Curves, ReflectanceCurve};
use crate::subject::Table;
use crate::table_terms::{AngleAxis, Weights};

/// Points in every cell of a row.
const POINTS_PER_CELL: u32 = 8;
/// Extra cosines below 0.1, log-uniform down to 1e-6: the first cells hold the steepest part.
const GRAZING_POINTS: u32 = 256;
/// Degrees between the points of a drawn curve.
const CURVE_STEP_DEG: f64 = 1.5;

/// A Fresnel row against every interface that reads it: a row that two different interfaces share is wrong for one.
pub(super) fn scan(table: &Table<'_>, tile: u32, users: &[User], exact: &[Exact]) -> Result<Measured, ReportError> {
    let axis = &table.entry.layout.x;
    let angle = AngleAxis::of(table)?;
    let count = axis.intervals() * POINTS_PER_CELL;
    let regular = (0..count).map(|n| angle.cos_and_sin_sq(axis.decode(coordinate(n, count))).0);
    let grazing = (0..GRAZING_POINTS).map(|n| 1e-6 * libm::pow(1e5, coordinate(n, GRAZING_POINTS)));
    let cosines: Vec<f64> = regular.chain(grazing).map(|c| c.clamp(0.0, 1.0)).collect();
    let read = |cos_theta: f64, weights| table.read(tile, [angle.value_at(cos_theta), 0.0], weights);
    let mut scan = Scan::default();
    for &(material, layer) in users {
        for &cos_theta in &cosines {
            let expected = exact[material].fresnel(layer, cos_theta);
            let sampled = read(cos_theta, Weights::EightBit);
            for channel in 0..3 {
                scan.add(&[angle.value_at(cos_theta)], channel, expected[channel], sampled[channel]);
            }
        }
    }
    let steps = (90.0 / CURVE_STEP_DEG) as u32;
    let rgb = (0..=steps).map(|n| {
        let [r, g, b, _] = read(libm::cos((CURVE_STEP_DEG * f64::from(n)).to_radians()), Weights::Exact);
        [r, g, b].map(|c| rounded(c, 4))
    });
    let curve = ReflectanceCurve { step_deg: CURVE_STEP_DEG, rgb: rgb.collect() };
    Ok(Measured { scan, curves: Curves::Reflectance(curve), uncertainty: None })
}
