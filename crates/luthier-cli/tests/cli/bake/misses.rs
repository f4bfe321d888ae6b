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
    let said = |text: &str| words.iter().all(|word| text.contains(word)) && !text.contains("clear.toml:");
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
