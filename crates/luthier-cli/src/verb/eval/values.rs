use glam::DVec3;
use luthier_layers::directional_albedo::directional_albedo;
use luthier_layers::layered_mc::Estimate;
use luthier_layers::model::Model;
use luthier_layers::monochrome::{Monochrome, in_color};
use luthier_layers::registry::{model, models};
use luthier_material::Material;
use luthier_optics::color::{Color, GRANIER_WAVELENGTHS_NM};
use luthier_optics::stack::Stack;
use rayon::prelude::*;
use serde_json::{Value, json};

use crate::cli::EvalOptions;
use crate::directions::{self, Angles};
use crate::failure::{Failure, Outcome};
use crate::materials::{read_one, valid};
use crate::output::print;

/// Angles of `--albedo`, in degrees.
const ALBEDO_THETAS_DEG: [f64; 18] =
    [0.0, 5.0, 10.0, 15.0, 20.0, 25.0, 30.0, 35.0, 40.0, 45.0, 50.0, 55.0, 60.0, 65.0, 70.0, 75.0, 80.0, 85.0];

/// Wavelength of `--albedo`, unless another is given.
const ALBEDO_WAVELENGTH_NM: f64 = 550.0;

/// Evaluates a model of a material.
pub(crate) fn run(options: &EvalOptions) -> Outcome {
    let model = model(&options.model).ok_or_else(|| {
        let known: Vec<&str> = models().iter().map(|model| model.info().name).collect();
        Failure::Input(anyhow::anyhow!("no model `{}`; known: {}", options.model, known.join(", ")))
    })?;
    let material = valid(vec![read_one(&options.file)?], false)?;
    let Some(material) = material.first() else { return Ok(()) };
    if options.albedo {
        let wavelength_nm = options.wavelength.unwrap_or(ALBEDO_WAVELENGTH_NM);
        return albedo(model.as_ref(), material, wavelength_nm, options.json);
    }
    let pairs = match (&options.directions, options.wi, options.wo) {
        (Some(path), ..) => directions::read(path)?,
        (None, Some(wi), Some(wo)) => vec![[wi, wo]],
        // The command line asks for one or the other.
        (None, ..) => Vec::new(),
    };
    values(model.as_ref(), material, &pairs, options)
}

/// What the numbers of a value are.
enum Kind {
    Wavelength(f64),
    Color(Color),
}

impl Kind {
    fn columns(&self) -> &'static [&'static str] {
        match self {
            Self::Wavelength(_) => &["value"],
            Self::Color(_) => &["r", "g", "b"],
        }
    }

    fn describe(&self) -> Value {
        match self {
            Self::Wavelength(nm) => json!({"wavelength_nm": nm}),
            Self::Color(Color::Spectral) => json!("spectral"),
            Self::Color(Color::ThreeWavelengths(nm)) => json!({"three_wavelengths_nm": nm}),
        }
    }

    /// One estimate per column.
    fn values(&self, model: &dyn Model, stack: &Stack, wi: DVec3, wo: DVec3) -> Vec<Estimate> {
        let eval = |one: &Monochrome| match model.estimator() {
            Some(estimator) => estimator.eval_with_error(one, wi, wo),
            None => Estimate::exact(model.eval(one, wi, wo)),
        };
        match self {
            Self::Wavelength(nm) => vec![eval(&at(stack, *nm))],
            Self::Color(color) => colored(color, stack, eval),
        }
    }
}

/// The stack at a wavelength, for the nearest channel.
fn at(stack: &Stack, wavelength_nm: f64) -> Monochrome {
    let distance = |channel: &usize| (GRANIER_WAVELENGTHS_NM[*channel] - wavelength_nm).abs();
    let channel = (0..3).min_by(|a, b| distance(a).total_cmp(&distance(b))).unwrap_or(1);
    Monochrome::new(stack, wavelength_nm, channel)
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

fn values(model: &dyn Model, material: &Material, pairs: &[[Angles; 2]], options: &EvalOptions) -> Outcome {
    let kind = match options.wavelength {
        Some(nm) => Kind::Wavelength(nm),
        None if options.three_wavelengths => Kind::Color(Color::ThreeWavelengths(material.bake.wavelengths_nm())),
        None => Kind::Color(Color::Spectral),
    };
    let stack = &material.stack;
    let found: Vec<Vec<Estimate>> =
        pairs.par_iter().map(|[wi, wo]| kind.values(model, stack, wi.direction(), wo.direction())).collect();
    let is_estimate = model.estimator().is_some();
    if options.json {
        let rows = std::iter::zip(pairs, &found).map(|([wi, wo], values)| {
            let means: Vec<f64> = values.iter().map(|e| e.mean).collect();
            let mut row = json!({"wi_deg": wi.to_array(), "wo_deg": wo.to_array(), "value": means});
            if is_estimate {
                row["std_err"] = values.iter().map(|e| e.std_err).collect();
            }
            row
        });
        let rows = Value::from_iter(rows);
        let head = json!({"model": options.model, "material": material.name, "color": kind.describe(), "values": rows});
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

/// Seven digits.
fn significant(value: f64) -> String {
    format!("{value:.6e}")
}

fn albedo(model: &dyn Model, material: &Material, wavelength_nm: f64, json: bool) -> Outcome {
    let stack = at(&material.stack, wavelength_nm);
    let rows: Vec<_> = ALBEDO_THETAS_DEG
        .par_iter()
        .map(|&theta_deg| {
            let wo = Angles { theta_deg, phi_deg: 0.0 }.direction();
            (theta_deg, directional_albedo(model, &stack, wo))
        })
        .collect();
    if json {
        let entries = rows.iter().map(|(theta_deg, a)| {
            let method = if a.is_estimate { "estimate" } else { "quadrature" };
            json!({"theta_o_deg": theta_deg, "albedo": a.value, "error": a.error, "method": method})
        });
        let entries = Value::from_iter(entries);
        let name = model.info().name;
        let head = json!({"model": name, "material": material.name, "wavelength_nm": wavelength_nm, "albedo": entries});
        return print(&format!("{head:#}"));
    }
    let error = if rows.iter().any(|(_, a)| a.is_estimate) { "std_err" } else { "change_on_doubling" };
    let mut text = format!("theta_o,albedo,{error}");
    for (theta_deg, a) in &rows {
        text.push_str(&format!("\n{theta_deg},{},{}", significant(a.value), significant(a.error)));
    }
    print(&text)
}
