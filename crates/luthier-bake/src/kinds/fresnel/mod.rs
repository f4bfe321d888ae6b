//! Fresnel rows: exact reflectance of one interface over the angle.

pub(crate) mod search;

use std::f64::consts::FRAC_PI_2;
use std::sync::Arc;

use luthier_lut::{
    Atlas, AtlasLayout, Axis, Comparison, Image, Mapping, RowBase, Scan, SchlickBase, TableKind, TexelFormat,
    WeightBits, balance, incident_cosine, measure_scan,
};
use luthier_manifest::{CandidateForm, MeasuredError};
use luthier_material::{BakeSettings, FresnelMapping};
use luthier_optics::Rgb;
use luthier_optics::color::Color;
use luthier_optics::interface::{Interface, Sampled};
use serde_json::{Value, json};

use super::{Kind, Site};
use crate::candidates::Found;
use crate::graph::{Artefact, Inputs, Job, JobKind, Results};
use crate::plan::Plan;
use crate::settings::{Ask, Asked, Shape, axis};
use crate::tile::{TileData, color_in_words, lone_tile};
use crate::{BakeError, json};

/// Points of the error scan per texel interval.
const PER_CELL: u32 = 16;

/// Points of the scan for each added point in the range of total reflection.
const BEYOND: u32 = 8;

/// Cosines at which the coefficient of the dip is fitted: squares of equal steps.
const FIT_POINTS: u32 = 64;

/// Steps of the search for that coefficient. Each takes a third off the range, which starts at 32: the last is about
/// 7e-5 wide.
const FIT_STEPS: u32 = 32;

/// Fresnel tables.
pub(crate) struct Table;

impl Kind for Table {
    fn fixed(&self, ask: Ask<'_>) -> Result<Shape, BakeError> {
        let mapping = ask.one("bake.fresnel.mapping", |b| b.fresnel.mapping)?.unwrap_or(FresnelMapping::Cosine);
        let size = ask.one("bake.fresnel.size", |b| b.fresnel.size)?.unwrap_or(128);
        let x = match mapping {
            FresnelMapping::Cosine => axis("cos_theta", "", [0.0, 1.0], size, Mapping::Linear),
            FresnelMapping::SqrtCosine => axis("cos_theta", "", [0.0, 1.0], size, Mapping::Power { exponent: 2.0 }),
            FresnelMapping::Theta => axis("theta", "rad", [0.0, FRAC_PI_2], size, Mapping::Linear),
        };
        Ok(Shape::row(x, ask.format("bake.fresnel.format", |b| b.fresnel.format, TexelFormat::Rgba16Float)?))
    }

    fn asked(&self, bake: &BakeSettings) -> Asked {
        let given = &bake.fresnel;
        Asked { size: given.size.is_some(), mapping: given.mapping.is_some(), format: given.format.is_some() }
    }

    fn job(&self, site: &Site<'_>) -> Result<Option<Arc<dyn Job>>, BakeError> {
        let shape = RowShape::of(site.shape);
        Ok(Some(Arc::new(FresnelJob { interface: site.interface.clone(), color: site.color, shape })))
    }

    fn has_aim(&self) -> bool {
        true
    }

    fn candidates(&self, plan: &Plan, _: &Results, colors: bool) -> Option<Found> {
        search::candidates(plan, colors)
    }

    fn errors(&self, plan: &Plan, _: &Results, form: &CandidateForm) -> Vec<(usize, MeasuredError)> {
        search::errors(plan, form)
    }

    fn candidates_by_default(&self, plan: &Plan) -> Option<Found> {
        search::served(plan)
    }
}

/// How a Fresnel row is laid out.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct RowShape {
    pub(crate) axis: Axis,
    pub(crate) format: TexelFormat,
    pub(crate) base: RowBase,
}

#[derive(Debug, Clone)]
pub(crate) struct FresnelJob {
    pub(crate) interface: Interface,
    pub(crate) color: Color,
    pub(crate) shape: RowShape,
}

