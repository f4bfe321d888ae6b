//! The command as a whole: help, failures, and what it says to a terminal.

#[cfg(target_os = "linux")]
use luthier_workshop::{Program, has_colours, is_installed, on_terminal};

use crate::workshop::Workshop;

const VERBS: [&str; 10] =
    ["figures", "foreign", "parity", "stability", "judge", "simulation", "budgets", "papers", "shapes", "texels"];

#[test]
fn every_verb_shows_an_example() {
    let workshop = Workshop::new();
    let text = workshop.run(&["--help"]).exits(0).stdout;
    for verb in VERBS {
        assert!(text.lines().any(|line| line.trim_start().starts_with(&format!("{verb} "))), "{verb}");
        let text = workshop.run(&[verb, "--help"]).exits(0).stdout;
        assert!(!text.contains("///"), "{verb}: a comment's slashes");
        let (_, examples) = text.split_once("Examples:\n").unwrap_or_else(|| panic!("{verb} has no example"));
        let commands: Vec<&str> = examples.lines().filter(|line| !line.is_empty()).collect();
        assert!(!commands.is_empty(), "{verb}");
        assert!(commands.iter().all(|line| line.starts_with(&format!("  luthier-lab {verb}"))), "{commands:?}");
    }
}

#[test]
fn failures_are_json_where_json_is_asked_for() {
    let workshop = Workshop::new();
    for verb in ["parity", "stability", "judge"] {
        workshop.run(&[verb, "--json", "--no-such-option"]).told_error(2, "usage");
    }
    workshop.run(&["judge", "none.toml", "--json"]).told_error(3, "files");
    for verb in ["budgets", "papers", "shapes"] {
        workshop.run(&[verb, "none.toml"]).fails(3, &["none.toml"]);
    }
}

/// The bar of work that takes longer than a second.
#[cfg(target_os = "linux")]
#[test]
fn terminals_get_what_they_take() {
    use crate::workshop::Lab;

    if !is_installed("script", "bsdutils") {
        return;
    }
    let workshop = Workshop::with(&[("gold.toml", &luthier_workshop::material_texts::gold("gold"))]);
    let bar = |variables: &[(&str, &str)]| {
        on_terminal(Lab::PATH, "judge gold.toml --samples 20000", &workshop.path(""), variables)
    };
    let said = bar(&[("TERM", "dumb")]);
    assert!(said.contains("gold") && !said.contains('\u{1b}'), "{said:?}");
    assert!(!has_colours(&bar(&[("NO_COLOR", "1")])), "a bar has no colour");
}
