//! The steps of CONTRIBUTING.md that add a kind of table, walked with one that is there: no other file mentions it.

use std::collections::BTreeSet;

use luthier_workshop::root;

use super::sources::sources;

/// The kind whose files are walked: the last that was added.
const KIND: &str = "escape";

/// Files that a part of CONTRIBUTING.md names at the beginning of a step, before its colon.
fn steps(title: &str, bullet: impl Fn(&str) -> Option<&str>) -> BTreeSet<String> {
    let page = std::fs::read_to_string(root().join("CONTRIBUTING.md")).unwrap();
    let part = page.split(&format!("{title}\n")).nth(1).unwrap().split("\n##").next().unwrap();
    let beginnings = part.lines().filter_map(|line| Some(bullet(line)?.strip_prefix('`')?.split_once(": ")?.0));
    let files = beginnings.flat_map(|files| files.split("`, `").map(|file| file.trim_matches('`')));
    files.map(|file| format!("crates/{}", file.replace("NAME", KIND))).collect()
}

/// Whether code of a file, tests apart, mentions the kind of table: its variant, its tile, its look-up or its module.
fn mentions(text: &str) -> bool {
    let code = text.split("#[cfg(test)]").next().unwrap();
    let words = ["TableKind::Escape", "Escape =", "escape_tile", "lookup_escape", "mod escape;"];
    code.lines().filter(|line| !line.trim_start().starts_with("//")).any(|line| words.iter().any(|w| line.contains(w)))
}

#[test]
fn six_files_make_a_kind_of_table() {
    let files = steps("## Add a kind of table", |line| line.split_once(". ").map(|(_, rest)| rest));
    assert_eq!(files.len(), 6, "{files:#?}");
    let readers = steps("### Have a model read it", |line| line.strip_prefix("- "));
    assert!(readers.len() <= 5, "{readers:#?}");
    let sources = sources();
    for file in files.iter().chain(&readers) {
        assert!(sources.iter().any(|(name, _)| name == file), "CONTRIBUTING.md names {file}, which is not there");
    }
    let found: BTreeSet<String> =
        sources.into_iter().filter(|(_, text)| mentions(text)).map(|(name, _)| name).collect();
    assert!(found.intersection(&files).count() >= 5, "{found:#?}");
    let is_explained = |file: &&String| readers.contains(*file) || file.contains("luthier-layers/src/models/");
    let others: Vec<&String> = found.difference(&files).filter(|file| !is_explained(file)).collect();
    assert!(others.is_empty(), "CONTRIBUTING.md does not say that `{KIND}` needs these: {others:#?}");
}
