//! Several imports in one folder, and the report on them.

use std::collections::{BTreeMap, BTreeSet};

use serde_json::{Value, json};

use crate::{Import, Imported, Line};

/// A file that was imported.
#[derive(Debug, Clone, PartialEq)]
pub struct Source {
    /// The file, as it was named.
    pub label: String,
    /// Its materials.
    pub import: Import,
}

/// All files to write by relative path. Where several imports have files of one name and other bytes, the later ones get numbers.
pub fn together(read: &mut [Source]) -> BTreeMap<String, Vec<u8>> {
    let mut all: BTreeMap<String, Vec<u8>> = BTreeMap::new();
    for Source { import, .. } in read {
        let pictures = std::mem::take(&mut import.pictures);
        let own: BTreeSet<String> = pictures.keys().cloned().collect();
        for (path, bytes) in pictures {
            // No picture takes the name of another one of its import, which texts still have.
            let is_free = |place: &str| all.get(place).is_none_or(|known| *known == bytes);
            let place = free(&path, |place| is_free(place) && (place == path || !own.contains(place)));
            if place != path {
                let [from, to] = [&path, &place].map(|path| format!("\"{path}\""));
                import.materials.iter_mut().for_each(|material| material.text = material.text.replace(&from, &to));
            }
            all.insert(place, bytes);
        }
        for material in &mut import.materials {
            let place = free(&format!("{}.toml", material.name), |place| !all.contains_key(place));
            let name = place.trim_end_matches(".toml").to_owned();
            let [from, to] = [&material.name, &name].map(|name| format!("\nname = \"{name}\"\n"));
            material.text = material.text.replacen(&from, &to, 1);
            material.name = name;
            all.insert(place, material.text.clone().into_bytes());
        }
    }
    all
}

/// A path, or the first with a number before its ending, that is free.
fn free(path: &str, is_free: impl Fn(&str) -> bool) -> String {
    let (stem, ending) = path.rsplit_once('.').unwrap_or((path, ""));
    let numbered = (2..).map(|number| format!("{stem}-{number}.{ending}"));
    let found = std::iter::once(path.to_owned()).chain(numbered).find(|path| is_free(path));
    found.unwrap_or_else(|| unreachable!("numbers do not end"))
}

/// The report on imports for programs: each property, and what became of it.
pub fn report(read: &[Source], generator: &str) -> Value {
    let line =
        |Line { property, fate, note }: &Line| json!({ "property": property, "fate": fate.name(), "note": note });
    let material = |Imported { name, source_name, lines, .. }: &Imported| {
        let lines: Vec<Value> = lines.iter().map(line).collect();
        json!({ "name": name, "source_name": source_name, "file": format!("{name}.toml"), "properties": lines })
    };
    let sources = read.iter().map(|Source { label, import }| {
        let materials: Vec<Value> = import.materials.iter().map(material).collect();
        json!({ "source": label, "materials": materials, "properties": import.lines.iter().map(line).collect::<Vec<_>>() })
    });
    json!({ "generator": generator, "sources": sources.collect::<Vec<_>>() })
}
