//! Budgets against what was found.

use luthier_manifest::Budget;
use luthier_report::{Asked, FileBudget, SeenLight, Settings, judge, limits};

use crate::fixture::Bake;

/// Every limit is held a little above what was found, broken a little below, and the report's verdict follows.
#[test]
fn a_limit_is_held_up_to_what_was_found() {
    let bake = Bake::new();
    let mut report = judge(&bake.subject(), None, &Settings { pairs_per_set: 200, ..Settings::default() }).unwrap();
    crate::page::filled(&mut report);
    let bytes = report.tables.iter().map(|t| t.texel_bytes).sum::<u64>();
    let (table, ..) = report.worst_table().unwrap();
    // Neither the points of the baker nor those of the judge are passed over.
    assert!(report.tables.iter().flat_map(|t| &t.tiles).all(|tile| tile.baker.max_abs_err <= table));
    let (seen, _) = report.worst_seen(SeenLight::Daylight).unwrap();
    let lobe = report.worst_model().unwrap().1.lobe_err;
    assert!(table > 0.0 && seen > 0.0 && lobe > 0.0);
    for (factor, holds) in [(1.001, true), (0.999, false)] {
        let asked = Asked {
            max_abs: Some(factor * table),
            delta_e: Some(factor * seen),
            flip: Some(factor * 0.05),
            max_bytes: Some((factor * bytes as f64) as u64),
            lobe: Some(factor * lobe),
        };
        report.limits = limits(&report, &[], &asked);
        assert_eq!(report.limits.len(), 5);
        for limit in &report.limits {
            assert_eq!(limit.is_held, holds, "{limit:?}");
        }
        assert_eq!(report.is_within_budget(), Some(holds));
    }
    report.limits.clear();
    assert_eq!(report.is_within_budget(), None);
}

/// A tile that misses the aim of the bake counts against the limit on the shaders' error, though directions may pass it by.
#[test]
fn a_tile_that_misses_its_aim_breaks_the_limit() {
    let mut bake = Bake::new();
    let settings = Settings { pairs_per_set: 200, budget: Some(10.0), ..Settings::default() };
    let mut report = judge(&bake.subject(), None, &settings).unwrap();
    report.limits = limits(&report, &[], &Asked::default());
    assert_eq!((report.is_within_budget(), report.limits.len()), (Some(true), 0));
    let settings = Settings { budget: Some(0.4), ..settings };
    // The fixture's baker states a difference of 1/2 for every tile.
    bake.manifest.tables[0].tiles[0].aim = Some(2e-3);
    let mut report = judge(&bake.subject(), None, &settings).unwrap();
    report.limits = limits(&report, &[], &Asked::default());
    let limit = &report.limits[0];
    assert!(!limit.is_held && limit.found == Some(0.5) && limit.limit == 0.4, "{limit:?}");
    let name = &report.tables[0].tiles[0].name;
    assert!(limit.quantity.contains(name) && report.findings.iter().any(|f| f.contains(name)), "{:?}", report.findings);
    bake.manifest.tables[0].tiles[0].aim = Some(0.6);
    let mut report = judge(&bake.subject(), None, &settings).unwrap();
    report.limits = limits(&report, &[], &Asked::default());
    assert!(report.limits.is_empty());
}

/// The budget of a file is held against the tables that its material reads, and no others.
#[test]
fn files_answer_for_their_own_tables() {
    let bake = Bake::new();
    let mut report = judge(&bake.subject(), None, &Settings { pairs_per_set: 200, ..Settings::default() }).unwrap();
    let of = |name: &str| report.materials.iter().position(|m| m.name == name).unwrap();
    let (plaster, lacquer) = (of("plaster"), of("red-lacquer"));
    let budget = |material, max_abs| FileBudget { material, budget: Budget { max_abs, ..Budget::default() } };
    let budgets = [budget(plaster, Some(1e-12)), budget(lacquer, Some(1e-12)), budget(lacquer, None)];
    report.limits = limits(&report, &budgets, &Asked::default());
    let held: Vec<bool> = report.limits.iter().map(|l| l.is_held).collect();
    assert_eq!(held, [true, false], "plaster reads no table");
    assert!(report.limits.iter().all(|l| l.stated_by.starts_with("materials/")));
}

/// A quantity that was not measured cannot be within a limit.
#[test]
fn nothing_to_compare_holds_no_limit() {
    let bake = Bake::new();
    let mut report = judge(&bake.subject(), None, &Settings { pairs_per_set: 50, ..Settings::default() }).unwrap();
    let asked = Asked { flip: Some(1.0), lobe: Some(10.0), ..Asked::default() };
    report.limits = limits(&report, &[], &asked);
    assert_eq!(report.limits.len(), 2);
    assert!(report.limits.iter().all(|l| !l.is_held && l.found.is_none()));
    assert_eq!(report.is_within_budget(), Some(false));
    assert!(report.to_markdown().contains("**broken**"));
}
