//! Tables against the angle of the eye.

use luthier_layers::directional_albedo::{DirectionalAlbedo, directional_albedo};
use luthier_layers::elek_model::environment;
use luthier_layers::furnace::furnace;
use rayon::prelude::*;
use serde_json::{Value, json};

use super::{Subject, at, significant};
use crate::directions::Angles;
use crate::failure::Outcome;
use crate::output::print;

/// Angles, in degrees.
const THETAS_DEG: [f64; 18] =
    [0.0, 5.0, 10.0, 15.0, 20.0, 25.0, 30.0, 35.0, 40.0, 45.0, 50.0, 55.0, 60.0, 65.0, 70.0, 75.0, 80.0, 85.0];

/// Wavelength, unless another is given.
const WAVELENGTH_NM: f64 = 550.0;

/// What is tabulated.
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

/// Prints a table.
pub(crate) fn sweep(subject: &Subject, what: Sweep, wavelength_nm: Option<f64>, json: bool) -> Outcome {
    let wavelength_nm = subject.bins_nm.map(|[_, seen]| seen).or(wavelength_nm).unwrap_or(WAVELENGTH_NM);
    let stack = at(&subject.material.stack, wavelength_nm);
    let model = subject.model.as_ref();
    let rows: Vec<(f64, DirectionalAlbedo)> = THETAS_DEG
        .par_iter()
        .map(|&theta_deg| {
            let wo = Angles { theta_deg, phi_deg: 0.0 }.direction();
            let row = match what {
                Sweep::Albedo => directional_albedo(model, &stack, wo),
                Sweep::Furnace => furnace(model, &stack, wo),
                Sweep::Environment => {
                    DirectionalAlbedo { value: environment(&stack, wo, |_| 1.0), error: 0.0, is_estimate: false }
                }
            };
            (theta_deg, row)
        })
        .collect();
    if json {
        let entries: Value = rows.iter().map(|(theta_deg, row)| entry(what, *theta_deg, row)).collect();
        let mut head = json!({
            "model": model.info().name,
            "material": subject.material.name,
            "wavelength_nm": wavelength_nm,
        });
        if let Some([excitation_nm, _]) = subject.bins_nm {
            head["excitation_nm"] = json!(excitation_nm);
        }
        head[what.name()] = entries;
        return print(&format!("{head:#}"));
    }
    let error = if rows.iter().any(|(_, row)| row.is_estimate) { "std_err" } else { "change_on_doubling" };
    let mut text = match what {
        Sweep::Albedo => format!("theta_o,albedo,{error}"),
        Sweep::Furnace => format!("theta_o,radiance,deviation,{error}"),
        Sweep::Environment => "theta_o,environment".to_owned(),
    };
    for (theta_deg, DirectionalAlbedo { value, error, .. }) in &rows {
        let numbers = match what {
            Sweep::Albedo => vec![*value, *error],
            Sweep::Furnace => vec![*value, value - 1.0, *error],
            Sweep::Environment => vec![*value],
        };
        let fields: Vec<String> = numbers.into_iter().map(significant).collect();
        text.push_str(&format!("\n{theta_deg},{}", fields.join(",")));
    }
    print(&text)
}

fn entry(what: Sweep, theta_deg: f64, row: &DirectionalAlbedo) -> Value {
    let method = if row.is_estimate { "estimate" } else { "quadrature" };
    match what {
        Sweep::Albedo => json!({"theta_o_deg": theta_deg, "albedo": row.value, "error": row.error, "method": method}),
        Sweep::Furnace => json!({
            "theta_o_deg": theta_deg,
            "radiance": row.value,
            "deviation": row.value - 1.0,
            "error": row.error,
            "method": method,
        }),
        Sweep::Environment => json!({"theta_o_deg": theta_deg, "environment": row.value}),
    }
}
