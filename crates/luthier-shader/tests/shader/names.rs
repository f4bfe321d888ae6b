//! Names of materials and surfaces against everything else that shaders name.

use std::collections::BTreeSet;

use luthier_manifest::{CellsRecord, FunctionGroup, MaterialEntry, SurfaceEntry};
use luthier_shader::{Form, MaterialSet, Target, complete, emit, identifier, surface_identifier};

use crate::scenes::{Part, forms, sets, tables, text};

/// The words of a text that may be identifiers.
fn words(text: &str) -> impl Iterator<Item = &str> {
    text.split(|c: char| !c.is_ascii_alphanumeric() && c != '_').filter(|word| !word.is_empty())
}

/// Every word of every language, form and set with all functions, but the constants of the set itself. A surface chooses among the materials of
/// the richest set.
fn words_of_all() -> BTreeSet<String> {
    let mut all = BTreeSet::new();
    let richest = sets().pop().unwrap().0;
    for (name, materials) in sets() {
        let numbers = (0..materials.len().min(2) as u32).collect();
        let cells = CellsRecord { seed: 1, frequency: 4.0, materials: numbers };
        let surface = SurfaceEntry {
            name: "covered".to_owned(),
            source: String::new(),
            source_hash: String::new(),
            cells,
            switches: Vec::new(),
            glitter: None,
        };
        let functions = FunctionGroup::ALL.into_iter().collect();
        let surfaces = [surface];
        let set = MaterialSet { functions, ..MaterialSet::new(&materials, tables()) };
        let chosen = MaterialSet { surfaces: &surfaces, ..set.clone() };
        let own = own(&materials);
        for (form, target) in forms(&materials).flat_map(|form| Target::TEXT.map(|target| (form, target))) {
            let mut texts = [Part::Snippet, Part::Complete].map(|part| text((name, &set), form, target, part)).to_vec();
            if name == richest {
                texts.extend(
                    [emit(&chosen, form, target), complete(&chosen, form, target)].map(|text| text.unwrap().into()),
                );
            }
            all.extend(
                texts.iter().flat_map(|text| words(text)).filter(|word| !own.contains(*word)).map(str::to_owned),
            );
        }
    }
    all
}

fn own(materials: &[MaterialEntry]) -> BTreeSet<String> {
    let materials = materials.iter().map(|material| identifier(&material.name).unwrap());
    materials.chain([surface_identifier("covered").unwrap()]).collect()
}

/// HLSL takes some words in either case.
#[test]
fn no_name_meets_another_identifier() {
    let all = words_of_all();
    assert!(["LUTHIER_MATERIAL_WORDS", "luthier_pick", "luthier_environment"].iter().all(|word| all.contains(*word)));
    let mut met = 0;
    for word in &all {
        let upper = word.to_uppercase();
        for (prefix, of) in [
            ("LUTHIER_MATERIAL_", identifier as fn(&str) -> Result<String, _>),
            ("LUTHIER_SURFACE_", surface_identifier),
        ] {
            let Some(rest) = upper.strip_prefix(prefix) else { continue };
            met += 1;
            // The names that could make it: as it is, and without the ending that names get.
            for name in [rest, rest.strip_suffix("_ID").unwrap_or(rest)] {
                assert_ne!(of(&name.to_lowercase().replace('_', "-")).unwrap_or_default(), upper, "{word}");
            }
        }
    }
    assert!(met > 0);
}

/// A language may add to a name that it reserves: the constants of materials stand in all as they are.
#[test]
fn names_that_languages_reserve_are_constants() {
    let (_, materials) = sets().remove(3);
    let of = |name: &str| MaterialEntry { name: name.to_owned(), ..materials[0].clone() };
    let names = ["words", "Float", "con", "main", "half", "texture", "layer-words", "2"];
    let materials = names.map(of);
    let set = MaterialSet::new(&materials, tables());
    for target in Target::TEXT {
        let text = emit(&set, Form::Baked, target).unwrap();
        for name in names {
            let constant = identifier(name).unwrap();
            assert!(words(&text).any(|word| word == constant), "{target}: {constant}\n");
        }
    }
}
