//! `stability`.

use luthier_layers::domain::outside;
use luthier_layers::luthier_model::Quantity;
use luthier_manifest::{Form, ShadingModel};
use luthier_report::stability::{Fault, Level, PITFALLS, Stability, Verdict, cases};
use luthier_workshop::root;

use crate::workshop::Workshop;

/// The whole suite on the adapter.
#[test]
#[ignore = "two minutes: scripts/nightly.sh tests"]
fn nothing_that_ships_is_nan_and_no_cell_is_unexplained() {
    let workshop = Workshop::new();
    let run = workshop.run(&["stability", "--json"]);
    if !run.lacks_adapter() {
        holds(&serde_json::from_str(&run.exits(0).stdout).unwrap());
    }
}

/// The suite as it was last run, see `scripts/nightly.sh`.
#[test]
fn the_measurement_that_is_kept_holds() {
    let kept = std::fs::read_to_string(root().join("docs/measurements/stability.json")).unwrap();
    holds(&serde_json::from_str(&kept).unwrap());
}

/// Nothing that ships is NaN or infinite, nothing is unexplained, every pitfall is covered, and the domains of `bake` and `check` are those
/// that the verdicts give.
fn holds(report: &Stability) {
    for cell in &report.cells {
        assert!(cell.is_explained(), "{cell:?}");
        assert!(!cell.level.ships() || cell.fault != Some(Fault::NotFinite), "{cell:?}");
    }
    for model in ShadingModel::ALL {
        for level in [Level::F32, Level::Device] {
            let count = report.cells.iter().filter(|c| c.level == level && c.method == model.name()).count();
            let has_level = level == Level::Device || model.has(Form::Full);
            assert_eq!(count, if has_level { report.cases.len() } else { 0 }, "{} {}", level.name(), model.name());
        }
    }
    // What settings and budgets choose instead of the default.
    for tables in [
        "rows of rgba8unorm, table of D",
        "rows of rg11b10ufloat, computed phases",
        "rows of rgb10a2unorm",
        "Schlick rows of rgba8unorm",
        "Schlick rows of rgb10a2unorm",
    ] {
        for level in [Level::Table, Level::Device] {
            let method = format!("elek, {tables}");
            let count = report.cells.iter().filter(|c| c.level == level && c.method == method).count();
            assert_eq!(count, report.cases.len(), "{} {method}", level.name());
        }
    }
    for (row, named) in PITFALLS {
        let is_covered = |case: &&str| report.cells.iter().any(|c| c.case == **case);
        let has_formulas = report.formulas.iter().any(|f| f.row == row);
        assert!(named.iter().all(is_covered) && (has_formulas || !named.is_empty()), "{row}");
    }
    // Where the index ends is the one limit that the sweep gives to the digit.
    for model in [ShadingModel::Elek, ShadingModel::WeidlichWilkie] {
        let limit = model.facts().domain.iter().find(|limit| limit.quantity == Quantity::Index).unwrap();
        let derived =
            report.domains.iter().find(|d| d.model == model.name() && d.quantity == Quantity::Index.name()).unwrap();
        assert_eq!(derived.usable, Some([limit.least, limit.most]), "{model}");
    }
    for case in cases().iter().filter(|case| case.swept.is_some()) {
        for model in ShadingModel::ALL {
            let fails = report
                .cells
                .iter()
                .any(|c| c.case == case.id && c.method == model.name() && c.verdict == Verdict::Fails);
            let warned = outside(model, &case.stack);
            assert!(!fails || !warned.is_empty(), "{} fails on {} and is in its domain", model.name(), case.id);
        }
    }
}
