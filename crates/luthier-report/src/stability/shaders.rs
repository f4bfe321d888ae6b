//! The shaders: tables in f64, and both forms on the adapter.

use glam::DVec3;
use luthier_layers::elek::{self, ALPHA_MIN};
use luthier_layers::model::Model;
use luthier_layers::monochrome::Monochrome;
use luthier_layers::real_time::Twin;
use luthier_layers::registry::model;
use luthier_layers::statistics::diffuse_base::{DiffuseBase, Veil};
use luthier_layers::statistics::energy::FresnelEnergy;
use luthier_layers::statistics::evaluate::{Follow, evaluate};
use luthier_layers::statistics::layers::Layers;
use luthier_layers::statistics::spread::Covariance;
use luthier_layers::terms::Exact;
use luthier_lut::{ColorMode, MaterialEntry, ShadingModel};
use luthier_optics::Rgb;
use luthier_optics::color::Color;
use luthier_optics::stack::Stack;

use super::case::StressCase;
use super::{Cell, Fault, Level};
use crate::statistics::{brightest, relative_error};
use crate::{Device, FLOOR, Form, Pair, ReportError, Subject, TableTerms, Weights};

/// Below this a negative channel is rounding.
const ROUNDING: f64 = 1e-6;

/// The shaders of a model on all cases. The materials of the subject are the cases, in order. Without a device, tables alone.
///
/// # Errors
/// See [`ReportError`].
pub fn shader_cells(
    subject: &Subject<'_>,
    device: Option<&dyn Device>,
    cases: &[StressCase],
    progress: &mut dyn FnMut(),
) -> Result<Vec<Cell>, ReportError> {
    subject.check()?;
    let mut cells = Vec::new();
    for (number, (case, entry)) in cases.iter().zip(&subject.manifest.materials).enumerate() {
        let pairs = case.aim.pairs(&elek::layers(&case.stack));
        let method = entry.model.name();
        let of = |level, found: &[Rgb], truth: &[Rgb]| cell(level, method, case, &pairs, found, truth);
        let baked = truth(entry, &case.stack, Form::Baked, &pairs);
        if Twin::MODELS.contains(&method) {
            let color = color(entry);
            if let Some(twin) = Twin::new(method, &case.stack, entry.wavelengths_nm, color) {
                let terms = TableTerms::new(subject, number, Weights::EightBit)?;
                let found = at(&pairs, |wi, wo| twin.eval(&terms, wi, wo));
                cells.push(of(Level::Table, &found, &baked));
            }
        }
        if let Some(device) = device {
            let run = |form| crate::judge::run(device, form, number as u32, &pairs);
            cells.push(of(Level::F32, &run(Form::Full)?, &truth(entry, &case.stack, Form::Full, &pairs)));
            cells.push(of(Level::Device, &run(Form::Baked)?, &baked));
        }
        progress();
    }
    Ok(cells)
}

fn color(entry: &MaterialEntry) -> Color {
    match entry.color {
        ColorMode::Spectral => Color::Spectral,
        ColorMode::ThreeWavelengths => Color::ThreeWavelengths(entry.wavelengths_nm),
    }
}

fn at(pairs: &[Pair], eval: impl Fn(DVec3, DVec3) -> Rgb) -> Vec<Rgb> {
    let wide = |w: [f32; 3]| DVec3::from(w.map(f64::from));
    pairs.iter().map(|&(wi, wo)| eval(wide(wi), wide(wo))).collect()
}

/// The same model in f64 with exact terms.
fn truth(entry: &MaterialEntry, stack: &Stack, form: Form, pairs: &[Pair]) -> Vec<Rgb> {
    let wavelengths = entry.wavelengths_nm;
    let shown = match form {
        Form::Baked => color(entry),
        Form::Full => Color::ThreeWavelengths(wavelengths),
    };
    if let Some(twin) = Twin::new(entry.model.name(), stack, wavelengths, color(entry)) {
        let exact = Exact::new(stack, shown);
        return at(pairs, |wi, wo| twin.eval(&exact, wi, wo));
    }
    match (form, entry.model) {
        (Form::Full, ShadingModel::Yamaguchi) => level_facets(entry, stack, |layers, energy, base, wi, wo| {
            evaluate::<Covariance, 3>(layers, energy, base, Follow::Eye, wi, wo)
        })(pairs),
        (Form::Full, _) => level_facets(entry, stack, |layers, energy, base, wi, wo| {
            evaluate::<f64, 3>(layers, energy, base, Follow::Eye, wi, wo)
        })(pairs),
        (Form::Baked, _) => by_wavelength(entry.model.name(), stack, shown, pairs),
    }
}

