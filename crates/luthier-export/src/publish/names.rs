//! Names of files in a manifest of any schema. A manifest is read as a stream: with ten thousand materials it has 45 MB, and a parsed tree takes ten
//! times as much.

use std::fmt;
use std::path::{Component, PathBuf};

use serde::Deserialize;
use serde::de::{DeserializeSeed, Deserializer, MapAccess, SeqAccess, Visitor};

/// Digits of a hash in a name. They are 64 bits, so no two of a folder's few files collide.
const DIGITS: usize = 16;

/// A path whose file name contains the hash of the file, before its extension.
pub(crate) fn hashed(path: &str, sha256: &str) -> String {
    let digits = sha256.get(..DIGITS).unwrap_or(sha256);
    match path.rsplit_once('.') {
        Some((stem, extension)) => format!("{stem}.{digits}.{extension}"),
        None => format!("{path}.{digits}"),
    }
}

/// True where all names in a manifest contain the hashes of their files. No file then replaces one of another generation.
pub(super) fn are_hashed(manifest: &str) -> bool {
    let named = named_with_hashes(manifest);
    let mut digits = named.iter().map(|(path, hash)| (path, hash.get(..DIGITS)));
    !named.is_empty() && digits.all(|(path, digits)| digits.is_some_and(|digits| path.contains(digits)))
}

/// The files inside the folder that a manifest of luthier, of any schema, names with a hash.
pub(super) fn named_by(manifest: &str) -> Vec<PathBuf> {
    let paths = named_with_hashes(manifest).into_iter().map(|(path, _)| PathBuf::from(path));
    paths.filter(|path| path.components().all(|part| matches!(part, Component::Normal(_)))).collect()
}

/// Paths and hashes in a manifest of luthier.
fn named_with_hashes(manifest: &str) -> Vec<(String, String)> {
    #[derive(Deserialize)]
    struct Head {
        generator: String,
    }
    if !serde_json::from_str(manifest).is_ok_and(|head: Head| head.generator.starts_with("luthier ")) {
        return Vec::new();
    }
    let mut names = Vec::new();
    let mut pieces = serde_json::Deserializer::from_str(manifest);
    if Names(&mut names).deserialize(&mut pieces).is_err() {
        return Vec::new();
    }
    names
}

/// Collects the paths and hashes of all objects that have both. The value of this seed is the text, if it is one.
struct Names<'n>(&'n mut Vec<(String, String)>);

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
        // A file without a name is none.
        self.0.extend(path.filter(|path| !path.is_empty()).zip(hash));
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

    /// Oracle: the names by hand.
    #[test]
    fn names_contain_hashes() {
        let hash = "0123456789abcdef0123";
        let name = hashed("tables/a.b.ktx2", hash);
        assert_eq!(
            (name.as_str(), hashed("a", hash).as_str()),
            ("tables/a.b.0123456789abcdef.ktx2", "a.0123456789abcdef")
        );
        let manifest = |path: &str, hash: &str| {
            format!(
                r#"{{"generator": "luthier 0", "a": {{"path": "{path}", "sha256": "{hash}"}}, "b": {{"path": "{name}", "sha256": "{hash}"}}}}"#
            )
        };
        assert!(are_hashed(&manifest("x/0123456789abcdef", hash)));
        assert!(!are_hashed(&manifest("x", hash)) && !are_hashed(&manifest(&name, "9876543210")) && !are_hashed(""));
    }

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
