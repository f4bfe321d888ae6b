//! Lobes tiles: the simulated light from below the first interface of a material.

use std::sync::Arc;

use luthier_layers::lobes::{Axes, Critical, EXCESS, FitSettings, LOBES, Row, Varied, Varying, shown};
use luthier_lut::{
    Axis, Comparison, ErrorStats, Image, Mapping, Scan, TableKind, TexelFormat, WeightBits, measure_scan,
};
use luthier_manifest::{AxesRecord, LobesRecord, VaryingFactor, VaryingRecord};
use luthier_material::Material;
use luthier_optics::color::Color;
use luthier_optics::stack::Stack;
use serde_json::{Value, json};

use super::{Kind, Site};
use crate::graph::{Graph, Inputs, Job, JobKind, Output, Results};
use crate::plan::color;
use crate::settings::{Ask, Shape, axis};
use crate::tile::{TileData, color_in_words, lone_tile};
use crate::{BakeError, json};

/// Points of the error scan per texel interval.
const PER_CELL: u32 = 8;

/// Jobs that fit lobes.
const FIT: JobKind = JobKind::part("fit");

/// Lobes tables.
pub(crate) struct Table;

impl Kind for Table {
    fn fixed(&self, _: Ask<'_>) -> Result<Shape, BakeError> {
        Ok(shape(LOBES))
    }

    /// A tile for the first layer: the others are in it.
    fn job(&self, site: &Site<'_>) -> Result<Option<Arc<dyn Job>>, BakeError> {
        let Site { material, layer, shape, .. } = site;
        let is_first = material.stack.layers.first().is_some_and(|first| std::ptr::eq(first, *layer));
        let job = || LobesJob { fit: fit(material), tile: 0, axes: shape.axes(), format: shape.format };
        Ok(is_first.then(|| Arc::new(job()) as Arc<dyn Job>))
    }

    /// A tile for every other node over what a texture scales, or over the azimuth.
    fn followers(&self, site: &Site<'_>) -> Vec<Arc<dyn Job>> {
        let fit = fit(site.material);
        let job = |tile| LobesJob { fit: fit.clone(), tile, axes: site.shape.axes(), format: site.shape.format };
        (1..Varied::tiles_of(&fit.stack, fit.varying)).map(|tile| Arc::new(job(tile)) as Arc<dyn Job>).collect()
    }
}

/// The part of a material that a texture scales and rows are over: they are over one factor alone.
fn varying(material: &Material) -> Option<Varying> {
    let maps = &material.layers.first()?.maps;
    let thickness = maps.thickness.as_ref().map(|_| Varying::Slab);
    maps.roughness.as_ref().map(|_| Varying::Alpha).or(thickness).or_else(|| Varying::film(&material.stack))
}

/// The shape of tiles for so many lobes.
pub(crate) fn shape(lobes: usize) -> Shape {
    let (rows, parts) = (FitSettings::default().rows as u32, Row::parts(lobes) as u32);
    let axes = [
        axis("cos_theta", "", [0.0, 1.0], rows, Mapping::Rational { bend: 1.0 }),
        axis("part", "", [0.0, f64::from(parts - 1)], parts, Mapping::Apart),
    ];
    Shape::grid(axes, TexelFormat::Rgba16Float)
}

/// The graph of the fits alone, if there are any.
pub(crate) fn fits(graph: &Graph) -> Option<Graph> {
    graph.of::<FitJob>().next()?;
    Some(graph.only(|job| job.kind() == FIT))
}

/// The most lobes that any fit of a graph has found.
pub(crate) fn most_lobes(graph: &Graph, results: &Results) -> usize {
    let lobes = |job: &FitJob| Some(results.get::<Varied>(job.key())?.nodes[0].rows[0].lobes.len());
    graph.of::<FitJob>().filter_map(lobes).max().unwrap_or(0)
}

/// The fit of a material.
fn fit(material: &Material) -> Arc<FitJob> {
    Arc::new(FitJob { stack: shown(&material.stack), color: color(material), varying: varying(material) })
}

/// Numbers that stand in where nothing was fitted.
const UNFITTED: LobesRecord = LobesRecord {
    index: 1.5,
    falloff: [0.5, 0.1],
    integral: 0.95,
    critical_cot_sq: 0.0,
    critical_width: 0.0,
    critical_plain_share: 0.0,
    varying: None,
    axes: None,
};

/// The numbers of a material's lobes that hold at all views; [`UNFITTED`] in an outline without fits.
pub(crate) fn record(material: &Material, results: &Results) -> LobesRecord {
    let axes = Axes::of(&material.stack).map(|Axes { turn, is_mirrored }| AxesRecord {
        turn,
        is_mirrored,
        tiles: Axes::TILES as u32,
    });
    let Some(varied) = results.get::<Varied>(fit(material).key()) else { return LobesRecord { axes, ..UNFITTED } };
    let lobes = &varied.nodes[0];
    let (wide, Critical { cot_sq, width, plain_share }) = (lobes.frame.wide, lobes.axis.critical());
    let over = |varying| VaryingRecord {
        factor: match varying {
            Varying::Alpha => VaryingFactor::AlphaFactor,
            Varying::Slab => VaryingFactor::SlabFactor,
            Varying::Film(_) => VaryingFactor::FilmFactor,
        },
        factors: match varying {
            Varying::Film(factors) => Some(factors),
            Varying::Alpha | Varying::Slab => None,
        },
        tiles: varied.nodes.len() as u32,
        least_spread: varied.least_spread(),
    };
    LobesRecord {
        index: lobes.frame.index,
        falloff: wide.falloff(),
        integral: wide.integral(),
        critical_cot_sq: cot_sq,
        critical_width: width,
        critical_plain_share: plain_share,
        varying: varied.varying().map(over),
        axes,
    }
}

