//! Names of files in a manifest of any schema. It is read piece by piece: that of ten thousand materials has 45 MB, and ten times as much as a tree.

use std::fmt;
use std::path::{Component, PathBuf};

use serde::Deserialize;
use serde::de::{DeserializeSeed, Deserializer, MapAccess, SeqAccess, Visitor};

/// The files that a manifest of luthier, of any schema, names with a hash, as far as they lie inside its folder.
pub(super) fn named_by(manifest: &str) -> Vec<PathBuf> {
    #[derive(Deserialize)]
    struct Head {
        generator: String,
    }
    let is_ours = |head: Head| head.generator.starts_with("luthier ");
    if !serde_json::from_str(manifest).is_ok_and(is_ours) {
        return Vec::new();
    }
    let mut names = Vec::new();
    let mut pieces = serde_json::Deserializer::from_str(manifest);
    if Names(&mut names).deserialize(&mut pieces).is_err() {
        return Vec::new();
    }
    let is_inside = |path: &PathBuf| path.components().all(|part| matches!(part, Component::Normal(_)));
    names.into_iter().map(PathBuf::from).filter(is_inside).collect()
}

/// Collects the paths of all objects that have a path and a hash; gives the value where it is a text.
struct Names<'n>(&'n mut Vec<String>);

impl<'de> DeserializeSeed<'de> for Names<'_> {
    type Value = Option<String>;

    fn deserialize<D: Deserializer<'de>>(self, pieces: D) -> Result<Self::Value, D::Error> {
        pieces.deserialize_any(self)
    }
}

impl<'de> Visitor<'de> for Names<'_> {
    type Value = Option<String>;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("JSON")
    }

    fn visit_map<A: MapAccess<'de>>(self, mut entries: A) -> Result<Self::Value, A::Error> {
        let (mut path, mut hash) = (None, None);
        while let Some(key) = entries.next_key::<String>()? {
            let value = entries.next_value_seed(Names(self.0))?;
            match key.as_str() {
                "path" => path = value,
                "sha256" => hash = value,
                _ => {}
            }
        }
        self.0.extend(path.filter(|_| hash.is_some()));
        Ok(None)
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut items: A) -> Result<Self::Value, A::Error> {
        while items.next_element_seed(Names(self.0))?.is_some() {}
        Ok(None)
    }

    fn visit_str<E>(self, text: &str) -> Result<Self::Value, E> {
        Ok(Some(text.to_owned()))
    }

    fn visit_unit<E>(self) -> Result<Self::Value, E> {
        Ok(None)
    }

    fn visit_bool<E>(self, _: bool) -> Result<Self::Value, E> {
        Ok(None)
    }

    fn visit_i64<E>(self, _: i64) -> Result<Self::Value, E> {
        Ok(None)
    }

    fn visit_u64<E>(self, _: u64) -> Result<Self::Value, E> {
        Ok(None)
    }

    fn visit_f64<E>(self, _: f64) -> Result<Self::Value, E> {
        Ok(None)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_files_inside_the_folder_are_named() {
        let text = r#"{"generator": "luthier 0", "n": [1, -2, 0.5, true, null, "x", {"path": "a/b", "sha256": "0"}],
            "path": "c", "sha256": "1", "up": {"path": "../d", "sha256": "0"}, "root": {"path": "/e", "sha256": "0"},
            "without": {"path": "f"}, "number": {"path": "g", "sha256": 1}}"#;
        assert_eq!(named_by(text), ["a/b", "c"].map(PathBuf::from));
        for other in
            ["", "[]", "{}", "{\"generator\": 1}", &text.replace("luthier 0", "lute 0"), &text[..text.len() - 1]]
        {
            assert!(named_by(other).is_empty(), "{other}");
        }
    }
}
