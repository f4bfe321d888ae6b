//! The stability suite without a device: its cases, formulations, explanations and drawings.

use luthier_report::stability::{
    Cell, Fault, Level, PITFALLS, Stability, Verdict, cases, explain, formulas, heat_map_svg, model_cells,
};

/// The pitfalls, by name.
const ROWS: [&str; 24] = [
    "D in f16",
    "D table, alpha axis linear, 512",
    "reading u^8 as (N.H)^8",
    "D table, m axis linear",
    "D with mip maps",
    "8-bit Fresnel row",
    "Fresnel row linear in theta",
    "Fresnel from inside",
    "Schlick with complex F0",
    "f32 GGX from cos",
    "f32 conductor Fresnel",
    "f16 alpha^2",
    "half vector, L = -V",
    "grazing",
    "rough coat over smooth base",
    "Weidlich-Wilkie energy",
    "Weidlich-Wilkie bounces",
    "single-scatter microfacets",
    "q -> 0",
    "film with total reflection",
    "film d -> 0",
    "Belcour/Yamaguchi at high alpha with high index, at grazing angles",
    "gold F0 red",
    "hardware bilinear filtering",
];

#[test]
fn every_pitfall_has_cases_or_formulations() {
    assert_eq!(PITFALLS.map(|(row, _)| row), ROWS);
    let ids: Vec<String> = cases().into_iter().map(|case| case.id).collect();
    let formulas = formulas();
    for (row, named) in PITFALLS {
        let measured = formulas.iter().filter(|f| f.row == row).count();
        assert!(measured > 0 || !named.is_empty(), "{row}");
        for id in named {
            assert!(ids.iter().any(|known| known == id), "{row}: no case {id}");
        }
    }
    let mut unique = ids.clone();
    unique.sort();
    unique.dedup();
    assert_eq!(unique.len(), ids.len());
}

/// Formulations that ship are within their tolerance; those that were rejected are worse than that, or say what else is against them.
#[test]
fn formulations_that_ship_hold_and_those_rejected_say_why() {
    let formulas = formulas();
    for f in &formulas {
        assert!(f.is_as_expected(), "{}: {}: {:?} of {}", f.row, f.formulation, f.error, f.tolerance);
        assert!(!f.ships || f.holds(), "{f:?}");
    }
    // Rows whose first formulation fails where the second holds.
    for row in
        ["D in f16", "D with mip maps", "f32 GGX from cos", "f16 alpha^2", "film with total reflection", "q -> 0"]
    {
        let of_row = || formulas.iter().filter(|f| f.row == row);
        assert!(of_row().any(|f| !f.ships && !f.holds()), "{row}: nothing fails");
    }
}

/// Oracles: 1.0 - ln 2 of a mirror of alpha 1; 2.5% of D at m = 0.01 of a linear axis (both of the physics reference).
#[test]
fn formulations_have_the_errors_of_the_reference() {
    let formulas = formulas();
    let error = |row: &str, formulation: &str, measure: &str| {
        let is = |f: &&luthier_report::stability::FormulaResult| {
            f.row == row && f.formulation == formulation && f.measure.contains(measure)
        };
        formulas.iter().find(is).and_then(|f| f.error).unwrap_or_else(|| panic!("{row}: {formulation}"))
    };
    assert!((error("single-scatter microfacets", "one bounce", "") - std::f64::consts::LN_2).abs() < 1e-4);
    assert!((error("D table, alpha axis linear, 512", "angle linear", "0.02") - 0.0058).abs() < 4e-4);
    assert!((error("D table, m axis linear", "D over m, linear, 512 rows", "0.005") - 0.13).abs() < 0.02);
    assert!((error("reading u^8 as (N.H)^8", "cosine = u^(1/8)", "0.02") - 0.106).abs() < 0.02);
    assert!((error("8-bit Fresnel row", "unorm8", "1.33") - 0.098).abs() < 1e-3);
    assert!((error("Schlick with complex F0", "Schlick with complex F0", "chromium") - 0.215).abs() < 2e-3);
}

