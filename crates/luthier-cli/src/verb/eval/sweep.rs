//! Tables against the angle of the eye.

use luthier::function::{Albedo, Function, Kind, parts, textured};
use luthier_layers::directional_albedo::DirectionalAlbedo;
use luthier_layers::furnace::furnace;
use luthier_layers::model::{Estimate, Model};
use luthier_layers::models::elek::environment;
use luthier_layers::models::parts::Parts;
use luthier_layers::models::room;
use luthier_manifest::LowerReflectance;
use luthier_terminal::{Failure, Outcome, print};
use rayon::prelude::*;
use serde_json::{Value, json};

use super::{Subject, WAVELENGTH_NM, at, describe, error, significant};
use crate::cli::EvalOptions;
use crate::directions::Angles;

/// Angles, in degrees, unless others are given.
const THETAS_DEG: [f64; 18] =
    [0.0, 5.0, 10.0, 15.0, 20.0, 25.0, 30.0, 35.0, 40.0, 45.0, 50.0, 55.0, 60.0, 65.0, 70.0, 75.0, 80.0, 85.0];

/// Quantity that is tabulated.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Sweep {
    Albedo,
    Furnace,
    Environment,
}

impl Sweep {
    fn name(self) -> &'static str {
        match self {
            Self::Albedo => "albedo",
            Self::Furnace => "furnace",
            Self::Environment => "environment",
        }
    }
}

/// The angles to tabulate.
pub(crate) fn thetas_deg(options: &EvalOptions) -> Vec<f64> {
    if options.angles.is_empty() { THETAS_DEG.to_vec() } else { options.angles.clone() }
}

/// The model with the parts that the file chooses; `None` if it chooses none.
fn of_file(subject: &Subject) -> Outcome<Option<Box<dyn Model>>> {
    let (parts, reflectance) = parts(&subject.of);
    let info = subject.of.model.info();
    let (name, Some(model)) = (info.name, info.shading()) else { return Ok(None) };
    let lower = subject.of.material.bake.lower_reflectance.unwrap_or_default();
    if lower == LowerReflectance::InAir && model.is_path() {
        let text = format!(
            "`--furnace` of `{name}` has interfaces in their places, and the file chooses `lower_reflectance = \"{lower}\"`: leave that out"
        );
        return Err(Failure::Input(anyhow::anyhow!(text)));
    }
    if parts == Parts::PLAIN {
        return Ok(None);
    }
    if reflectance.is_fitted() && model.is_path() {
        let text = format!(
            "`--furnace` of `{name}` has Fresnel's equations, and the file chooses `{reflectance}`: leave that out"
        );
        return Err(Failure::Input(anyhow::anyhow!(text)));
    }
    if model.is_statistical() {
        let text =
            format!("`--furnace` of `{name}` has FGD-infinity, and the file chooses `{reflectance}`: leave that out");
        return Err(Failure::Input(anyhow::anyhow!(text)));
    }
    let beams = parts.beams.leaning(subject.of.place.under.inner_normal);
    let model = (room(model).composed)(Parts { beams, ..parts });
    Ok(model.map(|model| textured(subject.of.place.sample, model)))
}

