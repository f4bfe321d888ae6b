//! An interface whose table misses what a bake aims at is named by every command that meets it.

use serde_json::Value;

use crate::workshop::Workshop;

/// A film that absorbs what would be totally reflected has a kink that no row follows. The index below it is on line 12.
const FRUSTRATED: &str = "schema = 1
name = \"frustrated\"
exterior = 1.5

[[layer]]
type = \"thin-film\"
ior = { n = 1.45, k = 0.02 }
thickness_nm = 200

[[layer]]
type = \"dielectric\"
ior = 1.0
alpha = 0.1

[bake.fgd]
size = [8, 8]
";

#[test]
fn a_row_that_misses_its_aim_is_named_by_check_and_bake_and_breaks_the_report() {
    let workshop = Workshop::new();
    workshop.write("frustrated.toml", FRUSTRATED);
    let clear = FRUSTRATED.replace("k = 0.02", "k = 0").replace("name = \"frustrated\"", "name = \"clear\"");
    workshop.write("clear.toml", clear);
    let words = ["frustrated.toml:12", "the fresnel table of layer 0 is off by up to", "2.0e-3"];
    // The small albedo tables are far off, too, and are named as such. Of the rows one is.
    let said = |text: &str| words.iter().all(|word| text.contains(word)) && text.matches(words[1]).count() == 1;
    let check = workshop.run(&["check", "frustrated.toml", "clear.toml"]).exits(0);
    assert!(said(&check.stderr), "{}", check.stderr);
    let bake = workshop.run(&["bake", "frustrated.toml", "clear.toml", "--out", "out"]).exits(0);
    assert!(said(&bake.stderr), "{}", bake.stderr);
    let json = workshop.run(&["bake", "frustrated.toml", "clear.toml", "--out", "out", "--json", "--quiet"]).exits(0);
    let summary: Value = serde_json::from_str(&json.stdout).unwrap();
    let missed = |d: &Value| d["line"] == 12 && d["message"].as_str().is_some_and(|m| m.contains(words[1]));
    assert!(summary["diagnostics"].as_array().unwrap().iter().any(missed), "{summary}");
    assert_eq!(json.stderr, "");
    let report = ["report", "--out", "out", "--no-device", "--pairs", "64", "--max-error", "1e9"];
    workshop.run(&report).exits(0);
    let report = workshop.run(&[&report[..6], &["--max-error", "2e-3"]].concat()).exits(1);
    assert!(
        report.stdout.contains("fresnel tile frustrated/0, which misses what the bake aimed at"),
        "{}",
        report.stdout
    );
}

/// A film whose row of phases has far too few texels for its fringes. Line 15 has the index of the layer that it is on.
const FRINGES: &str = "schema = 1
name = \"fringes\"

[[layer]]
type = \"thin-film\"
ior = 1.4

[layer.thickness_nm]
min = 100
max = 1500
extent_um = 1000
map = { noise = { seed = 1, frequency = 1, octaves = 1 } }

[[layer]]
type = \"dielectric\"
ior = 1.8
alpha = 0.2

[bake]
model = \"granier-heidrich\"
color = \"three-wavelengths\"
thickness = { size = 16 }
phase = { size = SIZE }
";

/// No aim applies to a table whose size the file states. One that is off by more than a tenth of its largest value is named nevertheless.
#[test]
fn a_table_that_is_off_by_a_tenth_of_its_largest_value_is_named_by_bake_and_report() {
    let workshop = Workshop::new();
    for (size, is_coarse) in [("12", true), ("512", false)] {
        workshop.write("fringes.toml", FRINGES.replace("SIZE", size));
        let bake = workshop.run(&["bake", "fringes.toml", "--out", "out"]).exits(0);
        let words = "the phase table of layer 0 is off by up to";
        assert_eq!(bake.stderr.contains(words), is_coarse, "{}", bake.stderr);
        // The function is 2 cos x: its largest value is 2.
        assert_eq!(
            bake.stderr.contains("more than a tenth of its largest value (2.0e0)"),
            is_coarse,
            "{}",
            bake.stderr
        );
        let tile = workshop.json("out/manifest.json")["tables"]
            .as_array()
            .unwrap()
            .iter()
            .find_map(|table| (table["kind"] == "phase").then(|| table["tiles"][0].clone()));
        let tile = tile.unwrap();
        let (largest, error) = (tile["largest"].as_f64().unwrap(), tile["error"]["max_abs_err"].as_f64().unwrap());
        assert!((1.9..=2.0).contains(&largest) && tile["aim"].is_null(), "{tile}");
        assert_eq!(error > 0.1 * largest, is_coarse, "{tile}");
        workshop.run(&["report", "--out", "out", "--no-device", "--pairs", "64"]).exits(0);
        let findings = workshop.json("out/report/report.json")["findings"].clone();
        let is_found = |f: &Value| f.as_str().is_some_and(|f| f.contains("phase tile fringes/0: off by up to"));
        assert_eq!(findings.as_array().unwrap().iter().any(is_found), is_coarse, "{findings}");
    }
}
