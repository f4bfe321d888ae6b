//! Lobes fitted to the simulated light of a stack: luthier's own model.
//!
//! A model by formulas is as good as its assumptions. This one simulates the stack once ([`crate::references::layered_mc`]), keeps the part with a
//! short closed form, and fits the rest:
//!
//! ```text
//! f cos_theta_i = F(theta_d) D G / (4 cos_theta_o)                    one facet of the first interface: exact
//!               + sum_k E_k(theta_o) / A_k(theta_o) p_k(s) ds/d omega_i   what comes from below, in lobes of slopes
//!               + E_w(theta_o) S(theta_i) cos_theta_i / N              a wide remainder
//! ```
//!
//! - **Slopes inside.** `s` is the slope of the half vector between both directions *after refraction into a medium* of relative index n. There the
//!   lobe of facets below a smooth coat is the distribution of these facets, at all angles; below a rough coat it nearly is. Between the directions
//!   outside, such a lobe shifts, widens by up to three times and is cut off.
//! - **Shapes.** A [`Shape`] is an ellipse with a tail between Beckmann's and GGX. Shift and widths depend on the view, the tail on the lobe. Channels
//!   share them.
//! - **Energies.** E are energies by channel, taken from the simulation view by view, and A is the share of a shape above the horizon. So
//!   the directional albedo of a row is that of the simulation, whatever the shapes are.
//! - **A curve** ([`Curve`]) in place of Fresnel's equations saves the root and the quotients of the first interface: a polynomial of the cosine of a facet. The energy that it
//!   gets wrong is taken from what comes from below. Limits on errors take it wherever it is near.
//! - **A short lobe** ([`Short`]) pays for less: the first interface reflects by a curve, one lobe with the tail of GGX takes the light of the remainder, too, and its widths are
//!   polynomials of the view. A row is one read.
//! - **A Lambertian base** sends light that does not remember from where it came. It has one shape at all views, that of the remainder, and a closed
//!   form in the albedo ([`BaseLight`]). Rows store it apart, so that places can recolour the base without a new fit.
//! - **Rows.** Everything that depends on the view is in rows over [`ViewAxis`], linear between. An anisotropic stack has such rows at several azimuths
//!   of the eye ([`Axes`]), linear between, too. Its shapes are in the tangents of its axes, where they hardly change with the azimuth.
//!
//! [`Judge`] compares lobes with paths that no fit saw, between rows and nodes. Bakes state these errors, and budgets limit them.
//!
//! Sampling is exact: draw a lobe, draw a slope, mirror the eye about it, refract. A direction drawn beyond the horizon has no weight.
//!
//! Simplifications: the lobes are not reciprocal.
//!
//! Half vectors outside the stack are the case n = 1. The fit tries an index next to 1 instead, whose lobes fall towards the horizon as facets mask
//! them, and takes it if its lobes are the nearest.

mod axes;
mod below;
mod draws;
mod ellipse;
mod eval;
mod family;
mod fit;
mod fitted;
mod half_vector;
mod judge;
mod leaving;
mod parameters;
mod patina;
mod rows;
mod shape;
mod tally;
#[cfg(test)]
mod tests;
mod varied;

pub use axes::Axes;
pub use below::Below;
pub use draws::{Prepared, Sample};
use family::Filmed;
pub use family::{Family, FilmLight, Mix, Paint, SlopeAxis, Slopes, Stretch, base_interface};
pub use fit::{FitSettings, Simulation};
pub use fitted::Fitted;
pub use judge::{FitError, Judge};
pub use patina::{Cover, bare};
pub use rows::{BaseLight, Critical, Curve, Lobe, OneWidth, Row, Shaping, Short, ViewAxis};
pub use shape::{Shape, TAIL_MIN, Wide};
pub(crate) use varied::scaled_along;
pub use varied::{Fit, Traced, Varied, Varying};

use glam::DVec3;
use luthier_model::{INDEX_MAX, Masking, ShadingModel};
use luthier_optics::Rgb;
use luthier_optics::color::Color;
use luthier_optics::interface::{Interface, Sampled};
use luthier_optics::ior::IorSample;
use luthier_optics::stack::{Base, Diffuse, Layer, Stack};

use crate::formulas::facets::Facets;
use crate::formulas::oren_nayar;
use crate::model::{Claims, Kind, ModelInfo};
use crate::models::room::{Kernels, Room};
use crate::monochrome::{Monochrome, MonochromeBelow};

