//! `bench`.

use luthier_workshop::material_texts::lacquer;
use serde_json::Value;

use crate::workshop::Workshop;

/// Enough to see every row, and no more.
const FEW: [&str; 7] = ["--evaluations", "2000", "--repeats", "3", "--warm-up", "1", "--json"];

/// The result of a bench; `None` without an adapter.
fn bench(workshop: &Workshop, words: &[&str]) -> Option<Value> {
    let run = workshop.run(&[&["bench"], words, FEW.as_slice()].concat());
    (!run.lacks_adapter()).then(|| run.exits(0).json())
}

fn number(row: &Value, name: &str) -> f64 {
    row[name].as_f64().unwrap_or_else(|| panic!("{name} in {row:#}"))
}

/// Times above zero, and a net time that is the rest over the harness.
fn is_timed(row: &Value) {
    assert!(
        number(row, "median_ns") > 0.0 && number(row, "harness_ns") > 0.0 && number(row, "mad_ns") >= 0.0,
        "{row:#}"
    );
    assert!((number(row, "net_ns") - (number(row, "median_ns") - number(row, "harness_ns"))).abs() < 1e-9, "{row:#}");
}

#[test]
fn every_shader_is_timed_against_phong_the_full_form_and_a_coat_of_engines() {
    let workshop = Workshop::with(&[("lacquer.toml", &lacquer("lacquer"))]);
    let Some(report) = bench(&workshop, &["lacquer.toml", "--model", "elek"]) else { return };
    assert_eq!(report["schema"], 2);
    for name in ["name", "driver", "backend"] {
        assert!(report["adapter"][name].is_string(), "{report:#}");
    }
    assert!(report["adapter"]["software"].is_boolean());
    assert!(report["clock"] == "device" || report["clock"] == "host");
    // Whole workgroups of 64 threads with 16 evaluations each.
    assert_eq!((&report["evaluations"], &report["repeats"]), (&2048.into(), &3.into()));
    assert!(report["per_pixel"].is_null());
    let rows = report["rows"].as_array().unwrap();
    let name = |row: &Value| {
        let shader = row["model"].as_str().or(row["yardstick"].as_str()).unwrap().to_owned();
        format!("{shader} {} {} {}", row["form"], row["closed"], row["lights"]).replace('"', "")
    };
    let shaders = [
        "phong full true",
        "phong baked true",
        "gltf full true",
        "gltf-clearcoat full true",
        "filament-clearcoat full true",
        "elek full true",
        "elek baked false",
        "elek baked true",
    ];
    let expected: Vec<String> =
        [1, 4, 16].iter().flat_map(|lights| shaders.iter().map(move |shader| format!("{shader} {lights}"))).collect();
    assert_eq!(rows.iter().map(name).collect::<Vec<_>>(), expected);
    for row in rows {
        is_timed(row);
        assert!(number(row, "p10_ns") <= number(row, "median_ns"), "{row:#}");
        assert!(number(row, "median_ns") <= number(row, "p90_ns"), "{row:#}");
    }
    // Ratios are among rows of as many lights.
    for rows in rows.chunks(shaders.len()) {
        let ones = [(0, "of_phong"), (0, "of_full"), (3, "of_gltf_clearcoat"), (5, "of_full")];
        for (i, name) in ones {
            assert_eq!(number(&rows[i], name), 1.0, "{:#}", rows[i]);
        }
        let over = number(&rows[6], "net_ns") / number(&rows[3], "net_ns");
        assert!((number(&rows[6], "of_gltf_clearcoat") - over).abs() <= 1e-9 * over.abs(), "{:#}", rows[6]);
    }
}