fn cell(level: Level, fault: Option<Fault>, error: f64) -> Cell {
    let verdict = if fault.is_some() { Verdict::Fails } else { Verdict::Holds };
    Cell { level, method: "elek".into(), case: "furnace-2".into(), verdict, fault, error, explanation: None }
}

/// A reason is for a level, methods, cases and faults, and ends at its limit. Nothing explains NaN in what ships.
#[test]
fn explanations_have_limits() {
    let explained = |cell: &Cell| explain::explanation(cell).map(|e| e.name.as_str());
    assert_eq!(explained(&cell(Level::F64, Some(Fault::Wrong), 0.9)), Some("NO_INVERSE_SQUARE"));
    assert_eq!(explained(&cell(Level::F64, Some(Fault::Wrong), 9.0)), None);
    assert_eq!(explained(&cell(Level::F64, Some(Fault::Negative), 0.1)), None);
    for level in [Level::Table, Level::F32, Level::Device] {
        assert_eq!(explained(&cell(level, Some(Fault::NotFinite), 0.0)), None);
    }
    let planted = |cell: Cell| Stability::new("test", None, vec![cell]);
    assert!(planted(cell(Level::Device, None, 0.0)).holds());
    let broken = planted(cell(Level::Device, Some(Fault::NotFinite), 0.0));
    assert!(!broken.holds() && broken.not_finite().count() == 1 && broken.unexplained().count() == 1);
}

/// Single bounces in the furnace, and laws on directions, over all models: a part of the suite that takes seconds.
#[test]
fn models_are_judged_by_laws_and_by_the_truth() {
    let wanted = ["furnace-1", "soap", "opposite-coated", "retro-metal"];
    let cases: Vec<_> = cases().into_iter().filter(|case| wanted.contains(&case.id.as_str())).collect();
    let cells = model_cells(&cases, &|| {});
    let of = |method: &str, case: &str| cells.iter().find(|c| c.method == method && c.case == case);
    // Seen at 30 and 70 degrees a GGX mirror of alpha 1 lacks more than ln 2 at most; the walk lacks nothing.
    let single = of("microfacet", "furnace-1").unwrap();
    assert!(single.verdict == Verdict::Degrades && (0.6..0.7).contains(&single.error), "{single:?}");
    assert_eq!(of("random-walk", "furnace-1").map(|c| c.verdict), Some(Verdict::Holds));
    for cell in &cells {
        assert_ne!(cell.fault, Some(Fault::NotFinite), "{cell:?}");
        assert!(cell.is_explained(), "{cell:?}");
    }
    assert!(of("microfacet", "soap").is_none(), "it is not blamed for what lies below one interface");
}

#[test]
fn the_heat_map_is_xml_with_a_tooltip_for_every_cell() {
    let cells = vec![
        cell(Level::F64, Some(Fault::Wrong), 0.9),
        cell(Level::Device, None, 0.0),
        cell(Level::Device, Some(Fault::NotFinite), 0.0),
    ];
    let stability = Stability::new("test", Some("an <adapter>".to_owned()), cells);
    let svg = heat_map_svg(&stability);
    let document = roxmltree::Document::parse(&svg).unwrap();
    let titles: Vec<&str> =
        document.descendants().filter_map(|n| n.has_tag_name("title").then(|| n.text()).flatten()).collect();
    assert!(titles.contains(&"f64, elek, furnace-2: fails, wrong 0.900"), "{titles:?}");
    assert!(svg.contains("fill=\"currentColor\"") && svg.contains("var(--stability-holds"));
    let page = stability.to_markdown("luthier-lab stability");
    assert!(page.contains("\n    luthier-lab stability\n") && page.contains("an <adapter>"), "{page}");
    for heading in ["## Summary", "## Domains", "## f64", "## device", "## Explanations", "## Cases"] {
        assert!(page.contains(heading), "{heading}");
    }
}
