//! The editor's loop of the examples, run as a program.

use std::path::{Path, PathBuf};
use std::process::Command;

/// The example beside this test, which Cargo builds with it.
fn editor() -> PathBuf {
    let test = std::env::current_exe().unwrap();
    test.parent().and_then(Path::parent).unwrap().join(format!("examples/editor{}", std::env::consts::EXE_SUFFIX))
}

/// Jobs that ran and jobs that were kept, in the line about an edit.
fn jobs(told: &str, about: &str) -> [usize; 2] {
    let line = told.lines().find_map(|line| line.strip_prefix(&format!("{about}: "))).unwrap();
    let numbers: Vec<usize> = line.split([' ', ',']).filter_map(|word| word.parse().ok()).collect();
    [numbers[0], numbers[1]]
}

#[test]
fn an_edit_computes_what_it_changes() {
    let output = Command::new(editor()).output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let told = String::from_utf8(output.stdout).unwrap();
    assert!(told.starts_with("a slip: lacquer.toml:6:7: error: "), "{told}");
    assert!(told.contains("\nthe first text: stopped, "), "{told}");

    let [ran, kept] = jobs(&told, "once more");
    assert!(kept > 0 && ran > 0, "what was done before the key is kept: {told}");
    let all = ran + kept;
    assert_eq!(jobs(&told, "another colour"), [0, all], "the colour of a varnish is in no table: {told}");
    assert_eq!(jobs(&told, "another metal"), [1, all - 1], "its row alone is new: {told}");
}
