//! How failures are told: to programs as JSON, and to terminals without what they do not take.

use luthier_workshop::material_texts::gold;
#[cfg(target_os = "linux")]
use luthier_workshop::{Program, has_colours, is_installed, on_terminal};

use super::help::verbs;
use crate::workshop::Workshop;

/// Verbs that a lean build lacks, and a report on a device, are told as a driver that is not there. `scripts/installed.sh` asks a static program, too.
#[cfg(not(feature = "gpu"))]
#[test]
fn a_lean_build_says_what_it_lacks() {
    let workshop = Workshop::with(&[("gold.toml", &gold("gold"))]);
    workshop.run(&["bake", "gold.toml", "--no-fit", "-q"]).exits(0);
    for verb in ["preview", "compare", "bench", "view"] {
        workshop.run(&[verb, "gold.toml"]).fails(4, &[verb, "needs a graphics driver"]);
    }
    workshop.run(&["report"]).fails(4, &["--no-device"]);
}

#[test]
fn failures_of_every_verb_are_json_where_json_is_asked_for() {
    let workshop =
        Workshop::with(&[("broken.toml", "schema = 1\nname = \"x\"\nnonsense = 3\n"), ("gold.toml", &gold("gold"))]);
    let mut asked = 0;
    for verb in verbs() {
        if workshop.run(&[verb, "--help"]).exits(0).stdout.contains("--json") {
            workshop.run(&[verb, "--json", "--no-such-option"]).told_error(2, "usage");
            asked += 1;
        }
    }
    let least = 7 + 2 * usize::from(cfg!(feature = "gpu")) + usize::from(cfg!(feature = "cost"));
    assert!(asked >= least, "{asked}");

    let input = workshop.run(&["bake", "broken.toml", "--json"]).told_error(1, "input");
    let diagnostics = input["diagnostics"].as_array().unwrap();
    assert!(diagnostics.iter().any(|d| d["file"] == "broken.toml" && d["line"] == 3), "{input}");
    assert!(diagnostics.iter().all(|d| d["message"].is_string()), "{input}");
    for verb in ["bake", "check"] {
        workshop.run(&[verb, "none.toml", "--json"]).told_error(3, "files");
    }
    workshop.run(&["eval", "none.toml", "--model", "elek", "--albedo", "--json"]).told_error(3, "files");
    workshop.run(&["eval", "gold.toml", "--model", "elk", "--albedo", "--json"]).told_error(2, "usage");
    workshop.run(&["ior", "unobtainium", "--json"]).told_error(2, "usage");
    workshop.run(&["report", "--json"]).told_error(3, "files");

    // Without the option there is a sentence, and standard output is empty; behind `--` it is a name.
    workshop.run(&["bake", "none.toml"]).fails(3, &["none.toml"]);
    workshop.run(&["bake", "--", "--json"]).fails(3, &["--json"]);
}

/// Escape sequences on a terminal: colours of diagnostics.
#[cfg(target_os = "linux")]
#[test]
fn terminals_get_what_they_take() {
    use crate::workshop::Luthier;

    if !is_installed("script", "bsdutils") {
        return;
    }
    let workshop =
        Workshop::with(&[("broken.toml", "schema = 1\nname = \"x\"\nnonsense = 3\n"), ("gold.toml", &gold("gold"))]);
    let says =
        |words: &str, variables: &[(&str, &str)]| on_terminal(Luthier::PATH, words, &workshop.path(""), variables);
    for words in ["check broken.toml", "bake broken.toml", "bake --nonsense"] {
        let plain = |variables: &[(&str, &str)]| says(words, variables);
        assert!(has_colours(&plain(&[])), "{words}: a terminal gets colours");
        assert!(has_colours(&plain(&[("NO_COLOR", "")])), "{words}: an empty value counts for none");
        for variables in [[("NO_COLOR", "1")], [("TERM", "dumb")]] {
            let said = plain(&variables);
            assert!(said.contains("error") && !said.contains('\u{1b}'), "{words} {variables:?}: {said:?}");
        }
    }
}
