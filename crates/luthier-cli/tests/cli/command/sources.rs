//! Comments of the sources: a file begins with a line that says what it holds, and a summary stands alone in an index of items.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

use luthier_workshop::root;

/// Beginnings of a summary that refer to something beside it.
const BEGINNINGS: [&str; 5] = ["The same", "What ", "Whoever ", "Nobody ", "That "];

fn collect(folder: &Path, files: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            collect(&path, files);
        } else if path.extension().is_some_and(|extension| extension == "rs" || extension == "wgsl") {
            files.push(path);
        }
    }
}

/// The sources of every crate, Rust and WGSL, with their text.
pub(super) fn sources() -> Vec<(String, String)> {
    let mut files = Vec::new();
    for entry in fs::read_dir(root().join("crates")).unwrap() {
        collect(&entry.unwrap().path().join("src"), &mut files);
    }
    files.sort();
    let name = |path: &Path| path.strip_prefix(root()).unwrap().display().to_string();
    files.iter().map(|path| (name(path), fs::read_to_string(path).unwrap())).collect()
}

/// The text of a line of a doc comment.
fn comment(line: &str) -> Option<&str> {
    let line = line.trim_start();
    line.strip_prefix("//!").or_else(|| line.strip_prefix("///")).map(str::trim_start)
}

#[test]
fn every_file_begins_with_what_it_holds() {
    let without: Vec<String> = sources()
        .into_iter()
        .filter(|(name, text)| name.ends_with(".rs") && !text.starts_with("//! "))
        .map(|(name, _)| name)
        .collect();
    assert!(without.is_empty(), "no line `//! …` at the top of {without:#?}");
}

#[test]
fn no_folder_has_more_than_twenty_files() {
    let mut folders: BTreeMap<String, usize> = BTreeMap::new();
    for (name, _) in sources() {
        *folders.entry(name.rsplit_once('/').unwrap().0.to_owned()).or_default() += 1;
    }
    folders.retain(|_, files| *files > 20);
    assert!(folders.is_empty(), "{folders:#?}");
}

#[test]
fn summaries_stand_alone() {
    let mut found = Vec::new();
    for (name, text) in sources() {
        let mut above = None;
        for (number, line) in text.lines().enumerate() {
            let text = comment(line);
            if above.is_none() && text.is_some_and(|text| BEGINNINGS.iter().any(|b| text.starts_with(b))) {
                found.push(format!("{name}:{}: {}", number + 1, line.trim()));
            }
            above = text;
        }
    }
    assert!(found.is_empty(), "summaries that say nothing without their surroundings: {found:#?}");
}
