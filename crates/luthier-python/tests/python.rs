//! The tests of the Python module: each file `test_*.py` beside this one, in a Python that has NumPy. `cargo test` builds the module and the command before.

use std::path::Path;
use std::process::Command;

use luthier_workshop::root;

/// Exit code of `scripts/python.sh` where no Python has NumPy.
const NO_NUMPY: i32 = 3;

fn passes(file: &str) {
    let program = std::env::current_exe().unwrap();
    // The programs of this build are in the folder above that of this test.
    let built = program.ancestors().nth(2).map(Path::to_owned).unwrap();
    let mut script = Command::new("bash");
    script.arg(root().join("scripts/python.sh")).arg(file).env("LUTHIER", built.join("luthier"));
    let output = script.output().unwrap();
    let said = String::from_utf8_lossy(&[&output.stdout[..], &output.stderr[..]].concat()).into_owned();
    if output.status.code() == Some(NO_NUMPY) && std::env::var_os("CI").is_none() {
        eprintln!("skipped: {said}");
        return;
    }
    assert!(output.status.success(), "{file}: {said}");
}

#[test]
fn arrays_threads_and_errors() {
    passes("test_arrays");
}

#[test]
fn builds_of_wheels_say_what_is_missing() {
    passes("test_backend");
}

#[test]
fn bakes_tables_audits_and_imports() {
    passes("test_bake");
}

#[test]
fn calls_are_interrupted() {
    passes("test_interrupt");
}

#[test]
fn values_are_those_of_the_command() {
    passes("test_command");
}

#[test]
fn values_are_those_of_closed_forms() {
    passes("test_physics");
}

#[test]
fn stubs_docstrings_and_samples() {
    passes("test_stubs");
}

#[test]
fn all_files_run() {
    let folder = root().join("crates/luthier-python/tests");
    let this = include_str!("python.rs");
    for entry in std::fs::read_dir(folder).unwrap() {
        let name = entry.unwrap().file_name().into_string().unwrap();
        if let Some(file) = name.strip_suffix(".py").filter(|name| name.starts_with("test_")) {
            assert!(this.contains(&format!("passes(\"{file}\")")), "{name} runs nowhere");
        }
    }
}
