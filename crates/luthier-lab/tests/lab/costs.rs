//! `papers` and `shapes`: what a driver's compiler says; `throughput`: what a clock says.

use luthier_workshop::material_texts::{gold, lacquer};

use crate::workshop::Workshop;

#[test]
fn the_page_has_the_papers_figures_beside_ours() {
    let workshop = Workshop::with(&[("lacquer.toml", &lacquer("lacquer"))]);
    let run = workshop.run(&["papers", "lacquer.toml", "--family", "gcn5", "-o", "page.md"]);
    if run.lacks_driver() {
        return;
    }
    assert_eq!(run.exits(0).stdout, "");
    let page = workshop.text("page.md");
    for part in [
        "Made by `luthier-lab papers lacquer.toml --family gcn5 -o page.md`, luthier ",
        "| 436 | – | 236 | 104 | 0.54 | 2.27 | 6 % |",
        "| precomputed F and D |",
        "Goal: ",
    ] {
        assert!(page.contains(part), "no `{part}` in\n{page}");
    }
}

#[test]
fn papers_are_about_two_layers() {
    let workshop = Workshop::with(&[("gold.toml", &gold("gold"))]);
    workshop.run(&["papers", "gold.toml"]).fails(1, &["two layers"]);
}

/// Both forms of every model, for the material as it is and without its coat.
#[test]
fn shapes_are_counted_by_model_and_form() {
    let workshop = Workshop::with(&[("lacquer.toml", &lacquer("lacquer"))]);
    let run = workshop.run(&["shapes", "lacquer.toml"]);
    if run.lacks_driver() {
        return;
    }
    let table: luthier_scene::ShapeTable = serde_json::from_str(&run.exits(0).stdout).unwrap();
    assert_eq!(table.families, luthier_cost::Family::ALL);
    assert_eq!(table.counts, luthier_cost::StaticCounts::NAMES);
    assert!(table.driver.contains("Mesa"), "{}", table.driver);
    for model in luthier_manifest::ShadingModel::ALL {
        for form in luthier_manifest::Form::ALL.into_iter().filter(|&form| model.has(form)) {
            assert!(table.rows.iter().any(|row| (row.model, row.form) == (model, form)), "{model}, {form}");
        }
    }
    assert!(table.rows.iter().all(|row| row.cycles.len() == 3 && row.cycles.iter().all(|n| *n > 0)), "{table:?}");
    assert!(table.rows.iter().all(|row| row.counts.iter().any(|n| *n > 0)), "{table:?}");
}

/// A measurement of rows whose materials are at hand gives a file for each device, and a page that names each.
#[test]
fn devices_are_fitted_to_kept_measurements() {
    let workshop = Workshop::with(&[("lacquer.toml", &lacquer("red-lacquer"))]);
    std::fs::create_dir(workshop.path("data")).unwrap();
    let measurements = luthier_workshop::root().join("docs/measurements");
    let run = workshop.run(&[
        "devices",
        "lacquer.toml",
        "--measurements",
        measurements.to_str().unwrap(),
        "--folder",
        "data",
        "-o",
        "page.md",
    ]);
    run.exits(0);
    let page = workshop.text("page.md");
    for name in luthier_cost::DeviceCost::names() {
        let costs = luthier_cost::DeviceCost::parse(&workshop.text(&format!("data/{name}.json"))).unwrap();
        assert_eq!(costs.name, name);
        // Of one material; shaders of `lobes` have a read less than when they were timed, so that counts of today fit these times less well.
        assert!(costs.fit.rows > 8 && costs.fit.own.median < 0.25, "{costs:?}");
        assert!(page.contains(&format!("| {name} | {} |", costs.unit)), "{page}");
    }
    assert!(page.contains("## Shaders timed on h100") && page.contains("cycles of RDNA2 by RADV's compiler"), "{page}");
}

/// Both layouts, the coats of engines and a bound, on three chips and on timed devices, for one light and for several. No layout is cheaper than no reads, more lights on a view make each of them cheaper,
/// and the yardstick is 1 beside itself.
#[test]
fn layouts_stand_between_no_reads_and_more_bytes() {
    let workshop = Workshop::with(&[("lacquer.toml", &lacquer("lacquer"))]);
    let run = workshop.run(&["layouts", "lacquer.toml"]);
    if run.lacks_driver() {
        return;
    }
    let page = run.exits(0).stdout;
    let titles: Vec<&str> = page.lines().filter_map(|line| line.strip_prefix("## ")).collect();
    assert_eq!(titles.len(), 5, "{titles:?}");
    for section in page.split("\n## ").skip(1) {
        let row = |name: &str| -> Vec<f64> {
            let line = section.lines().find(|line| line.starts_with(&format!("| {name} |")));
            let cells = line.unwrap_or_else(|| panic!("no {name} in {section}")).split('|').skip(2);
            cells.filter_map(|cell| cell.split_whitespace().next()?.parse().ok()).collect()
        };
        let [coat, filtered, steps, unread] =
            ["gltf-clearcoat", "lobes, filtered", "lobes, steps", "lobes without reads"].map(row);
        for costs in [&coat, &filtered, &steps, &unread] {
            assert!(costs.len() == 3 && costs.windows(2).all(|pair| pair[1] <= pair[0]) && costs[2] > 0.0, "{section}");
        }
        for (i, unread) in unread.iter().enumerate() {
            assert!(*unread <= filtered[i] && *unread <= steps[i], "{section}");
        }
        assert!(section.contains(" (1.00) |"), "{section}");
    }
}

