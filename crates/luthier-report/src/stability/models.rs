//! The models in f64.

use std::f64::consts::{FRAC_PI_2, PI};

use glam::DVec3;
use luthier_layers::layers::Layers;
use luthier_layers::model::{Estimate, Estimator, Inputs, Kind, Model, ModelInfo};
use luthier_layers::monochrome::{Monochrome, MonochromeBelow};
use luthier_layers::references::closed_form::ClosedForm;
use luthier_layers::references::layered_mc::{InterfaceMode, LayeredMc};
use luthier_layers::registry::models;
use luthier_model::Family;
use luthier_optics::quadrature::gauss_legendre;
use luthier_optics::stack::Base;
use rayon::prelude::*;

use super::case::StressCase;
use super::{Cell, Fault, Level, RECIPROCITY};
use crate::measure::directions::{Pair, wide};
use crate::measure::statistics::FLOOR;

/// Wavelength and channel at which models are compared.
const WAVELENGTH_NM: f64 = 525.0;
const CHANNEL: usize = 1;

/// Paths of the truth at each angle: a standard error of at most 0.004.
const PATHS: u64 = 1 << 14;

/// Standard errors of the truth that are taken off the error of a model.
const SIGMAS: f64 = 4.0;

/// Samples of a model that is itself an estimate, and the stride over its pairs. Laws need no precision.
const ESTIMATOR_SAMPLES: u64 = 32;
const ESTIMATOR_STRIDE: usize = 8;

/// Excess of an albedo over 1 that counts as the error of the quadrature.
pub(super) const QUADRATURE: f64 = 2e-3;

/// All models on all cases that they apply to. `progress` is called after every case.
pub fn model_cells(cases: &[StressCase], progress: &(dyn Fn() + Sync)) -> Vec<Cell> {
    let models = models();
    let rows: Vec<Vec<Cell>> = cases
        .par_iter()
        .map(|case| {
            let stack = Monochrome::new(&case.stack, WAVELENGTH_NM, CHANNEL);
            let pairs = case.aim.pairs(&Layers::isotropic_rgb(&case.stack).layers);
            let truths: Vec<Estimate> = case.aim.thetas_deg().iter().map(|&theta| truth(&stack, eye(theta))).collect();
            let cells = models
                .iter()
                .filter(|model| is_for(&model.info(), case))
                .map(|model| cell(model.as_ref(), case, &stack, &pairs, &truths))
                .collect();
            progress();
            cells
        })
        .collect();
    let cells: Vec<Cell> = rows.into_iter().flatten().collect();
    // Sorted by the registry, then by the cases.
    models
        .iter()
        .flat_map(|m| cells.iter().filter(|c| c.method == m.info().name).cloned().collect::<Vec<_>>())
        .collect()
}

pub(super) fn eye(theta_deg: f64) -> DVec3 {
    let (sin, cos) = libm::sincos(theta_deg.to_radians());
    DVec3::new(sin, 0.0, cos)
}

/// Name of the truth that albedos are compared with.
pub(super) fn truth_name(case: &StressCase) -> &'static str {
    if case.aim.thetas_deg().is_empty() {
        "laws only"
    } else if is_smooth(&Monochrome::new(&case.stack, WAVELENGTH_NM, CHANNEL)) {
        "closed form"
    } else {
        "layered-mc"
    }
}

/// Whether the closed form is exact: all interfaces are smooth, and diffuse bases are Lambert's.
fn is_smooth(stack: &Monochrome) -> bool {
    stack.layers.iter().all(|layer| match layer.below {
        MonochromeBelow::Diffuse { sigma, .. } => sigma == 0.0,
        _ => layer.surface.is_smooth(),
    })
}

/// Largest k in the truth. Beyond it, fourth powers in the reference's formulas overflow; already at it, a metal reflects everything to the last digit.
const IDEAL_K: f64 = 1e30;

