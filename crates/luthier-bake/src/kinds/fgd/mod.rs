//! FGD-infinity tiles: the energy that one rough interface sends back, all bounces of its micro-surface included.

mod curves;
mod facet_grid;
mod search;
mod smooth;

use std::sync::Arc;

use luthier_lut::{Axis, Comparison, Image, Mapping, TableKind, TexelFormat, WeightBits, measure_at};
use luthier_manifest::{CandidateForm, MeasuredError};
use luthier_material::BakeSettings;
use luthier_optics::Rgb;
use luthier_optics::color::{Color, luminance};
use luthier_optics::interface::Interface;
use luthier_optics::stack::{Base, Distribution};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use serde_json::{Value, json};

use self::curves::{Bounces, Curves};
use self::facet_grid::{CrossedGrid, CrossedJob, FacetGrid, FacetGridJob};
pub(crate) use self::facet_grid::{DOMAIN_ALPHA, DOMAIN_COS_THETA};
use self::smooth::savitzky_golay;
use super::{Kind, Site};
use crate::candidates::{Found, grids};
use crate::graph::{Artefact, Inputs, Job, JobKind, Results};
use crate::grid::resampled;
use crate::plan::Plan;
use crate::settings::{Ask, Asked, Shape, axis};
use crate::tile::{TileData, color_in_words, lone_tile};
use crate::{BakeError, json};

/// Points of the error scan along the cosine, in a cell with a critical angle.
const KINK_POINTS: u32 = 8;

/// Alphas of the error scan in such a cell: roughness wears the kink away.
const KINK_ALPHAS: [f64; 4] = [DOMAIN_ALPHA, 0.03, 0.1, 0.3];

/// FGD tables.
pub(crate) struct Table;

impl Kind for Table {
    fn fixed(&self, ask: Ask<'_>) -> Result<Shape, BakeError> {
        let size = ask.one("bake.fgd.size", |b| b.fgd.size)?.unwrap_or([64, 64]);
        let axes = [
            axis("cos_theta", "", [0.0, 1.0], size[0], Mapping::Power { exponent: 2.0 }),
            axis("alpha", "", [0.0, 1.0], size[1], Mapping::Power { exponent: 3.0 }),
        ];
        let format = ask.format("bake.fgd.format", |b| b.fgd.format, TexelFormat::Rgba16Float)?;
        if let Some(&side) = size.iter().find(|side| !side.is_multiple_of(format.block_side())) {
            let sized = ask.0.iter().position(|m| m.bake.fgd.size.is_some());
            let (material, setting) = match ask.0.iter().position(|m| m.bake.fgd.format.is_some()) {
                Some(material) if sized.is_none() => (material, "bake.fgd.format"),
                _ => (sized.unwrap_or(0), "bake.fgd.size"),
            };
            return Err(BakeError::Blocks { material, setting, format, side });
        }
        Ok(Shape::grid(axes, format))
    }

    fn asked(&self, bake: &BakeSettings) -> Asked {
        Asked { size: bake.fgd.size.is_some(), mapping: false, format: bake.fgd.format.is_some() }
    }

    fn job(&self, site: &Site<'_>) -> Result<Option<Arc<dyn Job>>, BakeError> {
        let truth = FgdTruthJob {
            interface: site.interface.clone(),
            transparent: matches!(site.layer.base, Base::Dielectric { .. }),
            distribution: site.layer.surface.distribution,
            color: site.color,
            grid: site.fixed.axes(),
        };
        Ok(Some(Arc::new(FgdJob { truth, axes: site.shape.axes(), format: site.shape.format })))
    }

    fn has_aim(&self) -> bool {
        true
    }

    fn candidates(&self, plan: &Plan, results: &Results, colors: bool) -> Option<Found> {
        search::candidates(plan, results, colors)
    }

    fn errors(&self, plan: &Plan, results: &Results, form: &CandidateForm) -> Vec<(usize, MeasuredError)> {
        grids::errors(&search::tiles(plan, results), form)
    }
}

/// The values of a tile on the grid of their computation. Settings of the table are no inputs, so all sizes and formats
/// share them.
#[derive(Debug, Clone)]
pub(crate) struct FgdTruthJob {
    pub(crate) interface: Interface,
    /// Whether light can cross: false for conductors.
    pub(crate) transparent: bool,
    pub(crate) distribution: Distribution,
    pub(crate) color: Color,
    /// cos_theta and alpha.
    pub(crate) grid: [Axis; 2],
}

