//! Scan of rows of lobes against rows that are fitted anew.

use glam::DVec3;
use luthier_layers::models::lobes::LOBES;
use luthier_layers::models::shade::ShaderTerms;
use luthier_layers::twins::terms::Exact;

use super::{Measured, Scan, User, coordinates};
use crate::measure::readers::run;
use crate::measure::scan::report::Curves;
use crate::measure::subject::{Subject, Table};
use crate::measure::table_terms::{TableTerms, Weights, most_lobes};

/// Points in every interval between nodes.
const POINTS_PER_CELL: u32 = 4;

/// Compares the energies of rows of lobes (albedo, wide remainder, light of a diffuse base in it, each lobe) with those of a new simulation and fit
/// of the stack, over the cosine of the view. Where a limit has taken another form, the parts of its light are others, and the albedo alone is compared. The judgement of
/// models, not this scan, compares the fit with the simulation.
pub(super) fn scan(
    table: &Table<'_>,
    tile: u32,
    users: &[User],
    subject: &Subject<'_>,
    exact: &[&Exact],
) -> Option<Measured> {
    let x = &table.entry.layout.x;
    let mut scan = Scan::default();
    // Users of one tile have one stack.
    let &(material, layer) = users.first()?;
    let lobes = exact.get(material)?.lobes();
    let entry = &subject.manifest.materials[material];
    let first = entry.layers[layer].tiles[table.entry.kind]? + run(entry, table.entry.kind).start;
    let number = (tile - first) as usize;
    // Rows of a family have numbers in place of energies: those of the nominal place are compared, in its colours.
    let of_family = entry.constants.lobes.and_then(|lobes| lobes.family());
    let most = entry.constants.lobes.as_ref().map_or(LOBES, most_lobes);
    let painted = of_family.map(|_| TableTerms::new(subject, material, Weights::EightBit)).transpose().ok()?;
    let is_of_fit = entry.constants.lobes.is_none_or(|record| {
        let is_like = record.lobes as usize == lobes.rows[0].lobes.len() && record.index == lobes.frame.index;
        of_family.is_some() || is_like && record.rise.is_none() && record.reflectance.is_none()
    });
    for u in coordinates(x, POINTS_PER_CELL) {
        let c = x.decode(u);
        let (number, sampled) = match &painted {
            None => (number, table.row(most, tile, c, Weights::EightBit).energies()),
            Some(terms) => {
                let cos_theta = lobes.axis.cos_theta(lobes.axis.place_at(c));
                let wo = DVec3::new((1.0 - cos_theta * cos_theta).max(0.0).sqrt(), 0.0, cos_theta);
                (0, terms.below(wo)?.row().energies())
            }
        };
        let expected = lobes.row_of(number, c).energies();
        // An atlas has as many lobes as its richest row. Lobes beyond a stack's own have no light.
        let parts = if is_of_fit { expected.len().max(sampled.len()) } else { 1 };
        for part in 0..parts {
            let [expected, sampled] = [&expected, &sampled].map(|row| row.get(part).copied().unwrap_or_default());
            for channel in 0..3 {
                scan.add(&[c, part as f64], channel, expected[channel], sampled[channel]);
            }
        }
    }
    Some(Measured { scan, curves: Curves::None, uncertainty: None })
}