#[test]
fn sets_are_timed_with_a_material_for_each_thread() {
    let files = ["one", "two", "three"].map(|name| (format!("{name}.toml"), lacquer(name)));
    let files: Vec<(&str, &str)> = files.iter().map(|(file, text)| (file.as_str(), text.as_str())).collect();
    let workshop = Workshop::with(&files);
    let words = ["one.toml", "two.toml", "three.toml", "--model", "elek", "--lights", "1,4", "--per-pixel", "1,3"];
    let Some(report) = bench(&workshop, &words) else { return };
    assert_eq!(report["rows"].as_array().unwrap().len(), 0);
    let rows = report["per_pixel"].as_array().unwrap();
    let name = |row: &Value| format!("{} {} {}", row["materials"], row["run"], row["lights"]);
    let expected: Vec<String> = ["1", "3"]
        .iter()
        .flat_map(|size| ["null", "64", "8", "1"].map(|run| [1, 4].map(|lights| format!("{size} {run} {lights}"))))
        .flatten()
        .collect();
    assert_eq!(rows.iter().map(name).collect::<Vec<_>>(), expected);
    for row in rows {
        is_timed(row);
        assert_eq!((&row["model"], &row["models"], &row["form"]), (&"elek".into(), &1.into(), &"baked".into()));
        let over = number(row, "net_ns") / number(row, "alone_ns");
        assert!((number(row, "of_alone") - over).abs() <= 1e-9 * over.abs(), "{row:#}");
    }
}

#[test]
fn bad_options_are_refused() {
    let workshop = Workshop::with(&[("lacquer.toml", &lacquer("lacquer"))]);
    let run = |words: &[&str]| workshop.run(&[&["bench", "lacquer.toml"], words].concat());
    for lights in ["3", "32", "0", "many", "1,5"] {
        run(&["--lights", lights]).fails(2, &["a number of lights is 1, 2, 4, 8 or 16"]);
    }
    run(&["--per-pixel", "0"]).fails(2, &["--per-pixel"]);
    run(&["--per-pixel", "2"]).fails(2, &["`--per-pixel 2` wants 2 materials, and the files have 1"]);
}

/// Costs of the adapter at hand are printed and written, and other verbs read them.
#[test]
fn costs_of_operations_are_fitted_to_the_times() {
    let workshop = Workshop::with(&[("lacquer.toml", &lacquer("lacquer"))]);
    let args = ["bench", "lacquer.toml", "--no-fit", "--evaluations", "65536", "--repeats", "3", "--fit"];
    let run = workshop.run(&[&args[..], &["here.json"]].concat());
    if run.lacks_adapter() {
        return;
    }
    let said = run.exits(0).stdout;
    for part in ["filtered_reads", "special", "of the shorter of reads", "error on the ", "of counts alone"] {
        assert!(said.contains(part), "no `{part}` in\n{said}");
    }
    let costs = luthier_cost::DeviceCost::parse(&workshop.text("here.json")).unwrap();
    assert_eq!((costs.name.as_str(), costs.unit), ("here", luthier_cost::CostUnit::Picoseconds));
    assert!(!costs.device.is_empty() && !costs.driver.is_empty() && costs.fit.rows > 8, "{costs:?}");
    workshop.run(&["bench", "lacquer.toml", "--json", "--fit"]).exits(2).says(&["name it"]);
    // What the fit says of a shader is what `cost` says of it.
    let args = ["cost", "lacquer.toml", "--model", "elek", "--form", "full", "--costs", "here.json"];
    let report = workshop.run(&[&args[..], &["--json"]].concat()).exits(0).json();
    let rows = report["rows"].as_array().unwrap();
    assert_eq!((rows.len(), &report["device"]["name"]), (2, &"here".into()));
    for row in rows {
        let counts = luthier_cost::StaticCounts::NAMES.map(|name| row["counts"][name].as_u64().unwrap() as u32);
        let cost = costs.cost(&luthier_cost::StaticCounts::of_values(counts));
        assert!((row["cost"].as_f64().unwrap() - cost).abs() <= 1e-9 * cost, "{row:#}");
        assert_eq!(counts[0], 0, "the form `full` reads no texture: {row:#}");
    }
    let page = workshop.run(&args).exits(0).stdout;
    assert!(page.contains("# What the shaders cost on here") && page.contains("predicted from counts"), "{page}");
}