/// Values at the nodes of a grid, RGB and never-crossed luminance, and at the points of an error scan.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub(crate) struct FgdTruth {
    pub(crate) image: Image,
    /// Axis values, and the values of the function there.
    pub(crate) probes: Vec<([f64; 2], [f64; 4])>,
    /// Axis values around critical angles, and the values of the function there.
    pub(crate) kinks: Vec<([f64; 2], [f64; 4])>,
    /// Error of the function itself: the sum of the largest errors of crossed light and of left-out wavelengths, which
    /// may meet.
    pub(crate) slack: f64,
    /// Root mean square of the error of the function itself.
    pub(crate) slack_rms: f64,
}

impl Job for FgdTruthJob {
    fn kind(&self) -> JobKind {
        JobKind::part("fgd-truth")
    }

    fn inputs(&self) -> Value {
        json!({
            "interface": json::interface(&self.interface),
            "transparent": self.transparent,
            "distribution": self.distribution.name(),
            "color": json::color(&self.color),
            "grid": self.grid.iter().map(json::axis).collect::<Vec<_>>(),
        })
    }

    fn dependencies(&self) -> Vec<Arc<dyn Job>> {
        let mut jobs: Vec<Arc<dyn Job>> = vec![Arc::new(self.facet_grid())];
        jobs.extend(self.crossed().map(|job| Arc::new(job) as Arc<dyn Job>));
        jobs
    }

    fn run(&self, inputs: &Inputs<'_>) -> Artefact {
        Artefact::new(self.truth(inputs))
    }

    fn decode(&self, bytes: &[u8]) -> Option<Artefact> {
        Artefact::decode::<FgdTruth>(bytes)
    }
}

impl FgdTruthJob {
    fn facet_grid(&self) -> FacetGridJob {
        let kinked = self.transparent && !self.critical_cosines().is_empty();
        FacetGridJob { distribution: self.distribution, kinked, axes: self.grid.clone() }
    }

    /// Critical cosines: below them all light is totally reflected. One for each wavelength that has such an angle.
    fn critical_cosines(&self) -> Vec<f64> {
        let cosines = self.color.nodes().into_iter().filter_map(|node| {
            let at = self.interface.at(node.wavelength_nm, 0);
            let eta = at.below.re / at.above.re;
            (eta < 1.0 && at.f0.is_none()).then(|| ((1.0 - eta) * (1.0 + eta)).sqrt())
        });
        cosines.collect()
    }

    /// Coordinates around the critical angles, where smooth tables are worst: in every cell with such an angle, and
    /// beside it.
    fn kinks(&self) -> Vec<[f64; 2]> {
        let [x, y] = &self.grid;
        let critical = self.critical_cosines();
        let (least, most) = critical.iter().fold((1.0, 0.0), |(a, b), &c| (f64::min(a, c), f64::max(b, c)));
        if least > most {
            return Vec::new();
        }
        let last = f64::from(x.intervals());
        let (from, to) = (libm::floor(x.index(least)), libm::floor(x.index(most)) + 1.0);
        let count = ((to - from) as u32 + 1) * KINK_POINTS;
        let cosines = (0..count).map(|i| from + (to + 1.0 - from) * f64::from(i) / f64::from(count));
        let columns: Vec<f64> = cosines.filter(|index| *index <= last).map(|index| index / last).collect();
        KINK_ALPHAS.iter().flat_map(|&alpha| columns.iter().map(move |&u| [u, y.encode(alpha)])).collect()
    }

    fn crossed(&self) -> Option<CrossedJob> {
        self.transparent.then(|| CrossedJob {
            interface: self.interface.clone(),
            color: self.color,
            distribution: self.distribution,
            axes: self.grid.clone(),
        })
    }

