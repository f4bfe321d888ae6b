//! How failures are told: to programs as JSON, and to terminals without what they do not take.

use std::process::Command;

use assert_cmd::cargo::cargo_bin;
use serde_json::Value;

use crate::help::verbs;
use crate::material_texts::gold;
use crate::workshop::{Workshop, is_installed};

/// The error in the one object on standard output; the sentence on standard error contains its message.
#[track_caller]
fn error(workshop: &Workshop, args: &[&str], code: i32, kind: &str) -> Value {
    let run = workshop.run(args).exits(code);
    let object = run.json();
    let error = &object["error"];
    assert_eq!((&error["code"], &error["kind"]), (&Value::from(code), &Value::from(kind)), "{args:?}: {object}");
    assert_eq!(object.as_object().unwrap().len(), 1, "{object}");
    let message = error["message"].as_str().unwrap();
    // Behind the diagnostics, which begin in the same way.
    let sentence = run.errors().last().copied().unwrap_or_default().to_owned();
    assert!(!message.is_empty() && sentence.contains(message), "{args:?}: {message}\n{}", run.stderr);
    error.clone()
}

#[test]
fn failures_of_every_verb_are_json_where_json_is_asked_for() {
    let workshop =
        Workshop::with(&[("broken.toml", "schema = 1\nname = \"x\"\nnonsense = 3\n"), ("gold.toml", &gold("gold"))]);
    let mut asked = 0;
    for verb in verbs() {
        if workshop.run(&[verb, "--help"]).exits(0).stdout.contains("--json") {
            error(&workshop, &[verb, "--json", "--no-such-option"], 2, "usage");
            asked += 1;
        }
    }
    assert!(asked >= 8, "{asked}");

    let input = error(&workshop, &["bake", "broken.toml", "--json"], 1, "input");
    let diagnostics = input["diagnostics"].as_array().unwrap();
    assert!(diagnostics.iter().any(|d| d["file"] == "broken.toml" && d["line"] == 3), "{input}");
    assert!(diagnostics.iter().all(|d| d["message"].is_string()), "{input}");
    for verb in ["bake", "check"] {
        error(&workshop, &[verb, "none.toml", "--json"], 3, "files");
    }
    error(&workshop, &["eval", "none.toml", "--model", "elek", "--albedo", "--json"], 3, "files");
    error(&workshop, &["eval", "gold.toml", "--model", "elk", "--albedo", "--json"], 2, "usage");
    error(&workshop, &["ior", "unobtainium", "--json"], 2, "usage");
    error(&workshop, &["report", "--json"], 3, "files");
    error(&workshop, &["models", "--judge", "none.toml", "--json"], 3, "files");

    // Without the option there is a sentence, and standard output is empty; behind `--` it is a name.
    workshop.run(&["bake", "none.toml"]).fails(3, &["none.toml"]);
    workshop.run(&["bake", "--", "--json"]).fails(3, &["--json"]);
}

/// Escape sequences on a terminal: colours of diagnostics, and the bar of work that takes longer than a second.
#[cfg(target_os = "linux")]
#[test]
fn terminals_get_what_they_take() {
    if !is_installed("script", "bsdutils") {
        return;
    }
    let workshop =
        Workshop::with(&[("broken.toml", "schema = 1\nname = \"x\"\nnonsense = 3\n"), ("gold.toml", &gold("gold"))]);
    let says = |words: &str, variables: &[(&str, &str)]| {
        let command = format!("{} {words}", cargo_bin!("luthier").display());
        let mut script = Command::new("script");
        script
            .args(["-q", "-c", &command, "/dev/null"])
            .current_dir(workshop.path(""))
            .stdin(std::process::Stdio::null());
        script.env_remove("NO_COLOR").env("TERM", "xterm").envs(variables.iter().copied());
        String::from_utf8_lossy(&script.output().unwrap().stdout).into_owned()
    };
    let colours = |text: &str| {
        text.split('\u{1b}')
            .skip(1)
            .any(|rest| rest.split(char::is_alphabetic).next().is_some_and(|p| rest[p.len()..].starts_with('m')))
    };
    for words in ["check broken.toml", "bake broken.toml", "bake --nonsense"] {
        let plain = |variables: &[(&str, &str)]| says(words, variables);
        assert!(colours(&plain(&[])), "{words}: a terminal gets colours");
        assert!(colours(&plain(&[("NO_COLOR", "")])), "{words}: an empty value counts for none");
        for variables in [[("NO_COLOR", "1")], [("TERM", "dumb")]] {
            let said = plain(&variables);
            assert!(said.contains("error") && !said.contains('\u{1b}'), "{words} {variables:?}: {said:?}");
        }
    }
    let bar = |variables: &[(&str, &str)]| says("models --judge gold.toml --samples 20000", variables);
    let said = bar(&[("TERM", "dumb")]);
    assert!(said.contains("gold") && !said.contains('\u{1b}'), "{said:?}");
    assert!(!colours(&bar(&[("NO_COLOR", "1")])), "a bar has no colour");
}