impl Job for FresnelJob {
    fn kind(&self) -> JobKind {
        JobKind::tile(TableKind::Fresnel)
    }

    fn inputs(&self) -> Value {
        json!({
            "interface": json::interface(&self.interface),
            "color": json::color(&self.color),
            "axis": json::axis(&self.shape.axis),
            "format": self.shape.format.name(),
            "base": self.shape.base,
        })
    }

    fn run(&self, _: &Inputs<'_>) -> Artefact {
        Artefact::new(self.tile())
    }
}

impl FresnelJob {
    pub(crate) fn tile(&self) -> TileData {
        let curve = RowCurve::new(&self.interface, &self.color);
        let axis = &self.shape.axis;
        let (atlas, truth) = self.shape.row(&|cos| curve.at(cos), &SchlickBase::fit(&|cos| curve.at(cos)));
        let mut scan = Scan::whole([axis.intervals(), 0], [PER_CELL, 0]);
        if curve.critical_cot_sq > 0.0 {
            let beyond = f64::from(scan.points[0] / BEYOND) / f64::from(scan.points[0]);
            scan.points[0] += scan.points[0] / BEYOND;
            scan.from[0] = -beyond;
        }
        let error = measure_scan(
            &scan,
            |u| {
                let (value, incident) = curve.scanned(axis, u[0], scan.from[0]);
                let [r, g, b] = curve.sampled.rgb(incident);
                let read = atlas.sample(0, [value, 0.0], WeightBits::Fixed(8));
                Comparison { expected: [r, g, b, 0.0], sampled: [read[0], read[1], read[2], 0.0] }
            },
            |u| vec![curve.scanned(axis, u[0], scan.from[0]).0],
        );
        let films = if self.interface.films.is_empty() { "bare interface" } else { "films, Airy" };
        let over = if curve.critical_cot_sq > 0.0 { ", over the cosine of the refracted direction" } else { "" };
        TileData {
            model: match self.interface.below.f0() {
                Some(_) if self.interface.below.f82_tint() != [1.0; 3] => {
                    "Schlick 1994, from F0 by channel, with an edge tint; bare interface".to_owned()
                }
                Some(_) if self.interface.films.is_empty() => {
                    "Schlick 1994, from F0 by channel; bare interface".to_owned()
                }
                Some(_) => format!("films, Airy, over the index of F0 by channel; {}", color_in_words(&self.color)),
                None => format!("exact complex Fresnel, unpolarised; {films}{over}; {}", color_in_words(&self.color)),
            },
            truth,
            size: atlas.texels.size(),
            bytes: atlas.bytes,
            error,
        }
    }
}

/// The reflectance of a row, over the cosine of incidence. Under total reflection, it is over the cosine of the
/// refracted direction.
pub(crate) struct RowCurve {
    sampled: Sampled,
    /// 0 if the axis is the cosine of incidence.
    pub(crate) critical_cot_sq: f64,
}

impl RowCurve {
    pub(crate) fn new(interface: &Interface, color: &Color) -> Self {
        let sampled = interface.sampled(color);
        Self { critical_cot_sq: sampled.critical_cot_sq(), sampled }
    }

    /// The reflectance at a cosine of the row.
    pub(crate) fn at(&self, cos_theta: f64) -> Rgb {
        self.sampled.rgb(incident_cosine(self.critical_cot_sq, cos_theta))
    }

    /// The value of an axis at a coordinate of its error scan, and the cosine of incidence there. Coordinates below 0
    /// stand for totally reflected angles, which have no node: `from` is grazing, 0 the critical angle.
    fn scanned(&self, axis: &Axis, u: f64, from: f64) -> (f64, f64) {
        let flattest = if axis.quantity == "theta" { axis.max } else { axis.min };
        let value = if u < 0.0 { flattest } else { axis.decode(u) };
        let incident = incident_cosine(self.critical_cot_sq, cos_theta(axis, value));
        (value, if u < 0.0 { incident * (1.0 - u / from) } else { incident })
    }
}

