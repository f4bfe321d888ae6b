//! Values for pairs of directions.

use glam::DVec3;
use luthier_layers::layered_mc::Estimate;
use luthier_layers::monochrome::{Monochrome, in_color};
use luthier_optics::color::Color;
use luthier_optics::stack::Stack;
use rayon::prelude::*;
use serde_json::{Value, json};

use super::{Subject, at, significant};
use crate::cli::EvalOptions;
use crate::directions::Angles;
use crate::failure::Outcome;
use crate::output::print;

/// What the numbers of a value are.
pub(crate) enum Kind {
    Wavelength(f64),
    /// Light of one wavelength seen at another.
    Reradiated([f64; 2]),
    Color(Color),
}

impl Kind {
    pub(crate) fn of(options: &EvalOptions, subject: &Subject) -> Self {
        match (subject.bins_nm, options.wavelength) {
            (Some(bins_nm), _) => Self::Reradiated(bins_nm),
            (None, Some(nm)) => Self::Wavelength(nm),
            (None, None) if options.three_wavelengths => {
                Self::Color(Color::ThreeWavelengths(subject.material.bake.wavelengths_nm()))
            }
            (None, None) => Self::Color(Color::Spectral),
        }
    }

    fn columns(&self) -> &'static [&'static str] {
        match self {
            Self::Wavelength(_) | Self::Reradiated(_) => &["value"],
            Self::Color(_) => &["r", "g", "b"],
        }
    }

    fn describe(&self) -> Value {
        match self {
            Self::Wavelength(nm) => json!({"wavelength_nm": nm}),
            Self::Reradiated([light, seen]) => json!({"excitation_nm": light, "wavelength_nm": seen}),
            Self::Color(Color::Spectral) => json!("spectral"),
            Self::Color(Color::ThreeWavelengths(nm)) => json!({"three_wavelengths_nm": nm}),
        }
    }

    /// One estimate per column.
    fn values(&self, subject: &Subject, wi: DVec3, wo: DVec3) -> Vec<Estimate> {
        let (model, stack) = (subject.model.as_ref(), &subject.material.stack);
        let eval = |one: &Monochrome| match model.estimator() {
            Some(estimator) => estimator.eval_with_error(one, wi, wo),
            None => Estimate::exact(model.eval(one, wi, wo)),
        };
        match self {
            Self::Wavelength(nm) | Self::Reradiated([_, nm]) => vec![eval(&at(stack, *nm))],
            Self::Color(Color::Spectral) => {
                let wavelengths_nm = subject.material.bake.wavelengths_nm();
                let channels = [0, 1, 2].map(|c: usize| {
                    let nm = wavelengths_nm[c];
                    (nm, Monochrome::new(stack, nm, c))
                });
                match model.eval_rgb(&channels, wi, wo) {
                    Some(rgb) => rgb.map(Estimate::exact).to_vec(),
                    None => colored(&Color::Spectral, stack, eval),
                }
            }
            Self::Color(color) => colored(color, stack, eval),
        }
    }
}

/// Prints the values for pairs (wi, wo).
pub(crate) fn values(subject: &Subject, kind: Kind, pairs: &[[Angles; 2]], json: bool) -> Outcome {
    let found: Vec<Vec<Estimate>> =
        pairs.par_iter().map(|[wi, wo]| kind.values(subject, wi.direction(), wo.direction())).collect();
    let is_estimate = subject.model.estimator().is_some();
    if json {
        let rows = std::iter::zip(pairs, &found).map(|([wi, wo], values)| {
            let means: Vec<f64> = values.iter().map(|e| e.mean).collect();
            let mut row = json!({"wi_deg": wi.to_array(), "wo_deg": wo.to_array(), "value": means});
            if is_estimate {
                row["std_err"] = values.iter().map(|e| e.std_err).collect();
            }
            row
        });
        let rows = Value::from_iter(rows);
        let head = json!({"model": subject.model.info().name, "material": subject.material.name, "color": kind.describe(), "values": rows});
        return print(&format!("{head:#}"));
    }
    let mut text = format!("theta_i,phi_i,theta_o,phi_o,{}", kind.columns().join(","));
    if is_estimate {
        kind.columns().iter().for_each(|column| text.push_str(&format!(",std_err_{column}")));
    }
    for ([wi, wo], values) in std::iter::zip(pairs, &found) {
        let angles = wi.to_array().into_iter().chain(wo.to_array());
        let errors = values.iter().filter(|_| is_estimate).map(|e| e.std_err);
        let numbers = values.iter().map(|e| e.mean).chain(errors).map(significant);
        let fields: Vec<String> = angles.map(|angle| angle.to_string()).chain(numbers).collect();
        text.push_str(&format!("\n{}", fields.join(",")));
    }
    print(&text)
}

/// The value in colour, with its standard error. A stack that is the same at several wavelengths is evaluated once, so its error
/// counts with the sum of their weights; those of different stacks are independent.
fn colored(color: &Color, stack: &Stack, f: impl Fn(&Monochrome) -> Estimate) -> Vec<Estimate> {
    let mut known: Vec<(Monochrome, Estimate)> = Vec::new();
    let mut uses = Vec::new();
    let mean = in_color(stack, color, |one| {
        let index = known.iter().position(|(other, _)| other == one).unwrap_or_else(|| {
            known.push((one.clone(), f(one)));
            known.len() - 1
        });
        uses.push(index);
        known[index].1.mean
    });
    let mut weights = vec![[0.0; 3]; known.len()];
    let mut uses = uses.into_iter();
    for node in color.nodes() {
        // The order of `in_color`.
        for channel in (0..3).filter(|&c| node.weight[c] != 0.0) {
            if let Some(index) = uses.next() {
                weights[index][channel] += node.weight[channel];
            }
        }
    }
    (0..3)
        .map(|channel| {
            let variance = |(weight, (_, e)): (&[f64; 3], &(Monochrome, Estimate))| {
                let error = weight[channel] * e.std_err;
                error * error
            };
            let sum: f64 = weights.iter().zip(&known).map(variance).sum();
            Estimate { mean: mean[channel], std_err: libm::sqrt(sum) }
        })
        .collect()
}
