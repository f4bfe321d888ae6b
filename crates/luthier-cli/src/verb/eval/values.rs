//! Values for pairs of directions.

use luthier::function::{Function, Kind};
use luthier_layers::model::Estimate;
use luthier_terminal::{Outcome, print};
use rayon::prelude::*;
use serde_json::{Value, json};

use super::{Subject, describe, error, significant};
use crate::directions::Angles;

/// Prints the values for pairs (wi, wo).
pub(crate) fn values(subject: &Subject, kind: Kind, pairs: &[[Angles; 2]], json: bool) -> Outcome {
    let function = Function::new(&subject.of, &kind);
    let is_estimate = function.is_estimate();
    let found: Vec<Vec<Estimate>> =
        pairs.par_iter().map(|[wi, wo]| function.values(wi.direction(), wo.direction())).collect();
    show(subject.head(), kind, is_estimate, pairs, &found, json)
}

/// Prints values that were found, below a head of JSON.
pub(super) fn show(
    mut head: Value,
    kind: Kind,
    is_estimate: bool,
    pairs: &[[Angles; 2]],
    found: &[Vec<Estimate>],
    json: bool,
) -> Outcome {
    if json {
        let rows = std::iter::zip(pairs, found).map(|([wi, wo], values)| {
            let means: Vec<f64> = values.iter().map(|e| e.mean).collect();
            let mut row = json!({"wi_deg": wi.to_array(), "wo_deg": wo.to_array(), "value": means});
            if is_estimate {
                row["std_err"] = values.iter().map(|e| e.is_settled().then_some(e.std_err)).collect();
                row["settled"] = values.iter().map(Estimate::is_settled).collect();
            }
            row
        });
        let rows = Value::from_iter(rows);
        head["color"] = describe(&kind);
        head["values"] = rows;
        return print(&format!("{head:#}"));
    }
    let columns = kind.columns("value");
    let mut text = format!("theta_i,phi_i,theta_o,phi_o,{}", columns.join(","));
    if is_estimate {
        columns.iter().for_each(|column| text.push_str(&format!(",std_err_{column}")));
    }
    for ([wi, wo], values) in std::iter::zip(pairs, found) {
        let angles = wi.to_array().into_iter().chain(wo.to_array()).map(|angle| angle.to_string());
        let means = values.iter().map(|e| significant(e.mean));
        let errors = values.iter().filter(|_| is_estimate).map(error);
        let fields: Vec<String> = angles.chain(means).chain(errors).collect();
        text.push_str(&format!("\n{}", fields.join(",")));
    }
    print(&text)
}