type Evaluate = fn(&Layers<3>, &FresnelEnergy, Option<&DiffuseBase<3>>, DVec3, DVec3) -> Rgb;

/// The statistics with facets that count as level: what the form without tables evaluates. What the layers do to the light of a diffuse base
/// is a constant of the material in both forms, with facets as they are.
fn level_facets(entry: &MaterialEntry, stack: &Stack, eval: Evaluate) -> impl Fn(&[Pair]) -> Vec<Rgb> {
    let (layers, energy) = (Layers::rgb(stack), FresnelEnergy::new(stack, entry.wavelengths_nm));
    let constants = &entry.constants;
    let veil = Veil { internal: constants.internal_reflectance, upward: [1.0 - constants.upward_loss; 3] };
    let base = DiffuseBase::veiled(&layers, veil);
    move |pairs| at(pairs, |wi, wo| eval(&layers, &energy, base.as_ref(), wi, wo))
}

/// The registered model, wavelength by wavelength, with the slope parameters of layer records.
fn by_wavelength(name: &str, stack: &Stack, color: Color, pairs: &[Pair]) -> Vec<Rgb> {
    let Some(model) = model(name) else { return Vec::new() };
    let mut clamped = stack.clone();
    for layer in &mut clamped.layers {
        for alpha in [&mut layer.surface.alpha_x, &mut layer.surface.alpha_y] {
            *alpha = alpha.clamp(ALPHA_MIN, 1.0);
        }
    }
    let mut sums = vec![[0.0; 3]; pairs.len()];
    let mut known: Vec<(Monochrome, Vec<f64>)> = Vec::new();
    for node in color.nodes() {
        for channel in (0..3).filter(|&channel| node.weight[channel] != 0.0) {
            let one = Monochrome::new(&clamped, node.wavelength_nm, channel);
            let values = match known.iter().find(|(stack, _)| *stack == one) {
                Some((_, values)) => values.clone(),
                None => {
                    let values = values(model.as_ref(), &one, pairs);
                    known.push((one, values.clone()));
                    values
                }
            };
            for (sum, value) in sums.iter_mut().zip(values) {
                sum[channel] += node.weight[channel] * value;
            }
        }
    }
    sums
}

fn values(model: &dyn Model, stack: &Monochrome, pairs: &[Pair]) -> Vec<f64> {
    at(pairs, |wi, wo| [model.eval(stack, wi, wo); 3]).into_iter().map(|[value, ..]| value).collect()
}

fn cell(level: Level, method: &str, case: &StressCase, pairs: &[Pair], found: &[Rgb], truth: &[Rgb]) -> Cell {
    let mut worst = 0.0_f64;
    let mut below = 0.0_f64;
    for ((&(wi, wo), found), truth) in pairs.iter().zip(found).zip(truth) {
        if found.iter().any(|value| !value.is_finite()) {
            return Cell::new(level, method, &case.id, Some(Fault::NotFinite), 0.0);
        }
        let is_lit = wi[2] > 0.0 && wo[2] > 0.0;
        let bright = brightest(truth);
        for (value, expected) in found.iter().zip(truth) {
            if !is_lit {
                below = below.max(value.abs());
            } else if *value < -ROUNDING && *expected >= 0.0 {
                below = below.max(-value);
            }
            worst = worst.max(relative_error(*value, *expected, bright, FLOOR));
        }
    }
    let fault = (below > ROUNDING * bright_floor(truth)).then_some(Fault::Negative);
    Cell::new(level, method, &case.id, fault, if fault.is_some() { below } else { worst })
}

/// What rounding is relative to: the brightest value, at least 1.
fn bright_floor(values: &[Rgb]) -> f64 {
    values.iter().map(brightest).fold(1.0, f64::max)
}