fn truth(stack: &Monochrome, wo: DVec3) -> Estimate {
    let mut stack = stack.clone();
    for layer in &mut stack.layers {
        if let MonochromeBelow::Conductor { ior } = &mut layer.below {
            ior.im = ior.im.min(IDEAL_K);
        }
    }
    let stack = &stack;
    if is_smooth(stack) {
        ClosedForm.albedo_with_error(stack, wo, DVec3::Z)
    } else {
        LayeredMc::new(InterfaceMode::SmithWalk).albedo(stack, wo, PATHS)
    }
}

/// Whether a model applies to a case. A model of one interface is not judged on stacks with layers below it.
fn is_for(info: &ModelInfo, case: &StressCase) -> bool {
    let layers = &case.stack.layers;
    let ends_diffuse = layers.last().is_some_and(|layer| matches!(layer.base, Base::Diffuse(_)));
    match (info.kind, info.name) {
        (_, "lambert" | "oren-nayar") => layers.len() == 1 && ends_diffuse,
        (_, "fluorescence") => layers.len() == 2 && ends_diffuse,
        (_, "closed-form") => is_smooth(&Monochrome::new(&case.stack, WAVELENGTH_NM, CHANNEL)),
        (Kind::Surface, _) if info.shading().is_some_and(|model| model.facts().family == Family::Coefficients) => true,
        (Kind::Surface, _) | (_, "random-walk") => layers.len() == 1 && !ends_diffuse,
        (Kind::Density, _) => case.aim != super::Aim::Ordinary || layers.len() == 1,
        _ => true,
    }
}

/// Whether albedos are compared. Densities have none, and models of places have a different one at each place.
fn has_albedo(info: &ModelInfo) -> bool {
    !matches!(info.kind, Kind::Density | Kind::Place)
}

fn cell(model: &dyn Model, case: &StressCase, stack: &Monochrome, pairs: &[Pair], truths: &[Estimate]) -> Cell {
    let info = model.info();
    let inputs = Inputs { samples: Some(ESTIMATOR_SAMPLES), ..Inputs::default() };
    let cheap = model.estimator().and_then(|_| model.with_inputs(&inputs));
    let (law, law_error) = match &cheap {
        Some(cheap) => laws(cheap.as_ref(), &info, stack, pairs, ESTIMATOR_STRIDE),
        None => laws(model, &info, stack, pairs, 1),
    };
    if law.is_some() {
        return Cell::new(Level::F64, info.name, &case.id, law, law_error);
    }
    let mut worst = law_error;
    if has_albedo(&info) {
        for (&theta, truth) in case.aim.thetas_deg().iter().zip(truths) {
            let found = albedo(model, stack, eye(theta));
            let noise = SIGMAS * truth.std_err + found.error;
            if !found.value.is_finite() {
                return Cell::new(Level::F64, info.name, &case.id, Some(Fault::NotFinite), 0.0);
            }
            let gain = found.value - 1.0 - noise - QUADRATURE;
            if info.claims.conserves_energy && gain > 0.0 {
                return Cell::new(Level::F64, info.name, &case.id, Some(Fault::Gains), found.value - 1.0);
            }
            let error = (found.value - truth.mean).abs() - noise;
            // NaN in the truth counts as an infinite error: it must not pass for agreement.
            worst = if error.is_nan() { f64::INFINITY } else { worst.max(error) };
        }
    }
    Cell::new(Level::F64, info.name, &case.id, None, worst.max(0.0))
}

/// A directional albedo with its uncertainty.
struct Albedo {
    value: f64,
    error: f64,
}

/// Directional albedo by the model's own estimate, with four standard errors as its error; or by quadrature, with the change from fewer points as its
/// error. All models have one quadrature rule: it is within 1% on the smoothest lobe, for a hundredth of the work of
/// `luthier_layers::directional_albedo`.
fn albedo(model: &dyn Model, stack: &Monochrome, wo: DVec3) -> Albedo {
    if let Some(estimator) = model.estimator() {
        let own = estimator.albedo_with_error(stack, wo, DVec3::Z);
        return Albedo { value: own.mean, error: SIGMAS * own.std_err };
    }
    let [coarse, fine] = POINTS.map(|points| integral(model, stack, wo, points));
    Albedo { value: fine, error: (fine - coarse).abs() }
}

