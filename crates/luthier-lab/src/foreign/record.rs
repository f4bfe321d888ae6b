//! Records of files that were tried, of all collections.

use std::collections::BTreeMap;
use std::path::Path;

use luthier_terminal::{Failure, Outcome, files};
use serde::{Deserialize, Serialize};

use super::kinds::Read;

/// A file that was tried.
pub(super) struct Tried {
    pub(super) name: String,
    pub(super) seconds: f64,
    pub(super) read: Read,
}

/// All collections, by name.
#[derive(Debug, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct Data {
    pub(super) collections: Vec<Collection>,
}

/// Files of one origin.
#[derive(Debug, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct Collection {
    pub(super) name: String,
    /// Where to fetch it.
    pub(super) from: String,
    pub(super) licence: String,
    /// By the name of the kind.
    pub(super) kinds: BTreeMap<String, Counted>,
}

/// The files of one kind of a collection.
#[derive(Debug, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct Counted {
    pub(super) files: usize,
    /// Files that are read, with notes and without.
    pub(super) read: usize,
    /// Files that are read with notes.
    pub(super) noted: usize,
    /// Files of each note.
    pub(super) notes: BTreeMap<String, Vec<String>>,
    /// Files by reason, with `N` in place of numbers.
    pub(super) refused: BTreeMap<String, Vec<String>>,
    /// Files of each panic.
    pub(super) panicked: BTreeMap<String, Vec<String>>,
    pub(super) slowest: String,
    pub(super) slowest_s: f64,
}

impl Data {
    /// The file; empty where there is none yet.
    pub(super) fn read(path: &Path) -> Outcome<Self> {
        if !path.exists() {
            return Ok(Self::default());
        }
        let text = std::fs::read_to_string(path).map_err(files(path, "read"))?;
        serde_json::from_str(&text)
            .map_err(|error| Failure::Input(anyhow::Error::new(error).context(path.display().to_string())))
    }

    pub(super) fn write(&self, path: &Path) -> Outcome {
        let text = serde_json::to_string_pretty(self).map_err(Failure::input)?;
        std::fs::write(path, text + "\n").map_err(files(path, "write"))
    }

    /// The collection of a name. A new one is added at its place in the order.
    pub(super) fn collection(&mut self, name: &str) -> &mut Collection {
        let at = self.collections.binary_search_by(|collection| collection.name.as_str().cmp(name));
        let at = at.unwrap_or_else(|at| {
            self.collections.insert(at, Collection { name: name.to_owned(), ..Collection::default() });
            at
        });
        &mut self.collections[at]
    }
}

impl Collection {
    /// Keeps the outcome of a kind in place of an earlier one. A kind that the collection has no file of is left out.
    pub(super) fn put(&mut self, kind: &str, tried: &[Tried]) {
        self.kinds.remove(kind);
        if !tried.is_empty() {
            self.kinds.insert(kind.to_owned(), Counted::of(tried));
        }
    }
}

impl Counted {
    fn of(tried: &[Tried]) -> Self {
        let mut counted = Self { files: tried.len(), ..Self::default() };
        for Tried { name, seconds, read } in tried {
            // Times differ from run to run: one digit says enough.
            let seconds = (seconds * 10.0).round() / 10.0;
            if seconds > counted.slowest_s {
                (counted.slowest, counted.slowest_s) = (name.clone(), seconds);
            }
            match read {
                Read::Whole(notes) => {
                    counted.read += 1;
                    counted.noted += usize::from(!notes.is_empty());
                    notes.iter().for_each(|note| add(&mut counted.notes, note, name));
                }
                Read::Refused(reason) => add(&mut counted.refused, reason, name),
                Read::Panicked(text) => add(&mut counted.panicked, text, name),
            }
        }
        counted
    }
}

/// Adds a file to those of its sentence.
fn add(to: &mut BTreeMap<String, Vec<String>>, text: &str, file: &str) {
    to.entry(without_numbers(text)).or_default().push(file.to_owned());
}

/// A sentence with `N` in the place of each number, so that sentences of one reason are the same.
fn without_numbers(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    let mut is_word = false;
    let mut rest = text.chars().peekable();
    while let Some(c) = rest.next() {
        if c.is_ascii_digit() && !is_word {
            while rest.next_if(|c| c.is_ascii_alphanumeric()).is_some() {}
            out.push('N');
            // A fraction: its point has a digit behind it.
            let mut ahead = rest.clone();
            if ahead.next() == Some('.') && ahead.next().is_some_and(|c| c.is_ascii_digit()) {
                rest.next();
                while rest.next_if(|c| c.is_ascii_alphanumeric()).is_some() {}
            }
        } else {
            is_word = c.is_alphabetic() || c == '_' || (is_word && c.is_ascii_digit());
            out.push(c);
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sentences_of_one_reason_are_the_same() {
        for (text, expected) in [
            ("line 12: `x` is not a number", "line N: `x` is not a number"),
            ("12.", "N."),
            ("-1.5e3 of 3x4, BC6H, v2", "-N of N, BC6H, v2"),
        ] {
            assert_eq!(without_numbers(text), expected);
        }
    }

    #[test]
    fn a_run_takes_the_place_of_an_earlier_one() {
        let tried = |name: &str, seconds, read| Tried { name: name.to_owned(), seconds, read };
        let refused = |text: &str| Read::Refused(text.to_owned());
        let mut data = Data::default();
        data.collection("b").put("sky", &[tried("old", 0.0, refused("old"))]);
        let all = [
            tried("a", 0.2, refused("line 3")),
            tried("b", 0.31, Read::Whole(vec!["animations".to_owned()])),
            tried("c", 0.1, refused("line 14")),
            tried("d", 0.1, Read::Whole(Vec::new())),
            tried("e", 0.1, Read::Panicked("index 7".to_owned())),
        ];
        data.collection("b").put("sky", &all);
        data.collection("a").put("mesh", &[]);
        let names: Vec<&str> = data.collections.iter().map(|collection| collection.name.as_str()).collect();
        assert_eq!((names, data.collections[0].kinds.len()), (vec!["a", "b"], 0));
        let counted = &data.collections[1].kinds["sky"];
        assert_eq!((counted.files, counted.read, counted.noted), (5, 2, 1));
        assert_eq!(counted.refused, BTreeMap::from([("line N".to_owned(), vec!["a".to_owned(), "c".to_owned()])]));
        assert_eq!(counted.panicked["index N"], ["e"]);
        assert_eq!((counted.slowest.as_str(), counted.slowest_s), ("b", 0.3));
        assert_eq!(data, serde_json::from_str(&serde_json::to_string(&data).unwrap()).unwrap());
    }
}
