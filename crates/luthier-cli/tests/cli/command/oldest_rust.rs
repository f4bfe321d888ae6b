//! The oldest Rust that compiles luthier is stated in one way everywhere; `scripts/promises.sh` compiles every crate with it.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use luthier_workshop::root;

/// The version that the workspace states.
fn stated() -> String {
    let text = fs::read_to_string(root().join("Cargo.toml")).unwrap();
    let line = text.lines().find_map(|line| line.strip_prefix("rust-version = \"")).unwrap();
    line.trim_end_matches('"').to_owned()
}

/// Manifests of a folder that have a workspace of their own.
fn manifests(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() && !path.ends_with("node_modules") && !path.ends_with("target") {
            manifests(&path, found);
        } else if path.ends_with("Cargo.toml") {
            found.push(path);
        }
    }
}

#[test]
fn pages_and_manifests_state_the_version_of_the_workspace() {
    let version = stated();
    let words = format!("Rust {version} or later");
    for page in ["README.md", "crates/luthier/README.md"] {
        assert!(fs::read_to_string(root().join(page)).unwrap().contains(&words), "{page}: {words}");
    }
    let mut others = Vec::new();
    ["examples", "scripts"].iter().for_each(|folder| manifests(&root().join(folder), &mut others));
    assert!(!others.is_empty());
    for path in others {
        let text = fs::read_to_string(&path).unwrap();
        let line = text.lines().find(|line| line.starts_with("rust-version"));
        assert!(line.is_none_or(|line| line.contains(&version)), "{}: {line:?}", path.display());
    }
    let mut own = Vec::new();
    manifests(&root().join("crates"), &mut own);
    for path in own {
        let text = fs::read_to_string(&path).unwrap();
        let inherits = text.contains("\nrust-version.workspace = true\n");
        assert!(inherits, "{}: no `rust-version.workspace = true`", path.display());
    }
    let clippy = fs::read_to_string(root().join("clippy.toml")).unwrap();
    assert!(!clippy.contains("msrv"), "clippy takes the version of Cargo.toml");
}

/// A toolchain that is pinned, or the one at hand, is no older.
#[test]
fn the_toolchain_is_no_older() {
    let number = |text: &str| text.split(['.', '-', ' ']).map_while(|part| part.parse().ok()).collect::<Vec<u32>>();
    let output = Command::new("rustc").arg("--version").output().unwrap();
    let said = String::from_utf8(output.stdout).unwrap();
    let here = said.strip_prefix("rustc ").unwrap();
    assert!(number(here) >= number(&stated()), "{here}");
    for name in ["rust-toolchain", "rust-toolchain.toml"] {
        assert!(!root().join(name).exists(), "a pinned toolchain would hide what `rust-version` says");
    }
}