/// The simulation of a stack, and the fit to it: [`Varied`].
#[derive(Debug)]
struct FitJob {
    stack: Stack,
    color: Color,
    varying: Option<Varying>,
}

impl Job for FitJob {
    fn kind(&self) -> JobKind {
        FIT
    }

    fn inputs(&self) -> Value {
        let FitSettings { rows, paths, seed } = FitSettings::default();
        json!({
            "stack": json::stack(&self.stack),
            "color": json::color(&self.color),
            "lobes": LOBES,
            "excess": EXCESS,
            "rows": rows,
            "paths": paths,
            "seed": seed,
            "varying": self.varying.map(|varying| json!([factor_name(varying), varying.factor(0.0), varying.factor(1.0)])),
        })
    }

    fn run(&self, _: &Inputs<'_>) -> Output {
        Box::new(Varied::of(&self.stack, &self.color, self.varying))
    }
}

/// Words on what varies.
fn factor_name(varying: Varying) -> &'static str {
    match varying {
        Varying::Alpha => "slope parameters",
        Varying::Slab => "thickness of the first slab",
        Varying::Film(_) => "thickness of the film",
    }
}

#[derive(Debug)]
struct LobesJob {
    fit: Arc<FitJob>,
    /// Number over what varies, or over the azimuth.
    tile: usize,
    /// Cosine of the view, and part.
    axes: [Axis; 2],
    format: TexelFormat,
}

impl Job for LobesJob {
    fn kind(&self) -> JobKind {
        JobKind::tile(TableKind::Lobes)
    }

    fn inputs(&self) -> Value {
        json!({
            "fit": self.fit.key().to_string(),
            "tile": self.tile,
            "axes": self.axes.iter().map(json::axis).collect::<Vec<_>>(),
            "format": self.format.name(),
        })
    }

    fn dependencies(&self) -> Vec<Arc<dyn Job>> {
        vec![self.fit.clone()]
    }

    fn run(&self, inputs: &Inputs<'_>) -> Output {
        let varied: &Varied = inputs.part(self.fit.as_ref());
        let (lobes, tile) = varied.tile(self.tile);
        let [x, y] = &self.axes;
        let most = (y.size as usize - Row::parts(0)) / (Row::parts(1) - Row::parts(0));
        // Parts are side by side; the first and the last node of each stand there twice.
        let mut truth = Image::zeros((x.size + 2) * y.size, 1, 4);
        for i in 0..x.size + 2 {
            let row = varied.stored(self.tile, (i.max(1) - 1).min(x.size - 1) as usize);
            for (j, part) in (0..y.size).zip(row.filled(most).to_parts()) {
                truth.texel_mut(j * (x.size + 2) + i, 0).copy_from_slice(&part.map(|value| value as f32));
            }
        }
        let atlas = lone_tile(TableKind::Lobes, &[x, y], self.format, &truth);
        let read = |c: f64| {
            let part = |j: u32| atlas.sample(0, [c, f64::from(j)], WeightBits::Fixed(8));
            Row::of_parts(&(0..y.size).map(part).collect::<Vec<_>>())
        };
        let scan = Scan::whole([x.intervals(), 0], [PER_CELL, 0]);
        let energies = |part: usize| {
            measure_scan(
                &scan,
                |u| {
                    let c = x.decode(u[0]);
                    let [expected, sampled] = [lobes.row_of(tile, c).filled(most), read(c)].map(|row| {
                        let [r, g, b] = row.energies()[part];
                        [r, g, b, 0.0]
                    });
                    Comparison { expected, sampled }
                },
                |u| vec![x.decode(u[0]), part as f64],
            )
        };
        let error = (1..most + 2).map(energies).fold(energies(0), ErrorStats::with_worst_of);
        let over = if lobes.axis.critical().cot_sq > 0.0 { ", rows close together at its critical angle" } else { "" };
        let factor =
            |varying: Varying| format!(" with {:.4} of its {}", varying.factor(self.tile as f64), factor_name(varying));
        let azimuth = |axes: Axes| {
            let [cos, sin] = axes.azimuth(tile as f64);
            format!(
                " seen {:.1} degrees from the axis of its lowest anisotropic surface",
                libm::atan2(sin, cos).to_degrees()
            )
        };
        let here = varied.varying().map(factor).or(lobes.frame.axes.map(azimuth)).unwrap_or_default();
        let model = format!(
            "{} fitted to the simulated stack{here}, in half vectors of a medium of index {:.3}{over}; {}; errors are those of energies \
             against the rows before they were rounded",
            ["no lobe", "one lobe", "two lobes"][lobes.rows[0].lobes.len().min(LOBES)],
            lobes.frame.index,
            color_in_words(&self.fit.color)
        );
        Box::new(TileData { model, truth, texels: atlas.texels, bytes: atlas.bytes, error })
    }
}
