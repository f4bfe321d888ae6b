//! Pages that count models and state their costs, against the list of models and the measurements.

use std::fs;

use luthier_manifest::ShadingModel;
use luthier_workshop::root;
use serde_json::Value;

fn page(name: &str) -> String {
    fs::read_to_string(root().join("docs").join(name)).unwrap()
}

/// The cells of the row that begins with a cell.
fn row<'p>(page: &'p str, first: &str) -> Vec<&'p str> {
    let line = page.lines().find(|line| line.starts_with(&format!("| {first} |")));
    line.unwrap_or_else(|| panic!("no row {first}")).trim_matches('|').split(" | ").map(str::trim).collect()
}

#[test]
fn the_glossary_and_the_guide_know_every_model() {
    let [count, capital] = match ShadingModel::ALL.len() {
        8 => ["eight", "Eight"],
        9 => ["nine", "Nine"],
        other => panic!("a word for {other}"),
    };
    let glossary = page("glossary.md");
    let entry = row(&glossary, "model")[1];
    assert!(entry.contains(&format!("{capital} models exist as shaders")), "{entry}");
    let guide = page("which-model.md");
    assert!(guide.contains(&format!("luthier has {count}: its own")), "{guide}");
    for model in ShadingModel::ALL {
        assert!(entry.contains(&format!("`{model}`")), "{model}: {entry}");
        row(&guide, &format!("`{model}`"));
    }
}

/// Oracle: the file that `luthier bench` wrote on that device.
#[test]
fn times_of_the_guide_are_those_measured() {
    let measured: Value =
        serde_json::from_str(&fs::read_to_string(root().join("docs/measurements/bench-gpu.json")).unwrap()).unwrap();
    assert_eq!(measured["adapter"]["name"], "NVIDIA H100 80GB HBM3");
    let guide = page("which-model.md");
    let head = row(&guide, "model");
    for (column, material) in [(2, "car-paint"), (3, "red-lacquer")] {
        assert_eq!(head[column], format!("H100: `{material}`, ps"));
        for model in ShadingModel::ALL {
            let rows = measured["rows"].as_array().unwrap();
            // Files of the first schema have one light, and do not say so.
            let is_it = |row: &&Value| {
                let of_one = row.get("lights").is_none_or(|lights| lights == 1);
                row["material"] == material && row["model"] == model.name() && row["form"] == "baked" && of_one
            };
            let picoseconds = 1e3 * rows.iter().find(is_it).unwrap()["net_ns"].as_f64().unwrap();
            assert_eq!(row(&guide, &format!("`{model}`"))[column], format!("{picoseconds:.1}"), "{model}, {material}");
        }
    }
}