/// The room of the model.
pub(crate) const ROOM: Room = Room {
    kernels: Kernels {
        eval: concat!(
            include_str!("family/family.wgsl"),
            include_str!("prepare/tilt.wgsl"),
            include_str!("patina/sides.wgsl"),
            include_str!("prepare/rows.wgsl"),
            include_str!("eval.wgsl")
        ),
        parts: include_str!("parts.wgsl"),
        sample: concat!(
            include_str!("draws/facet.wgsl"),
            include_str!("draws/gaussian.wgsl"),
            include_str!("draws/lobe.wgsl"),
            include_str!("draws/wide.wgsl"),
            include_str!("draws/sample.wgsl")
        ),
        environment: concat!(
            include_str!("environment/lobe.wgsl"),
            include_str!("environment/still.wgsl"),
            include_str!("environment/turned.wgsl"),
            include_str!("environment/sum.wgsl")
        ),
    },
    twin: eval::twin,
    models: || vec![Box::new(Fitted::default())],
    composed: |_| None,
};

/// Lobes of a stack, in the colour of its simulation.
#[derive(Debug, Clone)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Lobes {
    /// The first interface; none for a diffuse base alone.
    pub(crate) first: Option<FirstInterface>,
    /// Numbers for all views.
    pub frame: Frame,
    /// The axis of the rows.
    pub axis: ViewAxis,
    /// Rows from grazing views to the normal; of an anisotropic stack one azimuth after the other, [`Axes::TILES`] times.
    pub rows: Vec<Row>,
}

/// Numbers of lobes that do not depend on the view.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Frame {
    /// Relative index n of the medium in whose half vectors the lobes are.
    pub index: f64,
    /// Shape of the wide remainder.
    pub wide: Wide,
    /// Axes of an anisotropic stack, in which its lobes are. Lobes of other stacks are in the plane of the eye.
    pub axes: Option<Axes>,
    /// The diffuse base below interfaces, whose light is in the rows.
    pub base: Option<Painted>,
    /// Of an anisotropic place of a family: by what its lobes are stretched.
    pub stretch: Option<Stretch>,
    /// Source of the widths of lobes.
    pub shaping: Shaping,
    /// The reflectance of the first interface, if that is a polynomial in place of its own.
    pub curve: Option<Curve>,
}

impl Frame {
    /// The frame of lobes in a medium beside a remainder, and of rows that have all else: in the plane of the eye, above no diffuse base.
    pub fn new(index: f64, wide: Wide) -> Self {
        Self { index, wide, axes: None, base: None, stretch: None, shaping: Shaping::Rows, curve: None }
    }
}

/// A diffuse base below interfaces, which places may recolour.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Painted {
    /// Albedo in the simulation, RGB.
    pub albedo: Rgb,
    /// Whether it is Lambertian. All its light is then in the remainder, whose shape is in the rows.
    pub is_lambertian: bool,
}

/// The first interface: its facets, and its reflectance by channel.
#[derive(Debug, Clone)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct FirstInterface {
    pub(crate) facets: Facets,
    pub(crate) reflectance: Sampled,
}

impl FirstInterface {
    /// The first interface of a stack in colour; none for a diffuse base alone.
    fn of(stack: &Stack, color: &Color) -> Option<Self> {
        let interface = Interface::of(stack, 0)?;
        Some(Self { facets: Facets::new(&stack.layers[0].surface), reflectance: interface.sampled(color) })
    }

    /// Energy that single facets send to `wo`, by channel, over [`NORMALS`] visible normals; within 4e-4. Reflectances are linear between cosines
    /// whose roots are evenly spaced.
    fn energy(&self, wo: DVec3) -> Rgb {
        self.energy_by(wo, |cos_theta| self.reflectance.rgb(cos_theta))
    }

    /// [`Self::energy`] with another reflectance.
    fn energy_by(&self, wo: DVec3, reflectance: impl Fn(f64) -> Rgb) -> Rgb {
        let intervals = self.intervals();
        let mut sum = [0.0; 3];
        for (i, weight) in self.weights(wo).into_iter().enumerate().filter(|(_, weight)| *weight != 0.0) {
            let reflected = reflectance(cos_theta(i, intervals));
            (0..3).for_each(|c| sum[c] += weight * reflected[c]);
        }
        sum
    }

    /// Squared sine at which single facets that send light to `wo` are seen, and its standard deviation, if all reflect alike; see [`family::facing`].
    fn facing(&self, wo: DVec3, late: f64) -> [f64; 2] {
        let intervals = self.intervals();
        let met = self.weights(wo).into_iter().enumerate().map(|(i, weight)| {
            let cos_theta = cos_theta(i, intervals);
            ((1.0 - cos_theta) * (1.0 + cos_theta), weight)
        });
        let met: Vec<(f64, f64)> = met.collect();
        if met.iter().all(|(_, weight)| *weight == 0.0) {
            return [(1.0 - wo.z) * (1.0 + wo.z), 0.0];
        }
        family::facing(&met, late)
    }

