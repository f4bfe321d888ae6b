//! `scripts/test.sh`, with programs in place of its own that pass or fail as they are told: what fails does not hide what comes after.

use std::fs;
use std::os::unix::fs::PermissionsExt;
use std::path::Path;
use std::process::Command;

use luthier_workshop::root;

use crate::workshop::Workshop;

/// A program that writes its name and words into a list, says something, and fails if `FAILS` has its name.
const PROGRAM: &str = r#"#!/usr/bin/env bash
name=$(basename "$0") words=" $* "
[ "$name" != cargo ] || name="cargo $1"
case $words in *" --no-run "*) name=build ;; esac
echo "$name" >>"$LIST"
case " $FAILS " in *" ${name// /-} "*) ;; *) exit 0 ;; esac
[ "$name" = "cargo test" ] || exit 3
# Cargo tells of the second program only where the first one that fails does not end it.
echo "test one::breaks ... FAILED"
case $words in *" --no-fail-fast "*) printf 'test two::breaks ... FAILED\nerror: 2 targets failed:\n    `-p a --test one`\n    `-p b --test two`\n' ;; esac
exit 101
"#;

/// Everything that the script runs, in its order.
const ALL: [&str; 13] = [
    "wants.sh",
    "cargo tree",
    "nightly.sh",
    "build",
    "cargo test",
    "golden.sh",
    "all.sh",
    "pages.sh",
    "wants.sh",
    "luthier",
    "wants.sh",
    "luthier",
    "c-host.sh",
];

fn put(path: &Path, text: &str) {
    fs::create_dir_all(path.parent().unwrap()).unwrap();
    fs::write(path, text).unwrap();
    fs::set_permissions(path, fs::Permissions::from_mode(0o755)).unwrap();
}

/// Runs the script where some programs fail: its exit code, what ran, and its last words.
fn suite(fails: &str) -> (i32, Vec<String>, Vec<String>) {
    let workshop = Workshop::new();
    for script in ["test.sh", "steps.sh"] {
        put(&workshop.path("scripts").join(script), &fs::read_to_string(root().join("scripts").join(script)).unwrap());
    }
    let programs = [
        "scripts/wants.sh",
        "scripts/nightly.sh",
        "scripts/golden.sh",
        "scripts/pages.sh",
        "scripts/c-host.sh",
        "tests/crash/all.sh",
    ];
    for program in programs.into_iter().chain(["bin/cargo", "target/debug/luthier"]) {
        put(&workshop.path(program), PROGRAM);
    }
    workshop.write("docs/pages/page.md", "");
    workshop.write("docs/reference.md", "");
    let path = format!("{}:{}", workshop.path("bin").display(), std::env::var("PATH").unwrap());
    let output = Command::new("bash")
        .arg(workshop.path("scripts/test.sh"))
        .envs([("PATH", path.as_str()), ("FAILS", fails), ("LIST", workshop.path("list").to_str().unwrap())])
        .output()
        .unwrap();
    let lines = |text: &str| text.lines().map(str::to_owned).collect::<Vec<_>>();
    let stdout = String::from_utf8(output.stdout).unwrap();
    let (_, summary) = stdout.rsplit_once("== summary\n").unwrap_or_default();
    (output.status.code().unwrap(), lines(&workshop.text("list")), lines(summary))
}

#[test]
fn everything_passes() {
    let (code, ran, summary) = suite("");
    assert_eq!((code, ran), (0, ALL.map(str::to_owned).to_vec()));
    assert_eq!(summary, ["all steps passed"]);
}

/// Tests of two programs, the comparison of bytes, and the last step.
#[test]
fn what_fails_stops_nothing_else_and_is_told_at_the_end() {
    let (code, ran, summary) = suite("cargo-test golden.sh luthier");
    assert_eq!((code, ran), (1, ALL.map(str::to_owned).to_vec()));
    let expected = [
        "failed with 1: unit and integration tests",
        "        `-p a --test one`",
        "        `-p b --test two`",
        "    test one::breaks ... FAILED",
        "    test two::breaks ... FAILED",
        "failed with 3: same bytes as in tests/golden",
        "failed with 3: judging the bake of materials",
        "failed with 3: judging the bake of materials/papers",
    ];
    assert_eq!(summary, expected);
}

#[test]
fn steps_without_what_they_need_do_not_run() {
    let (code, ran, summary) = suite("build nightly.sh");
    assert_eq!((code, ran), (1, ALL[..4].iter().map(|name| (*name).to_owned()).collect()));
    assert_eq!(summary[..2], ["failed with 3: nightly steps", "failed with 3: build"]);
    assert_eq!(summary.len(), 9);
    assert!(summary[2..].iter().all(|line| line.starts_with("not run: ") && line.ends_with(", because of: build")));
}
