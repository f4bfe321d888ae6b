//! The tables and shaders of a bake at the directions of the suite, and the light that they return in all.

use luthier_layers::layers::Layer;
use luthier_layers::registry::model;
use luthier_manifest::{Form, ShadingModel};
use luthier_optics::Rgb;
use luthier_optics::quadrature::gauss_legendre;
use serde::{Deserialize, Serialize};

use super::aim::Aim;
use super::models::{QUADRATURE, crowded_directions, eye};
use super::shaders::{ROUNDING, Stress, bright_floor};
use super::{FAILS, HOLDS, Level, Verdict};
use crate::error::ReportError;
use crate::measure::device::{Device, run};
use crate::measure::directions::Pair;
use crate::measure::references::{References, evaluate};
use crate::measure::statistics::brightest;
use crate::measure::table_terms::TableTerms;

/// Directions of the eye at which the returned light is summed up, degrees. The last one is past the angle at which albedo tables state their error.
const THETAS_DEG: [f64; 4] = [0.0, 45.0, 75.0, 89.0];

/// Points of the two quadratures on each side of the mirror direction. Their difference is the uncertainty.
const POINTS: [usize; 2] = [14, 20];

/// A material of a bake where methods fail: at every level that ships, values at stressed directions, and albedos.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Shipped {
    /// Whether the model of the material claims that it never returns more light than falls in.
    pub claims_energy: bool,
    /// Each level with each set of directions.
    pub stressed: Vec<Stressed>,
    /// Each level with each direction of the eye.
    pub albedos: Vec<ShippedAlbedo>,
}

/// Values of a level at a set of stressed directions, against the model in f64 with exact terms.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Stressed {
    /// The tables in f64, or a shader on the device.
    pub level: Level,
    /// The set of directions.
    pub directions: Aim,
    /// Values compared: three for each pair of directions.
    pub values: u64,
    /// Values that are NaN or infinite. They are no part of the rest.
    pub not_finite: u64,
    /// Largest magnitude of a value that is negative where the truth is not, and of light at or below the horizon; 0 for rounding.
    pub negative: f64,
    /// Largest relative error, with the floor [`FLOOR`](crate::FLOOR).
    pub error: f64,
    /// Of it, f32 arithmetic: largest relative difference from f64 arithmetic on the same tables. `None` for tables, which are read in f64, and for the shader
    /// without tables, whose whole error it is.
    pub arithmetic: Option<f64>,
}

/// Directional albedo of a level: the light that it returns in all, of the light that falls in from one direction.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ShippedAlbedo {
    /// The tables in f64, or a shader on the device.
    pub level: Level,
    /// Angle of the eye to the normal, degrees.
    pub theta_deg: f64,
    /// Albedo of the brightest channel; `None` where a value is not finite.
    pub albedo: Option<f64>,
    /// Difference of two quadratures.
    pub uncertainty: f64,
}

impl Stressed {
    /// The verdict of the suite on such a cell.
    pub fn verdict(&self) -> Verdict {
        if self.not_finite > 0 || self.negative > 0.0 || self.error > FAILS {
            Verdict::Fails
        } else if self.error > HOLDS {
            Verdict::Degrades
        } else {
            Verdict::Holds
        }
    }
}

impl ShippedAlbedo {
    /// Light beyond that which falls in, less the uncertainty; not positive for a level that keeps to the law.
    pub fn gain(&self) -> f64 {
        self.albedo.map_or(0.0, |albedo| albedo - 1.0 - self.uncertainty - QUADRATURE)
    }
}

impl Shipped {
    /// Values that are NaN or infinite, and albedos that contain one.
    pub fn not_finite(&self) -> u64 {
        let albedos = self.albedos.iter().filter(|a| a.albedo.is_none()).count() as u64;
        self.stressed.iter().map(|s| s.not_finite).sum::<u64>() + albedos
    }

    /// Albedos above 1 where the model claims that there are none.
    pub fn gains(&self) -> impl Iterator<Item = &ShippedAlbedo> {
        self.albedos.iter().filter(|albedo| self.claims_energy && albedo.gain() > 0.0)
    }
}

