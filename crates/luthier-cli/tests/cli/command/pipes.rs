//! Readers that have had enough, and disks that are full.

use std::process::{Command, Stdio};

use assert_cmd::cargo::cargo_bin;
use luthier_workshop::root;

fn luthier(args: &[&str]) -> Command {
    let mut command = Command::new(cargo_bin!("luthier"));
    command.current_dir(root()).args(args).stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null());
    command
}

/// A pipe whose reader is gone.
fn broken_pipe() -> Stdio {
    let (reader, writer) = std::io::pipe().unwrap();
    drop(reader);
    writer.into()
}

#[test]
fn a_closed_standard_output_is_no_failure() {
    let cases: [&[&str]; 9] = [
        &["schema"],
        &["completions", "zsh"],
        &["man"],
        &["ior"],
        &["ior", "au", "--json"],
        &["check", "materials"],
        &["shader", "materials/papers/red-lacquer.toml"],
        &["--help"],
        &["--version"],
    ];
    for args in cases {
        let output = luthier(args).stdout(broken_pipe()).stderr(Stdio::piped()).output().unwrap();
        let said = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(0), "{args:?}: {said}");
        assert!(!said.contains("error") && !said.contains("panicked"), "{args:?}: {said}");
    }
}

#[test]
fn a_closed_standard_error_changes_no_verdict() {
    for (args, code) in [(["check", "tests/broken"], 1), (["check", "nowhere"], 3), (["check", "materials"], 0)] {
        let status = luthier(&args).stderr(broken_pipe()).status().unwrap();
        assert_eq!(status.code(), Some(code), "{args:?}");
    }
}

#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_is_a_failure() {
    let full = std::fs::OpenOptions::new().write(true).open("/dev/full").unwrap();
    let output = luthier(&["schema"]).stdout(full).stderr(Stdio::piped()).output().unwrap();
    assert_eq!(output.status.code(), Some(3));
    assert!(String::from_utf8_lossy(&output.stderr).contains("standard output"));
}