/// The cosine at a value of the axis of a row.
pub(crate) fn cos_theta(axis: &Axis, value: f64) -> f64 {
    if axis.quantity == "theta" { libm::cos(value).max(0.0) } else { value }
}

impl RowShape {
    /// The shape of a table's rows.
    pub(crate) fn of(shape: &Shape) -> Self {
        Self { axis: shape.x.clone(), format: shape.format, base: shape.base }
    }

    /// The row of a reflectance as an atlas of its own, and its values at the nodes.
    pub(crate) fn row(&self, reflectance: &dyn Fn(f64) -> Rgb, base: &SchlickBase) -> (Atlas, Image) {
        let mut truth = Image::zeros(self.axis.size, 1, 3);
        for i in 0..self.axis.size {
            let rgb = reflectance(cos_theta(&self.axis, self.axis.node(i)));
            truth.texel_mut(i, 0).copy_from_slice(&rgb.map(|c| c as f32));
        }
        let atlas = match self.base {
            RowBase::Zero => lone_tile(TableKind::Fresnel, &[&self.axis], self.format, &truth),
            RowBase::Schlick => self.over_schlick(&truth, base),
        };
        (atlas, truth)
    }

    /// The row of differences to Schlick's form, and the coefficients behind it.
    fn over_schlick(&self, truth: &Image, base: &SchlickBase) -> Atlas {
        let size = self.axis.size;
        let rounded = base.quantised(self.format);
        let mut missed = truth.clone();
        for i in 0..size {
            let closed_form = rounded.closed_form(self.axis.node(i));
            for (c, value) in missed.texel_mut(i, 0).iter_mut().enumerate() {
                *value = (f64::from(*value) - closed_form[c]) as f32;
            }
        }
        let missed = balance(&missed, f64::NEG_INFINITY);
        let max = self.format.unorm_max().unwrap_or(1.0);
        let span = SchlickBase::span(self.format);
        // Rounded up to the next code, so that texels reach every difference. Differences below half a code are
        // dropped.
        let scale = [0, 1, 2].map(|c: usize| {
            let largest = missed.texels().map(|t| f64::from(t[c]).abs()).fold(0.0, f64::max);
            let codes = largest / (span - 1.0) * max;
            if codes < 0.5 { 0.0 } else { (libm::ceil(codes) / max).min(1.0) }
        });
        let header = SchlickBase { scale, ..*base };
        let mut texels = Image::zeros(size + SchlickBase::TEXELS, 1, 4);
        for i in 0..size {
            let texel = texels.texel_mut(i, 0);
            for c in 0..3 {
                let share = if scale[c] > 0.0 { f64::from(missed.texel(i, 0)[c]) / scale[c] } else { 0.0 };
                texel[c] = ((share + 1.0) / span) as f32;
            }
            texel[3] = 1.0;
        }
        for (k, texel) in header.texels().iter().enumerate() {
            texels.texel_mut(size + k as u32, 0).copy_from_slice(texel);
        }
        let layout =
            AtlasLayout { x: self.axis.clone(), y: None, apron: 0, columns: 1, tiles: 1, base: RowBase::Schlick };
        let (bytes, texels) = self.format.texels(&texels);
        Atlas {
            kind: TableKind::Fresnel,
            layout,
            format: self.format,
            tiles: Vec::new(),
            truth: truth.clone(),
            texels,
            bytes,
        }
    }
}

/// Fits of [`SchlickBase`].
pub(crate) trait Fit {
    /// The closed form with the exact values at normal and at grazing incidence, and the least largest error between.
    /// `scale` is left at 1.
    fn fit(reflectance: &dyn Fn(f64) -> Rgb) -> Self;
}