    fn truth(&self, inputs: &Inputs<'_>) -> FgdTruth {
        let [x, y] = &self.grid;
        let facets = self.facet_grid();
        let kinks = facets.probes(if facets.kinked { self.kinks() } else { Vec::new() });
        let grid: &FacetGrid = inputs.part(&facets);
        let crossed: Option<&CrossedGrid> = self.crossed().map(|job| inputs.part(&job));
        let curves = Curves::new(&self.interface, &self.color);

        let bounces: Vec<Bounces> = grid.nodes.par_iter().map(|s| curves.bounces(s)).collect();
        let mut later: [Vec<f64>; 3] = [0, 1, 2].map(|c: usize| bounces.iter().map(|b| b.later_share[c]).collect());
        for channel in &mut later {
            savitzky_golay(channel, x.size as usize, y.size as usize);
        }
        let mut image = Image::zeros(x.size, y.size, 4);
        for (i, (statistics, b)) in grid.nodes.iter().zip(&bounces).enumerate() {
            let never_crossed: Rgb = [0, 1, 2].map(|c: usize| b.first[c] + statistics.remaining() * later[c][i]);
            let (column, row) = (i as u32 % x.size, i as u32 / x.size);
            let u = [x.node_coordinate(f64::from(column)), y.node_coordinate(f64::from(row))];
            let back = crossed.map_or([0.0; 3], |crossed| crossed.at(u));
            let [r, g, b] = [0, 1, 2].map(|c: usize| (never_crossed[c] + back[c]) as f32);
            image.texel_mut(column, row).copy_from_slice(&[r, g, b, luminance(never_crossed) as f32]);
        }

        let [probes, kinks] = [&grid.probes, &kinks].map(|points| {
            let values = points.par_iter().map(|(u, statistics)| {
                let (b, back) = (curves.bounces(statistics), crossed.map_or([0.0; 3], |crossed| crossed.at(*u)));
                let never_crossed: Rgb =
                    [0, 1, 2].map(|c: usize| b.first[c] + statistics.remaining() * b.later_share[c]);
                let [r, g, b] = [0, 1, 2].map(|c: usize| never_crossed[c] + back[c]);
                ([x.decode(u[0]), y.decode(u[1])], [r, g, b, luminance(never_crossed)])
            });
            values.collect()
        });
        let ([spectrum, spectrum_rms], [back, back_rms]) =
            (curves.spectrum_error(&grid.probes), crossed.map_or([0.0; 2], |c| [c.max_abs_err, c.rms_err]));
        FgdTruth { image, probes, kinks, slack: back + spectrum, slack_rms: libm::hypot(back_rms, spectrum_rms) }
    }
}

/// A tile of albedos.
#[derive(Debug, Clone)]
pub(crate) struct FgdJob {
    pub(crate) truth: FgdTruthJob,
    /// cos_theta and alpha of the tile. Nodes that the grid lacks are interpolated.
    pub(crate) axes: [Axis; 2],
    pub(crate) format: TexelFormat,
}

impl Job for FgdJob {
    fn kind(&self) -> JobKind {
        JobKind::tile(TableKind::Fgd)
    }

    fn inputs(&self) -> Value {
        json!({
            "truth": self.truth.inputs(),
            "axes": self.axes.iter().map(json::axis).collect::<Vec<_>>(),
            "format": self.format.name(),
        })
    }

    fn dependencies(&self) -> Vec<Arc<dyn Job>> {
        vec![Arc::new(self.truth.clone())]
    }

    fn run(&self, inputs: &Inputs<'_>) -> Artefact {
        let FgdTruth { image, probes, kinks, slack, slack_rms } = inputs.part(&self.truth);
        let [x, y] = &self.axes;
        let truth =
            if self.axes == self.truth.grid { image.clone() } else { resampled(image, &self.truth.grid, &self.axes) };
        let atlas = lone_tile(TableKind::Fgd, &[x, y], self.format, &truth);
        let [error, worst] = [probes, kinks].map(|points| {
            measure_at(points.iter().map(|&(at, expected)| {
                let mut sampled = atlas.sample(0, at, WeightBits::Fixed(8));
                // Formats without a fourth channel hold reflected light alone.
                if self.format.channels() < 4 {
                    sampled[3] = expected[3];
                }
                (at.to_vec(), Comparison { expected, sampled })
            }))
        });
        let error = error.with_worst_of(worst).with_slack(*slack, *slack_rms);
        let model = format!(
            "directional albedo with all bounces, height-correlated Smith, {}; {}; errors for cos_theta >= {DOMAIN_COS_THETA}, \
             alpha >= {DOMAIN_ALPHA}",
            self.truth.distribution.name(),
            color_in_words(&self.truth.color)
        );
        Artefact::new(TileData { model, truth, size: atlas.texels.size(), bytes: atlas.bytes, error })
    }
}
