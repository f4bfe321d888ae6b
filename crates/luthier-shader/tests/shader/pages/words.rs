//! The words of conditions in modules, and the page for people who change modules.

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

/// Files of a folder and the folders in it.
fn texts(folder: &Path) -> Vec<String> {
    let paths = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    paths.flat_map(|path| if path.is_dir() { texts(&path) } else { vec![fs::read_to_string(path).unwrap()] }).collect()
}

/// Words that the lines `//? ...` of modules name.
fn named(modules: &[String]) -> BTreeSet<&str> {
    let marks = modules.iter().flat_map(|module| module.lines()).filter_map(|line| line.split_once("//?"));
    let words = marks.flat_map(|(_, condition)| condition.split([',', '|']));
    words
        .map(|word| word.trim().trim_start_matches(['!', '~']))
        .filter(|word| !matches!(*word, "else" | "end"))
        .collect()
}

/// Words in the first column of the tables under "Words".
fn explained(page: &str) -> BTreeSet<&str> {
    let words = page.split("\n## Words\n").nth(1).unwrap().split("\n## ").next().unwrap();
    let first = words.lines().filter_map(|line| line.strip_prefix("| `")?.split(" | ").next());
    first.flat_map(|column| column.split(['`', ',', ' '])).filter(|word| !word.is_empty()).collect()
}

#[test]
fn every_word_is_explained() {
    let crate_folder = Path::new(env!("CARGO_MANIFEST_DIR"));
    let page = fs::read_to_string(crate_folder.join("../../docs/shader-modules.md")).unwrap();
    let modules = [crate_folder.join("src/wgsl"), crate_folder.join("../luthier-layers/src/models")]
        .map(|folder| texts(&folder))
        .concat();
    let explained = explained(&page);
    let tables: BTreeSet<&str> =
        luthier_lut::TableKind::NAMES.iter().copied().chain(["film_table"]).filter(|name| *name != "film").collect();
    let unexplained: Vec<&str> = named(&modules).into_iter().filter(|word| !explained.contains(word)).collect();
    assert!(unexplained.iter().all(|word| tables.contains(word)), "{unexplained:?} of {tables:?}");
    // A word that no module names is one that the composition asks for, or makes others of.
    let composition = texts(&crate_folder.join("src/compose")).concat();
    for word in explained {
        let is_distribution = luthier_manifest::Distribution::from_name(word).is_some();
        assert!(
            is_distribution || word.starts_with("mask_") || composition.contains(&format!("\"{word}\"")),
            "`{word}` is no word"
        );
    }
}