impl Fit for SchlickBase {
    fn fit(reflectance: &dyn Fn(f64) -> Rgb) -> Self {
        let f0 = reflectance(1.0).map(|f| f.clamp(0.0, Self::F0_MAX));
        // An interface between equal indices reflects nothing at any angle.
        let f90 = if reflectance(0.0)[1] > 0.5 { 1.0 } else { 0.0 };
        let without = Self { f0, f90, edge: [0.0; 3], scale: [1.0; 3] };
        let points: Vec<(f64, Rgb)> = (1..FIT_POINTS)
            .map(|i| {
                let u = f64::from(i) / f64::from(FIT_POINTS);
                let (cos_theta, away) = (u * u, 1.0 - u * u);
                let (exact, schlick) = (reflectance(cos_theta), without.closed_form(cos_theta));
                let dip = cos_theta * libm::pow(away, 6.0);
                (dip, [0, 1, 2].map(|c: usize| schlick[c] - exact[c]))
            })
            .collect();
        let edge = [0, 1, 2].map(|c: usize| {
            let worst =
                |edge: f64| points.iter().map(|(dip, missed)| (missed[c] - edge * dip).abs()).fold(0.0, f64::max);
            // The largest error is convex in the coefficient, so thirds of the range can be cut off.
            let (mut low, mut high) = (-Self::EDGE_MAX, Self::EDGE_MAX);
            for _ in 0..FIT_STEPS {
                let third = (high - low) / 3.0;
                if worst(low + third) <= worst(high - third) { high -= third } else { low += third }
            }
            0.5 * (low + high)
        });
        Self { edge, ..without }
    }
}

#[cfg(test)]
mod tests {
    use luthier_lut::Mapping;

    use super::*;

    fn shape(base: RowBase, format: TexelFormat) -> RowShape {
        let axis = Axis {
            quantity: "cos_theta".into(),
            unit: String::new(),
            min: 0.0,
            max: 1.0,
            size: 24,
            mapping: Mapping::Power { exponent: 2.0 },
        };
        RowShape { axis, format, base }
    }

    /// A row of Schlick's form with its dip is read exactly but for the rounding of its coefficients, which the texels make up for.
    #[test]
    fn a_row_of_the_form_itself_is_read_to_the_last_codes() {
        let exact = SchlickBase { f0: [0.04, 0.3, 0.9], f90: 1.0, edge: [0.5, -1.0, 3.0], scale: [1.0; 3] };
        let reflectance = |cos_theta: f64| exact.closed_form(cos_theta);
        let (atlas, _) =
            shape(RowBase::Schlick, TexelFormat::Rgb10a2Unorm).row(&reflectance, &SchlickBase::fit(&reflectance));
        for i in 0..=1000 {
            let cos_theta = f64::from(i) / 1000.0;
            let read = atlas.sample(0, [cos_theta, 0.0], WeightBits::Fixed(8));
            let expected = reflectance(cos_theta);
            // Rounding errors of f0 are below 1.25/2046, and what is left of them is rounded to a code of itself.
            assert!((0..3).all(|c| (read[c] - expected[c]).abs() < 5e-5), "{cos_theta} {read:?} {expected:?}");
        }
        let grazing = atlas.sample(0, [0.0, 0.0], WeightBits::Fixed(8));
        assert!(grazing[..3].iter().all(|f| (f - 1.0).abs() < 1e-6), "{grazing:?}");
    }

    #[test]
    fn no_interface_reflects_nothing() {
        let (atlas, _) =
            shape(RowBase::Schlick, TexelFormat::Rgb10a2Unorm).row(&|_| [0.0; 3], &SchlickBase::fit(&|_| [0.0; 3]));
        for i in 0..=100 {
            let read = atlas.sample(0, [f64::from(i) / 100.0, 0.0], WeightBits::Fixed(8));
            assert!(read[..3].iter().all(|f| f.abs() < 5e-5), "{read:?}");
        }
    }
}
