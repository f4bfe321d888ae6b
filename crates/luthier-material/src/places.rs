//! Places of values in a material file, by key.

use std::collections::BTreeMap;
use std::ops::Range;

use crate::section::{Section, section};

/// Places of the values of a material file, by key: `name`, `bake.fgd.size`, `effects.flakes`; of a layer `layer.1.alpha_x`, counted
/// as in the stack, of its films `layer.1.film.0.ior`.
///
/// ```
/// let text = "schema = 1\nname = \"gilding\"\n[[layer]]\ntype = \"conductor\"\nior = \"au\"\nroughness = 0.3\n";
/// let no_files = |_: &str| Err(std::io::ErrorKind::NotFound.into());
/// let places = luthier_material::parse("gilding.toml", text, &no_files).unwrap().material.places;
/// assert_eq!(&text[places.span("layer.0.ior")], "\"au\"");
/// assert!(places.has("layer.0.roughness") && !places.has("layer.0.alpha"));
/// ```
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Places(BTreeMap<String, Range<usize>>);

impl Places {
    /// Adds a table under `prefix`: its place, and those of all values in it. Arrays of tables are left out.
    pub(crate) fn add(&mut self, prefix: &str, at: &Section<'_>) {
        self.0.insert(prefix.to_owned(), at.span.clone());
        for (key, value) in at.table {
            let name =
                if prefix.is_empty() { key.get_ref().to_string() } else { format!("{prefix}.{}", key.get_ref()) };
            match section(value) {
                Some(table) => self.add(&name, &table),
                None => drop(self.0.insert(name, value.span())),
            }
        }
    }

    /// Whether the file has a key.
    pub fn has(&self, key: &str) -> bool {
        self.0.contains_key(key)
    }

    /// Bytes of the value of a key; if the file lacks the key, of the table that it belongs to.
    pub fn span(&self, key: &str) -> Range<usize> {
        let mut key = key;
        loop {
            match (self.0.get(key), key.rsplit_once('.')) {
                (Some(span), _) => return span.clone(),
                (None, Some((table, _))) => key = table,
                (None, None) => return 0..0,
            }
        }
    }
}
