//! Jobs that make tiles of rows.

use std::sync::Arc;

use luthier_layers::models::lobes::{Axes, Family, LOBES, LOBES_MAX, Row, Shaping, Varying};
use luthier_lut::{Axis, Comparison, ErrorStats, Image, Scan, TableKind, TexelFormat, WeightBits, measure_scan};
use serde_json::{Value, json};

use super::fit::{FitJob, Fits, factor_name, with_rows};
use super::rows::is_family;
use crate::form::{RowForm, Widths};
use crate::graph::{Artefact, Inputs, Job, JobKind};
use crate::json;
use crate::tile::{TileData, color_in_words, lone_tile};

/// Points of the error scan per texel interval.
pub(super) const PER_CELL: u32 = 8;

/// Rows as parts of four numbers.
#[derive(Debug, Clone, Copy)]
pub(super) enum Parts {
    /// With parts of at least so many lobes, and the light of a base (0 if rows have none) or without its parts.
    Lobes(usize, bool),
    /// With one lobe of one width, and the light of a base or without its parts.
    OneWidth(bool),
    /// With a short lobe.
    Short,
    /// Of a family, with lobes of this tail.
    Family(Family, f64),
}

impl Parts {
    /// A row filled up to the lobes of the tile, and with the light of a base if it has a place for it.
    fn filled(self, row: Row) -> Row {
        match self {
            Self::Lobes(most, has_base) => {
                Row { base: has_base.then(|| row.base.unwrap_or_default()), ..row.filled(most) }
            }
            Self::OneWidth(has_base) => Self::Lobes(1, has_base).filled(row),
            Self::Short | Self::Family(..) => row,
        }
    }

    /// The row as parts, all that it may have.
    fn of(self, row: Row) -> Vec<[f64; 4]> {
        match self {
            Self::Lobes(..) => self.filled(row).to_parts(),
            Self::OneWidth(_) => self.filled(row).to_parts_of_one_width(),
            Self::Short => row.to_parts_of_short(),
            Self::Family(family, _) => family.to_parts(&row),
        }
    }

    /// The row of parts, those that a tile has.
    fn read(self, parts: &[[f64; 4]]) -> Row {
        match self {
            Self::Lobes(most, has_base) => Row::within(most, parts, has_base),
            Self::OneWidth(has_base) => Row::of_parts(parts, has_base),
            Self::Short => Row::of_short_parts(parts),
            Self::Family(family, tail) => family.of_parts(family.first_part(), parts, tail),
        }
    }
}

#[derive(Debug)]
pub(super) struct LobesJob {
    pub(super) fit: Arc<FitJob>,
    /// Form of the rows.
    pub(super) form: RowForm,
    /// Number of the tile, over the varying factor or over the azimuth.
    pub(super) tile: usize,
    /// Cosine of the view, and part.
    pub(super) axes: [Axis; 2],
    pub(super) format: TexelFormat,
}

impl Job for LobesJob {
    fn kind(&self) -> JobKind {
        JobKind::tile(TableKind::Lobes)
    }

    fn revision(&self) -> u32 {
        if is_family(self.fit.varying) { 9 } else { 6 }
    }

    fn inputs(&self) -> Value {
        json!({
            "fit": self.fit.key().to_string(),
            "most": self.form.most,
            "widths": self.form.widths.name(),
            "is_curved": self.form.is_curved,
            "tile": self.tile,
            "axes": self.axes.iter().map(json::axis).collect::<Vec<_>>(),
            "format": self.format.name(),
        })
    }

    fn dependencies(&self) -> Vec<Arc<dyn Job>> {
        vec![self.fit.clone()]
    }