/// Ten shaders of a material of two layers, each with its time; ratios of the page are those of the numbers.
#[test]
fn shaders_of_the_papers_are_timed() {
    let workshop = Workshop::with(&[("lacquer.toml", &lacquer("lacquer")), ("gold.toml", &gold("gold"))]);
    let small = ["--evaluations", "65536", "--repeats", "5", "--data", "data.json"];
    let run = workshop.run(&[&["throughput", "lacquer.toml"][..], &small].concat());
    if run.lacks_adapter() {
        return;
    }
    let page = run.exits(0).stdout;
    let data: serde_json::Value = serde_json::from_str(&workshop.text("data.json")).unwrap();
    let rows = data["rows"].as_array().unwrap();
    assert_eq!(rows.len(), 10, "{data}");
    let net = |row: &serde_json::Value| row["net_ns"].as_f64().unwrap();
    for row in rows {
        assert!(row["median_ns"].as_f64().unwrap() > 0.0 && row["harness_ns"].as_f64().unwrap() > 0.0, "{row}");
        let full = rows.iter().find(|r| r["shader"] == "full" && r["constant"] == row["constant"]).unwrap();
        let numbers = if row["constant"] == true { ", constants" } else { "" };
        let line = format!("| {}{numbers} | ", row["shader"].as_str().unwrap());
        let of_full = format!(" | {:.2} | ", net(full) / net(row));
        assert!(page.lines().any(|l| l.starts_with(&line) && l.contains(&of_full)), "no {line}{of_full} in {page}");
    }
    assert!(page.contains("| 348 | – | 757 | 1648 | 2.18 | 4.74 |"), "{page}");
    workshop.run(&["throughput", "gold.toml"]).fails(1, &["two layers"]);
}

/// A set of two stacks and a bare metal, by the models of the files and in `lobes`: a material costs little more beside others, where its tables may have another format, and all in turn more than one.
#[test]
fn materials_pay_for_each_other() {
    let layer = |text: &str| format!("\n[[layer]]\n{text}\n");
    let metal = layer("type = \"conductor\"\nior = { n = 0.2, k = 3.0 }\nalpha = 0.2");
    let coat = layer("type = \"dielectric\"\nior = 1.5\nalpha = 0.1") + &layer("type = \"diffuse\"\nalbedo = 0.5");
    let text = |name: &str, layers: &str| format!("schema = 1\nname = \"{name}\"\n{layers}");
    let files = [
        ("lacquer.toml", lacquer("lacquer")),
        ("coat.toml", text("coat", &coat)),
        ("metal.toml", text("metal", &metal)),
    ];
    let workshop = Workshop::with(&files.each_ref().map(|(name, text)| (*name, text.as_str())));
    let page = workshop.run(&["sets", "lacquer.toml", "coat.toml", "metal.toml"]).exits(0).stdout;
    let numbers = |line: &str| -> Vec<f64> {
        let cells = line.split(['|', ',']).skip(2);
        cells.filter_map(|cell| cell.trim().parse().ok()).collect()
    };
    for title in ["The models that the files ask for", "All in `lobes`", "All in `lobes`, within 0.1"] {
        let rows: Vec<&str> = page.lines().filter(|line| line.starts_with(&format!("| {title} |"))).collect();
        assert_eq!(rows.len(), 2, "{page}");
        let [materials, alone, in_set, median, largest, whole, ratio] = numbers(rows[0])[..] else {
            panic!("{rows:?}")
        };
        assert_eq!(materials, 3.0);
        assert!(alone < 1.1 * in_set && 0.9 < median && median <= largest && largest < 2.0, "{rows:?}");
        assert!(whole >= in_set && (ratio - whole / alone).abs() < 0.05, "{rows:?}");
    }
    let of_materials: Vec<&str> = page.lines().filter(|line| line.starts_with("| coat | lobes |")).collect();
    assert_eq!(of_materials.len(), 3, "{page}");
    // The coat has as many reads in either place: those of the lobes of others are not made.
    let [.., reads, reads_in_set, _, _, _, _, _, _] = numbers(of_materials[1])[..] else { panic!("{of_materials:?}") };
    assert_eq!(reads, reads_in_set, "{of_materials:?}");
}
