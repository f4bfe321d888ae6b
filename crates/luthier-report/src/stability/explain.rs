//! Reasons why methods do not hold, each with a limit on the error that it explains.

use std::collections::BTreeMap;
use std::sync::LazyLock;

use serde::Deserialize;

use super::{Cell, Fault, Level, Verdict};

/// A reason, with the cells that it explains.
#[derive(Debug, Clone, Deserialize)]
pub struct Explanation {
    /// Its name.
    pub name: String,
    /// Levels.
    pub levels: Vec<Level>,
    /// Names of methods. A `*` at the end or at the beginning stands for any text; the name of a model also stands for the model with other tables.
    pub methods: Vec<String>,
    /// Identifiers of cases, likewise.
    pub cases: Vec<String>,
    /// Faults.
    pub faults: Vec<Fault>,
    /// Largest error that it explains.
    pub limit: f64,
    /// The reason.
    pub reason: String,
}

/// The file of reasons.
#[derive(Default, Deserialize)]
struct File {
    /// Cases by the name of a group.
    groups: BTreeMap<String, Vec<String>>,
    explanations: Vec<Explanation>,
}

/// All reasons. The file is part of the program, and tests show that it can be read.
static ALL: LazyLock<Vec<Explanation>> = LazyLock::new(|| {
    let File { groups, mut explanations } = serde_json::from_str(include_str!("explanations.json")).unwrap_or_default();
    for Explanation { cases, .. } in &mut explanations {
        if let [group] = &cases[..]
            && let Some(members) = groups.get(group)
        {
            cases.clone_from(members);
        }
    }
    explanations
});

/// All reasons; the first that fits counts.
pub fn explanations() -> &'static [Explanation] {
    &ALL
}

fn matches(patterns: &[String], name: &str) -> bool {
    patterns.iter().any(|p| match (p.strip_suffix('*'), p.strip_prefix('*')) {
        (Some(start), _) => name.starts_with(start),
        (None, Some(end)) => name.ends_with(end),
        (None, None) => *p == name,
    })
}

/// Whether a method matches. Reasons for a model also apply to the model with other tables.
fn matches_method(patterns: &[String], method: &str) -> bool {
    let model = method.split_once(", ").map_or(method, |(model, _)| model);
    matches(patterns, method) || matches(patterns, model)
}

/// The reason for a cell; `None` for a cell that holds, and for one without an explanation.
pub fn explanation(cell: &Cell) -> Option<&'static Explanation> {
    if cell.verdict == Verdict::Holds || (cell.level.ships() && cell.fault == Some(Fault::NotFinite)) {
        return None;
    }
    explanations().iter().find(|e| {
        e.levels.contains(&cell.level)
            && matches_method(&e.methods, &cell.method)
            && matches(&e.cases, &cell.case)
            && cell.fault.is_some_and(|fault| e.faults.contains(&fault))
            && cell.error <= e.limit
    })
}