    /// Energy of single facets that reflect all light, by the cosines between intervals.
    fn weights(&self, wo: DVec3) -> Vec<f64> {
        let intervals = self.intervals();
        let mut weights = vec![0.0; intervals + 1];
        for i in 0..NORMALS {
            // Hammersley's points.
            let u = [(f64::from(i) + 0.5) / f64::from(NORMALS), (f64::from(i.reverse_bits()) + 0.5) / 4_294_967_296.0];
            let wh = self.facets.sample(wo, u);
            let wi = 2.0 * wh.dot(wo) * wh - wo;
            let Some(lobe) = self.facets.lobe(Masking::Smith, wi, wo) else { continue };
            let weight = lobe.value / self.facets.pdf_solid_angle(wi, wo) / f64::from(NORMALS);
            let first = ((lobe.cos_theta_d.max(0.0).sqrt() * intervals as f64) as usize).min(intervals - 1);
            let [from, to] = [first, first + 1].map(|i| cos_theta(i, intervals));
            let share = (lobe.cos_theta_d - from) / (to - from);
            weights[first] += weight * (1.0 - share);
            weights[first + 1] += weight * share;
        }
        weights
    }

    /// Intervals between cosines: more where films make the reflectance wave.
    fn intervals(&self) -> usize {
        let interfaces = self.reflectance.nodes.iter().map(|(_, at)| at);
        let waves = interfaces.map(|at| at.films.iter().map(|film| film.waves).sum()).fold(0.0, f64::max);
        (f64::from(INTERVALS) * (1.0 + 4.0 * waves)).min(f64::from(NORMALS)) as usize
    }
}

/// Cosine at the end of an interval: they gather at grazing angles, where reflectances are steep.
fn cos_theta(i: usize, intervals: usize) -> f64 {
    (i as f64 / intervals as f64) * (i as f64 / intervals as f64)
}

/// Visible normals over which the first interface's energy is a mean.
const NORMALS: u32 = 4096;

/// Intervals between the cosines at which the reflectance of an interface without films is computed.
const INTERVALS: u32 = 256;

/// The model, for listings.
const INFO: ModelInfo = ModelInfo {
    name: ShadingModel::Lobes.name(),
    kind: Kind::Layered,
    claims: Claims::ENERGY,
    source: "luthier: lobes fitted to layered-mc",
    domain: "all stacks",
    leaves_out: "reciprocity; shapes that a few lobes do not have",
    inputs: &[],
};

/// The most lobes of a bake that no limit on errors bounds, and of stacks whose rows are over more than the view.
pub const LOBES: usize = 2;

/// The most lobes of a bake with limits on errors.
pub const LOBES_MAX: usize = 3;

/// The most lobes of a bake for a stack: none for one interface. Light that bounces between its facets, or comes back through them, is wide. The
/// remainder alone is within an albedo error of 0.01 (`tests/layers/bounces.rs`), and saves two reads.
pub fn most_lobes(stack: &Stack) -> usize {
    if stack.layers.len() > 1 { LOBES } else { 0 }
}

/// The most lobes that a search tries for a stack: [`LOBES_MAX`] where rows are over the view alone, and [`most_lobes`] elsewhere. A third lobe costs two reads.
pub fn most_searched(stack: &Stack, varying: Option<Varying>) -> usize {
    let is_alone = varying.is_none() && Varying::axes(varying, stack).is_none();
    if is_alone && most_lobes(stack) == LOBES { LOBES_MAX } else { most_lobes(stack) }
}

/// Whether a stack may have a [short lobe](Short): two layers or more, isotropic, without a diffuse base or a critical angle.
pub fn may_be_short(stack: &Stack) -> bool {
    let axis = ViewAxis::of(stack, FitSettings::DEFAULT_ROWS);
    let is_plain = Axes::of(stack).is_none() && base_below(stack).is_none() && axis.critical().cot_sq == 0.0;
    is_plain && most_lobes(stack) > 0
}

/// Excess error that a bake accepts for fewer lobes, see [`Simulation::fit_fewest`].
pub const EXCESS: f64 = 0.03;

impl Lobes {
    /// The lobes of a stack as in bakes: the fewest that suffice, at most [`most_lobes`], with [`FitSettings::default`].
    pub fn of(stack: &Stack, color: &Color) -> Self {
        Self::with(stack, color, FitSettings::default())
    }

