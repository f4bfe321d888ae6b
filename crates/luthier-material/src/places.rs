//! Places of values in a material file, by key.

use std::collections::BTreeMap;
use std::ops::Range;

use crate::section::{Section, section};

/// Where the values of a material file stand, by key: `name`, `bake.fgd.size`, `effects.flakes`; of a layer `layer.1.alpha_x`, counted
/// as in the stack, of its films `layer.1.film.0.ior`.
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

    /// Bytes of the value of a key; where the file lacks it those of the table that it belongs to.
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
