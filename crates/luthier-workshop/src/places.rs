//! Files of the repository, and programs of the machine.

use std::fs;
use std::path::{Path, PathBuf};

use sha2::{Digest, Sha256};

/// Top of the repository.
pub fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// The `*.toml` of a folder of the repository, by name.
pub fn material_files(folder: &str) -> Vec<PathBuf> {
    let entries = fs::read_dir(root().join(folder)).unwrap();
    let mut paths: Vec<PathBuf> = entries.map(|entry| entry.unwrap().path()).collect();
    paths.retain(|path| path.extension().is_some_and(|e| e == "toml"));
    paths.sort();
    paths
}

/// The last part of a path.
pub fn file_name(path: &Path) -> &str {
    path.file_name().unwrap().to_str().unwrap()
}

/// SHA-256 in hex.
pub fn sha256(bytes: &[u8]) -> String {
    Sha256::digest(bytes).iter().map(|byte| format!("{byte:02x}")).collect()
}

/// A program that a test needs: where it is missing the test is skipped with a note, but fails on a build server.
pub fn is_installed(program: &str, package: &str) -> bool {
    if std::process::Command::new(program).arg("--version").output().is_ok() {
        return true;
    }
    assert!(std::env::var_os("CI").is_none(), "`{program}` is missing: install the package {package}");
    eprintln!("skipped: `{program}` is not installed (Debian package {package})");
    false
}