/// Prints a table.
pub(crate) fn sweep(subject: &Subject, what: Sweep, kind: &Kind, options: &EvalOptions) -> Outcome {
    let wavelength_nm = match kind {
        Kind::Wavelength(nm) | Kind::Reradiated([_, nm]) => *nm,
        Kind::Color(_) => WAVELENGTH_NM,
    };
    let stack = at(&subject.of.material.stack, wavelength_nm);
    let own = if what == Sweep::Furnace { of_file(subject)? } else { None };
    let model = own.as_deref().unwrap_or(subject.of.model.as_ref());
    let function = (what == Sweep::Albedo).then(|| Function::new(&subject.of, kind));
    // A furnace and an environment are of all layers; a coat with a weight is a blend of two surfaces.
    let bare = subject
        .of
        .weight
        .map(|weight| (weight, at(&subject.of.material.bare(&subject.of.material.stack), wavelength_nm)));
    let of_stack = |stack: &_, wo| match what {
        Sweep::Albedo | Sweep::Furnace => single(furnace(model, stack, wo)),
        Sweep::Environment => {
            Albedo { values: vec![Estimate::exact(environment(stack, wo, |_| 1.0))], changes: Some(vec![0.0]) }
        }
    };
    let rows: Vec<(f64, Albedo)> = thetas_deg(options)
        .par_iter()
        .map(|&theta_deg| {
            let wo = Angles { theta_deg, phi_deg: options.azimuth }.direction();
            let row = match (&function, &bare) {
                (Some(function), _) => function.albedo(wo),
                (None, None) => of_stack(&stack, wo),
                (None, Some((weight, bare))) => of_stack(&stack, wo).over(*weight, of_stack(bare, wo)),
            };
            (theta_deg, row)
        })
        .collect();
    let columns = kind.columns(if what == Sweep::Furnace { "radiance" } else { what.name() });
    if options.json {
        let entries: Value = rows.iter().map(|(theta_deg, row)| entry(what, *theta_deg, row)).collect();
        let mut head = subject.head();
        match kind {
            Kind::Color(_) => head["color"] = describe(kind),
            Kind::Wavelength(_) | Kind::Reradiated(_) => head["wavelength_nm"] = json!(wavelength_nm),
        }
        if let Some([excitation_nm, _]) = subject.bins_nm {
            head["excitation_nm"] = json!(excitation_nm);
        }
        head[what.name()] = entries;
        return print(&format!("{head:#}"));
    }
    let error_name = if rows.iter().any(|(_, row)| row.changes.is_none()) { "std_err" } else { "change_on_doubling" };
    let error_names = columns.iter().map(|column| match columns.len() {
        1 => error_name.to_owned(),
        _ => format!("{error_name}_{column}"),
    });
    let mut names: Vec<String> =
        std::iter::once("theta_o".to_owned()).chain(columns.iter().map(|c| (*c).to_owned())).collect();
    match what {
        Sweep::Albedo => names.extend(error_names),
        Sweep::Furnace => names.extend(std::iter::once("deviation".to_owned()).chain(error_names)),
        Sweep::Environment => {}
    }
    let mut text = names.join(",");
    for (theta_deg, Albedo { values, changes }) in &rows {
        let means = values.iter().map(|value| significant(value.mean));
        let errors: Vec<String> = match changes {
            Some(changes) => changes.iter().map(|change| significant(*change)).collect(),
            None => values.iter().map(error).collect(),
        };
        let fields: Vec<String> = match what {
            Sweep::Albedo => means.chain(errors).collect(),
            Sweep::Furnace => means.chain(values.iter().map(|v| significant(v.mean - 1.0))).chain(errors).collect(),
            Sweep::Environment => means.collect(),
        };
        text.push_str(&format!("\n{theta_deg},{}", fields.join(",")));
    }
    print(&text)
}

fn entry(what: Sweep, theta_deg: f64, Albedo { values, changes }: &Albedo) -> Value {
    let means = listed(values.iter().map(|value| json!(value.mean)).collect());
    let errors = listed(match changes {
        Some(changes) => changes.iter().map(|change| json!(change)).collect(),
        None => values.iter().map(|value| json!(value.is_settled().then_some(value.std_err))).collect(),
    });
    let method = if changes.is_none() { "estimate" } else { "quadrature" };
    let mut row = json!({"theta_o_deg": theta_deg});
    match what {
        Sweep::Albedo => row["albedo"] = means,
        Sweep::Furnace => {
            row["deviation"] = json!(values[0].mean - 1.0);
            row["radiance"] = means;
        }
        Sweep::Environment => {
            row["environment"] = means;
            return row;
        }
    }
    (row["error"], row["method"]) = (errors, json!(method));
    row
}

/// Numbers as a JSON array; a single number as itself.
fn listed(numbers: Vec<Value>) -> Value {
    match <[Value; 1]>::try_from(numbers) {
        Ok([only]) => only,
        Err(all) => Value::Array(all),
    }
}

/// A row with a single value.
fn single(row: DirectionalAlbedo) -> Albedo {
    Albedo {
        values: vec![if row.is_estimate { Estimate::known(row.value, row.error) } else { Estimate::exact(row.value) }],
        changes: (!row.is_estimate).then(|| vec![row.error]),
    }
}