/// Points on each side of the mirror direction.
const POINTS: [usize; 2] = [20, 28];

/// The integral of `f cos_theta_i`, for an eye at azimuth 0.
fn integral(model: &dyn Model, stack: &Monochrome, wo: DVec3, points: usize) -> f64 {
    let is_isotropic = stack.layers.iter().all(|layer| layer.surface.alpha_x == layer.surface.alpha_y);
    let directions = crowded_directions(wo, &gauss_legendre(points), is_isotropic).into_iter();
    directions.map(|(wi, weight)| weight * model.eval(stack, wi, wo)).sum()
}

/// Directions and weights of a quadrature over the hemisphere, for an eye at azimuth 0. Points crowd at the mirror direction. Isotropic surfaces are
/// integrated over one half.
pub(super) fn crowded_directions(wo: DVec3, rule: &[(f64, f64)], is_isotropic: bool) -> Vec<(DVec3, f64)> {
    let theta_o = libm::atan2(wo.x, wo.z);
    let mut phis = crowded(rule, PI, -PI);
    if is_isotropic {
        phis.iter_mut().for_each(|(_, weight)| *weight *= 2.0);
    } else {
        phis.extend(crowded(rule, PI, PI));
    }
    let thetas = [-theta_o, FRAC_PI_2 - theta_o].into_iter().flat_map(|length| crowded(rule, theta_o, length));
    let mut out = Vec::new();
    for (theta, d_theta) in thetas {
        let (sin_theta, cos_theta) = libm::sincos(theta);
        for &(phi, d_phi) in &phis {
            let (sin_phi, cos_phi) = libm::sincos(phi);
            let wi = DVec3::new(sin_theta * cos_phi, sin_theta * sin_phi, cos_theta);
            out.push((wi, d_theta * sin_theta * d_phi));
        }
    }
    out
}

/// Points and weights of a rule over an interval, which by the fifth power crowd at its start.
fn crowded(rule: &[(f64, f64)], start: f64, length: f64) -> Vec<(f64, f64)> {
    let points = rule.iter().map(|&(t, weight)| {
        let t4 = t * t * t * t;
        (start + length * t4 * t, 5.0 * t4 * weight * length.abs())
    });
    points.collect()
}

/// The first broken law, with the size of the breach.
fn laws(
    model: &dyn Model,
    info: &ModelInfo,
    stack: &Monochrome,
    pairs: &[Pair],
    stride: usize,
) -> (Option<Fault>, f64) {
    let mut asymmetry = 0.0_f64;
    for &(wi, wo) in pairs.iter().step_by(stride) {
        let (wi, wo) = (wide(wi).normalize(), wide(wo).normalize());
        let value = model.eval(stack, wi, wo);
        if !value.is_finite() {
            return (Some(Fault::NotFinite), 0.0);
        }
        if value < 0.0 || (value != 0.0 && wi.z.min(wo.z) <= 0.0) {
            return (Some(Fault::Negative), value.abs());
        }
        if info.claims.reciprocal && info.kind != Kind::Density && model.estimator().is_none() && wi.z.min(wo.z) > 0.0 {
            let (f, back) = (value * wo.z, model.eval(stack, wo, wi) * wi.z);
            // The divisor has a floor: values far below a white diffuser may be rounding in both directions.
            let size = f.abs().max(back.abs()).max(FLOOR * wi.z * wo.z);
            asymmetry = asymmetry.max((f - back).abs() / size);
        }
    }
    if asymmetry > RECIPROCITY { (Some(Fault::NotReciprocal), asymmetry) } else { (None, 0.0) }
}
