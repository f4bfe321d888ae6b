//! `--help`, and command lines that are wrong.

use crate::workshop::Workshop;

/// The verbs that `--help` lists: in every build, with a device, with a driver's compiler, and with a window.
pub(crate) fn verbs() -> impl Iterator<Item = &'static str> {
    let always = [
        "bake",
        "merge",
        "cache",
        "new",
        "check",
        "report",
        "gallery",
        "audit",
        "shader",
        "models",
        "eval",
        "fit",
        "ior",
        "schema",
        "completions",
        "man",
    ];
    let gpu = ["preview", "compare", "bench"].into_iter().filter(|_| cfg!(feature = "gpu"));
    let others = cfg!(feature = "cost").then_some("cost").into_iter().chain(cfg!(feature = "view").then_some("view"));
    always.into_iter().chain(gpu).chain(others)
}

#[test]
fn the_command_explains_itself() {
    let workshop = Workshop::new();
    let text = workshop.run(&["--help"]).exits(0).stdout;
    for verb in verbs() {
        assert!(text.lines().any(|line| line.trim_start().starts_with(&format!("{verb} "))), "{verb}");
    }
    for code in 0..=4 {
        assert!(text.lines().any(|line| line.starts_with(&format!("  {code}  "))), "exit code {code}");
    }
    assert!(text.contains("Examples:\n  luthier bake materials"), "{text}");
    let version = workshop.run(&["--version"]).exits(0).stdout;
    assert_eq!(version, format!("luthier {}\n", env!("CARGO_PKG_VERSION")));
}

#[test]
fn every_verb_shows_an_example() {
    let workshop = Workshop::new();
    for verb in verbs() {
        for args in [["help", verb], [verb, "--help"]] {
            let text = workshop.run(&args).exits(0).stdout;
            assert!(!text.contains("///"), "{verb}: a comment's slashes");
            let (_, examples) = text.split_once("Examples:\n").unwrap_or_else(|| panic!("{verb} has no example"));
            let commands: Vec<&str> = examples.lines().filter(|line| !line.is_empty()).collect();
            assert!(!commands.is_empty(), "{verb}");
            assert!(commands.iter().all(|line| line.starts_with(&format!("  luthier {verb}"))), "{commands:?}");
        }
    }
}

#[test]
fn wrong_command_lines() {
    let workshop = Workshop::new();
    workshop.run(&["varnish"]).fails(2, &["varnish"]);
    for (verb, feature, is_there) in [
        ("view", "view", cfg!(feature = "view")),
        ("preview", "gpu", cfg!(feature = "gpu")),
        ("cost", "cost", cfg!(feature = "cost")),
    ] {
        if !is_there {
            workshop.run(&[verb]).fails(2, &["leaves"]).says(&[&format!("--features {feature}")]);
        }
    }
    workshop.run(&["bake", "--ouch"]).fails(2, &["--ouch"]);
    workshop.run(&["models", "--samples", "9"]).fails(2, &["--samples"]);
    workshop.run(&["schema", "extra"]).fails(2, &["extra"]);
    let run = workshop.run(&[]).exits(2);
    assert!(run.stderr.contains("Usage: luthier"), "{}", run.stderr);
}
