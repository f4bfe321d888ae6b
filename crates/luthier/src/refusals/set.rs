//! Refusals of materials together.

use std::collections::BTreeMap;

use luthier_bake::{BakeError, MemoryStore};
use luthier_material::{Diagnostic, Material, Severity};

use crate::pictures::read_image;

/// Diagnostics of materials as a set, each with the number of its material.
///
/// ```
/// # let chalk = "schema = 1\nname = \"chalk\"\n[[layer]]\ntype = \"diffuse\"\nalbedo = 0.8\n";
/// let twice = [luthier::parse("chalk.toml", chalk)?, luthier::parse("copy.toml", chalk)?];
/// let (number, error) = &luthier::refusals::of_set(&twice)[0];
/// assert_eq!((*number, error.label.as_str()), (1, "copy.toml"), "two materials of one name");
/// # Ok::<(), luthier::Error>(())
/// ```
pub fn of_set(materials: &[Material]) -> Vec<(usize, Diagnostic)> {
    let mut found = Vec::new();
    for error in luthier_bake::check(materials, &luthier_bake::Options::default()).err().unwrap_or_default() {
        let (number, key) = error.place().unwrap_or((0, "name"));
        found.push((number, key.to_owned(), error.to_string()));
    }
    let mut named: BTreeMap<String, &Material> = BTreeMap::new();
    for (number, material) in materials.iter().enumerate() {
        let identifier = match luthier_shader::identifier(&material.name) {
            Ok(identifier) => identifier,
            Err(error) => {
                found.push((number, "name".to_owned(), error.to_string()));
                continue;
            }
        };
        match named.get(&identifier) {
            // Equal names have an error already.
            Some(first) if first.name != material.name => {
                let (name, other, place) = (&material.name, &first.name, first.place("name"));
                let message = format!("`{name}` and `{other}` of {place} are both `{identifier}` in a shader");
                found.push((number, "name".to_owned(), message));
            }
            Some(_) => {}
            None => drop(named.insert(identifier, material)),
        }
    }
    let diagnostics = found.into_iter().filter_map(|(number, key, message)| {
        Some((number, materials.get(number)?.diagnostic(Severity::Error, &key, message, None)))
    });
    diagnostics.collect()
}

/// An error of the first material if the material buffer or a texture cannot hold all materials. A bake finds this itself when it plans its tables.
///
/// ```
/// # let chalk = "schema = 1\nname = \"chalk\"\n[[layer]]\ntype = \"diffuse\"\nalbedo = 0.8\n";
/// assert!(luthier::refusals::too_many(&[luthier::parse("chalk.toml", chalk)?]).is_none());
/// # Ok::<(), luthier::Error>(())
/// ```
pub fn too_many(materials: &[Material]) -> Option<Diagnostic> {
    let options = luthier_bake::Options { search: false, fits: false, ..luthier_bake::Options::default() };
    match luthier_bake::outline_with(materials, &options, &read_image, &MemoryStore::default()) {
        Err(error @ (BakeError::TooManyTiles { .. } | BakeError::TooManyLayers { .. })) => {
            Some(materials.first()?.diagnostic(Severity::Error, "name", error.to_string(), None))
        }
        // Other errors have diagnostics already.
        _ => None,
    }
}