/// The material of a number at stressed directions: the tables read in f64 as the device reads them (with weights of eight bits where there is none), and the
/// shaders on the device.
pub(crate) fn shipped(
    material: u32,
    model: ShadingModel,
    references: &References,
    tables: &TableTerms<'_>,
    device: Option<&dyn Device>,
) -> Result<Shipped, ReportError> {
    let twin = &references.twin;
    let forms = [(Form::Full, Level::F32), (Form::Baked, Level::Device)];
    let runs = |device: &&dyn Device, form| form == Form::Baked || (model.has(form) && device.has(form));
    let mut out = Shipped { claims_energy: claims_energy(model), stressed: Vec::new(), albedos: Vec::new() };
    for aim in [Aim::Grazing, Aim::Mirror, Aim::Retro, Aim::Opposite] {
        let pairs = aim.pairs(&references.layers);
        let truth = evaluate(twin, references.baked(), &pairs);
        let read = evaluate(twin, tables, &pairs);
        out.stressed.push(stressed(Level::Table, aim, &pairs, &read, &truth, None));
        for (form, level) in forms {
            let Some(device) = device.filter(|device| runs(device, form)) else { continue };
            let found = run(device, form, material, &pairs)?;
            out.stressed.push(match form {
                Form::Full => {
                    let exact = evaluate(twin, references.full(), &pairs);
                    stressed(level, aim, &pairs, &found, &exact, None)
                }
                Form::Baked => stressed(level, aim, &pairs, &found, &truth, Some(&read)),
            });
        }
    }
    let quadrature = Quadrature::new(&references.layers);
    out.albedos.extend(quadrature.albedos(Level::Table, &evaluate(twin, tables, &quadrature.pairs)));
    for (form, level) in forms {
        let Some(device) = device.filter(|device| runs(device, form)) else { continue };
        out.albedos.extend(quadrature.albedos(level, &run(device, form, material, &quadrature.pairs)?));
    }
    Ok(out)
}

fn claims_energy(shading: ShadingModel) -> bool {
    model(shading.name()).is_some_and(|model| model.info().claims.conserves_energy)
}

fn stressed(
    level: Level,
    directions: Aim,
    pairs: &[Pair],
    found: &[Rgb],
    truth: &[Rgb],
    read: Option<&[Rgb]>,
) -> Stressed {
    let Stress { not_finite, negative, error } = Stress::of(pairs, found, truth);
    // A truth that is NaN makes the error infinite. JSON has no such number: it counts among the values that are not finite.
    let is_known = error.is_finite();
    let arithmetic = read.map(|read| Stress::of(pairs, found, read).error);
    Stressed {
        level,
        directions,
        values: 3 * pairs.len() as u64,
        not_finite: not_finite + u64::from(!is_known),
        negative: if negative > ROUNDING * bright_floor(truth) { negative } else { 0.0 },
        error: if is_known { error } else { 0.0 },
        arithmetic: arithmetic.filter(|error| error.is_finite()),
    }
}

/// Pairs and weights of all quadratures, in one list: that the device has one run.
struct Quadrature {
    pairs: Vec<Pair>,
    weights: Vec<f64>,
    /// Angle, and the number of pairs of the coarse quadrature and of the fine one that follows.
    parts: Vec<(f64, [usize; 2])>,
}

impl Quadrature {
    fn new(layers: &[Layer]) -> Self {
        let is_isotropic = layers.iter().all(|layer| layer.surface.alpha_x == layer.surface.alpha_y);
        let rules = POINTS.map(gauss_legendre);
        let mut out = Self { pairs: Vec::new(), weights: Vec::new(), parts: Vec::new() };
        for theta in THETAS_DEG {
            let wo = eye(theta);
            let counts = rules.each_ref().map(|rule| {
                let directions = crowded_directions(wo, rule, is_isotropic);
                let count = directions.len();
                for (wi, weight) in directions {
                    out.pairs.push((wi.as_vec3().to_array(), wo.as_vec3().to_array()));
                    out.weights.push(weight);
                }
                count
            });
            out.parts.push((theta, counts));
        }
        out
    }

    fn albedos(&self, level: Level, values: &[Rgb]) -> Vec<ShippedAlbedo> {
        let mut weighted = self.weights.iter().zip(values);
        let mut sum = |count: usize| {
            let mut sum = [0.0; 3];
            for (weight, value) in weighted.by_ref().take(count) {
                (0..3).for_each(|c| sum[c] += weight * value[c]);
            }
            if sum.iter().all(|c| c.is_finite()) { brightest(&sum) } else { f64::NAN }
        };
        let mut out = Vec::with_capacity(self.parts.len());
        for &(theta_deg, [coarse, fine]) in &self.parts {
            let (coarse, fine) = (sum(coarse), sum(fine));
            let is_finite = coarse.is_finite() && fine.is_finite();
            let uncertainty = if is_finite { (fine - coarse).abs() } else { 0.0 };
            out.push(ShippedAlbedo { level, theta_deg, albedo: is_finite.then_some(fine), uncertainty });
        }
        out
    }
}