    /// [`Self::of`] with settings.
    pub fn with(stack: &Stack, color: &Color, settings: FitSettings) -> Self {
        Simulation::new(&shown(stack), color, settings).fit_fewest(most_lobes(stack), EXCESS)
    }

    /// Rows of a tile: one azimuth of an anisotropic stack, or all.
    pub fn tile(&self, tile: usize) -> &[Row] {
        &self.rows[tile * self.axis.size()..(tile + 1) * self.axis.size()]
    }

    /// Reflectance of the first interface at the cosine of a facet, by channel; `None` for a diffuse base alone.
    pub(crate) fn reflected(&self, cos_theta_d: f64) -> Option<Rgb> {
        let first = self.first.as_ref()?;
        Some(self.frame.curve.map_or_else(|| first.reflectance.rgb(cos_theta_d), |curve| [curve.at(cos_theta_d); 3]))
    }

    /// The row of a view (unit, above the surface), between fitted rows.
    pub fn row(&self, wo: DVec3) -> Row {
        let c = self.axis.cosine(wo.z);
        self.frame.axes.map_or_else(|| self.row_of(0, c), |axes| axes.row(wo, |tile| self.row_of(tile, c)))
    }

    /// The row of a cosine of [`ViewAxis::cosine`] in a tile.
    pub fn row_of(&self, tile: usize, c: f64) -> Row {
        let (place, rows) = (self.axis.place_at(c), self.tile(tile));
        let first = (place as usize).min(rows.len() - 2);
        rows[first].between(&rows[first + 1], place - first as f64)
    }

    /// Light from below the first interface as seen from `wo` (unit, above the surface; `None` otherwise).
    pub fn below(&self, wo: DVec3) -> Option<Below> {
        (wo.z > 0.0).then(|| Below::new(self.frame, self.row(wo), wo))
    }

    /// The lobes as seen from `wo` (unit, above the surface; `None` otherwise).
    pub fn prepare(&self, wo: DVec3) -> Option<Prepared<'_>> {
        Prepared::new(self, wo)
    }

    /// A function of the light direction: `f cos_theta_i` by channel as seen from `wo`. A bare diffuse base has its closed form, as in shaders. `stacks`
    /// is the stack of the lobes at each wavelength.
    pub fn seen<'a>(&'a self, stacks: &'a [Monochrome; 3], wo: DVec3) -> impl Fn(DVec3) -> Rgb + 'a {
        let prepared = self.prepare(wo);
        move |wi| {
            let [r, g, b] = stacks.each_ref().map(|stack| bare_diffuse(stack, wi, wo));
            if let (Some(r), Some(g), Some(b)) = (r, g, b) {
                return [r, g, b];
            }
            prepared.as_ref().map_or([0.0; 3], |prepared| prepared.eval(wi))
        }
    }

    /// `f cos_theta_i` by channel.
    pub fn eval(&self, wi: DVec3, wo: DVec3) -> Rgb {
        self.prepare(wo).map_or([0.0; 3], |prepared| prepared.eval(wi))
    }
}

/// The stack of shaders: metals have indices up to [`INDEX_MAX`], as in layer records.
pub fn shown(stack: &Stack) -> Stack {
    let mut stack = stack.clone();
    for layer in &mut stack.layers {
        if let Base::Conductor { ior } = &mut layer.base {
            let samples = ior.samples().iter();
            let bounded = samples.map(|s| IorSample { n: s.n.min(INDEX_MAX), k: s.k.min(INDEX_MAX), ..*s });
            // Bounds keep numbers valid and in order, so the samples are still an index.
            *ior = ior.with_samples(bounded.collect()).unwrap_or_else(|_| ior.clone());
        }
    }
    stack
}

/// The diffuse base below the interfaces of a stack.
pub fn base_below(stack: &Stack) -> Option<Diffuse> {
    let [_, .., Layer { base: Base::Diffuse(base), .. }] = stack.layers.as_slice() else { return None };
    Some(*base)
}

/// `f cos_theta_i` of a diffuse base without interfaces, in closed form; `None` for another stack.
fn bare_diffuse(stack: &Monochrome, wi: DVec3, wo: DVec3) -> Option<f64> {
    let MonochromeBelow::Diffuse { albedo, sigma } = stack.layers.first()?.below else { return None };
    Some(if wi.z > 0.0 && wo.z > 0.0 { wi.z * oren_nayar::brdf_scalar(albedo, sigma, wi, wo) } else { 0.0 })
}