    fn run(&self, inputs: &Inputs<'_>) -> Artefact {
        let [x, y] = &self.axes;
        let fits: &Fits = inputs.part(self.fit.as_ref());
        let varied = with_rows(fits.shaped(self.form), x.size as usize);
        let (lobes, tile) = varied.tile(self.tile);
        let most = (y.max as usize + 1 - Row::parts(0)) / (Row::parts(1) - Row::parts(0));
        let layout = match (varied.varying(), Widths::in_parts(y)) {
            (Some(Varying::Family(family)), _) => Parts::Family(family, 1.0 / varied.stored(0, 0).inverse_tails()[0]),
            (_, Widths::Short) => Parts::Short,
            (_, Widths::One) => Parts::OneWidth(y.min < 0.0),
            (_, Widths::Two) => Parts::Lobes(most.min(LOBES).max(lobes.rows[0].lobes.len()), y.min < 0.0),
        };
        // Parts of families begin with their own, where those of a base have a place before it.
        let first = match layout {
            Parts::Family(family, _) => (f64::from(family.first_part()) - y.min) as u32,
            Parts::Lobes(..) | Parts::OneWidth(_) | Parts::Short => 0,
        };
        // Parts lie side by side. The first and the last node of each are repeated, so that filtering does not mix in a
        // neighbour.
        let mut truth = Image::zeros((x.size + 2) * y.size, 1, 4);
        for i in 0..x.size + 2 {
            let row = varied.stored(self.tile, (i.max(1) - 1).min(x.size - 1) as usize);
            let width = row.lobes.first().map_or(0.0, |lobe| lobe.sharpness[0]);
            let mut parts = layout.of(row);
            if let (Parts::Lobes(_, has_base), Shaping::OneWidth(_)) = (layout, lobes.frame.shaping) {
                // A shader reads the width beside the remainder, as in rows that have no other.
                parts[if has_base { Row::BASE_PARTS } else { 0 }][3] = width;
            }
            if let (Some(Varying::Patina(_)), Some([.., free])) = (varied.varying(), parts.last_mut()) {
                *free = varied.bare_facets(self.tile, (i.max(1) - 1).min(x.size - 1) as usize);
            }
            for (j, part) in (first..y.size).zip(parts) {
                truth.texel_mut(j * (x.size + 2) + i, 0).copy_from_slice(&part.map(|value| value as f32));
            }
        }
        let atlas = lone_tile(TableKind::Lobes, &[x, y], self.format, &truth);
        let scan = Scan::whole([x.intervals(), 0], [PER_CELL, 0]);
        let energies = layout.filled(lobes.row_of(tile, 0.0)).energies().len();
        let errors = (0..energies).map(|part| {
            measure_scan(
                &scan,
                |u| {
                    let c = x.decode(u[0]);
                    let parts =
                        (first..y.size).map(|j| atlas.sample(0, [c, y.min + f64::from(j)], WeightBits::Fixed(8)));
                    let read = layout.read(&parts.collect::<Vec<_>>());
                    // Without what the tile has no part for.
                    let mut truth = layout.of(lobes.row_of(tile, c));
                    truth.truncate((y.size - first) as usize);
                    let [expected, sampled] = [layout.read(&truth), read].map(|row| {
                        let [r, g, b] = row.energies()[part];
                        [r, g, b, 0.0]
                    });
                    Comparison { expected, sampled }
                },
                |u| vec![x.decode(u[0]), part as f64],
            )
        });
        let error = errors.reduce(ErrorStats::with_worst_of).unwrap_or_else(|| unreachable!("a row has energies"));
        let over = if lobes.axis.critical().cot_sq > 0.0 { ", rows close together at its critical angle" } else { "" };
        let azimuth = lobes.frame.axes.map(|axes: Axes| {
            let [cos, sin] = axes.azimuth(tile as f64);
            format!(
                " seen {:.1} degrees from the axis of its lowest anisotropic surface",
                libm::atan2(sin, cos).to_degrees()
            )
        });
        let factors = varied.varying().map(|varying: Varying| match (varying, varying.factor(self.tile as f64)) {
            (Varying::Patina(_), amount) if amount > 1.0 => {
                " with all layers, and none of the light of its patina".to_owned()
            }
            (Varying::Family(family), _) => {
                let [coat, base] = family.alphas(self.tile);
                let of_coat = if family.is_coated() { format!("{coat:.4} of the coat and ") } else { String::new() };
                format!(" at slope parameters {of_coat}{base:.4} of the base")
            }
            (_, factor) => format!(" with {factor:.4} of its {}", factor_name(varying)),
        });
        let here = factors.or(azimuth).unwrap_or_default();
        let model = format!(
            "{} fitted to the simulated stack{here}, in half vectors of a medium of index {:.3}{over}; {}; errors are those of energies \
             against the rows before they were rounded",
            ["no lobe", "one lobe", "two lobes", "three lobes"][lobes.rows[0].lobes.len().min(LOBES_MAX)],
            lobes.frame.index,
            color_in_words(&self.fit.color)
        );
        Artefact::new(TileData { model, truth, size: atlas.texels.size(), bytes: atlas.bytes, error })
    }
}
