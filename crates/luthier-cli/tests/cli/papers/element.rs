//! Elements of the papers as `tests/papers/*.toml` list them.
//!
//! | key | content |
//! |---|---|
//! | `name`, `where` | the element, and its place in the paper |
//! | `key` | the part of a file, or of the command line, that asks for it |
//! | `model` | the model of the shader |
//! | `layers` | a material file with the element, without its head |
//! | `without` | a text in the file, and its replacement: the file without the element |
//! | `other_model` | instead: the model that lacks the element |
//! | `f64_model` | the model in f64 that has the element, where no shader has |
//! | `options`, `options_without` | more options of `luthier eval`, with the element and without it |
//! | `wavelengths_without` | the values without it are those of each channel alone, at these wavelengths |
//! | `other`, `matrix` | a second file, and a matrix of re-radiation, for the models that take one |
//! | `surface` | a surface file without its head, of the materials `m.toml` and `other.toml`: `eval` and the shader are of its place |
//! | `form`, `functions` | the form of the shader, `full` unless given, and its groups of functions |
//! | `place`, `device_place` | statements that make the place on the device; the second has no twin among the options of `eval` |
//! | `measured` | `device` where a table is the element: both values are those of the shader |
//! | `tolerance` | the largest difference of device and f64, 2e-5 unless given |
//! | `page`, `says` | instead of values: a generated page, and a text on it |
//! | `function`, `table`, `figure` | the function of the shader, the kind of table that it reads, a picture |
//! | `hand` | the row of `docs/pages/by-hand.md`, or `none` with the reason why the element has no formula |
//!
//! A cell that begins with `open` is a gap, `none` says that the paper or the method has no such thing.

use std::path::Path;

use luthier_workshop::root;
use toml_edit::{DocumentMut, Item, Table};

/// An element, and its paper.
#[derive(Debug)]
pub(super) struct Element {
    pub(super) file: String,
    table: Table,
}

/// A paper: its title, and its elements.
#[derive(Debug)]
pub(super) struct Paper {
    pub(super) title: String,
    pub(super) elements: Vec<Element>,
}

/// Standing of an element's formula.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Standing {
    /// A calculation by hand agrees with luthier.
    Recomputed,
    /// The element has no formula, or none that one could work out.
    NoFormula,
    /// A column is still a gap, or the formula was not recomputed.
    Open,
}

/// Keys that may stand in an element.
const KEYS: [&str; 26] = [
    "name",
    "where",
    "key",
    "model",
    "layers",
    "without",
    "other_model",
    "f64_model",
    "options",
    "options_without",
    "wavelengths_without",
    "other",
    "matrix",
    "surface",
    "form",
    "functions",
    "place",
    "device_place",
    "measured",
    "tolerance",
    "page",
    "says",
    "function",
    "table",
    "figure",
    "hand",
];

/// Files of the papers, in the order of the page.
pub(super) const FILES: [&str; 5] = ["elek", "granier-heidrich", "yamaguchi", "lecture", "course"];

/// The papers, in the order of the page.
pub(super) fn papers() -> Vec<Paper> {
    FILES.map(read).into_iter().collect()
}

fn read(file: &str) -> Paper {
    let path = root().join("tests/papers").join(format!("{file}.toml"));
    let text = std::fs::read_to_string(&path).unwrap();
    let document: DocumentMut = text.parse().unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    let tables = document["element"].as_array_of_tables().unwrap();
    let elements = tables.iter().map(|table| Element { file: file.to_owned(), table: table.clone() }).collect();
    Paper { title: document["paper"].as_str().unwrap().to_owned(), elements }
}

impl Element {
    /// The text of a key; `None` where the element lacks it.
    pub(super) fn get(&self, key: &str) -> Option<&str> {
        self.table.get(key).map(|item| item.as_str().unwrap_or_else(|| panic!("{}: {key} is a text", self.name())))
    }

    /// The text of a key that every element has.
    pub(super) fn cell(&self, key: &str) -> &str {
        let text = self.get(key).unwrap_or_default().trim();
        assert!(!text.is_empty(), "{}, {}: `{key}` is empty", self.file, self.name());
        text
    }

    pub(super) fn name(&self) -> &str {
        self.table["name"].as_str().unwrap_or("an element without a name")
    }

    /// A list of texts; empty where the element lacks it.
    pub(super) fn list(&self, key: &str) -> Vec<&str> {
        let values = self.table.get(key).and_then(Item::as_array);
        values.map(|values| values.iter().filter_map(|value| value.as_str()).collect()).unwrap_or_default()
    }

    /// The largest difference of device and f64 that holds.
    pub(super) fn tolerance(&self) -> f64 {
        self.table.get("tolerance").and_then(Item::as_float).unwrap_or(2e-5)
    }

    /// Whether a column is still a gap.
    fn has_gap(&self) -> bool {
        ["key", "function", "table", "figure"].iter().any(|key| self.cell(key).starts_with("open"))
    }

    /// Standing of its formula.
    pub(super) fn standing(&self) -> Standing {
        match self.get("hand") {
            _ if self.has_gap() => Standing::Open,
            None => Standing::Open,
            Some(reason) if reason.starts_with("none") => Standing::NoFormula,
            Some(_) => Standing::Recomputed,
        }
    }

    /// The row of the calculation by hand; `None` without one.
    pub(super) fn by_hand(&self) -> Option<&str> {
        self.get("hand").filter(|hand| !hand.starts_with("none"))
    }

    /// Whether it has a number; some gaps have none.
    pub(super) fn is_measured(&self) -> bool {
        self.get("page").is_some() || self.get("layers").is_some()
    }

    /// The material file with the element.
    pub(super) fn with(&self) -> Option<String> {
        self.get("layers").map(headed)
    }

    /// The material file without the element.
    pub(super) fn without(&self) -> Option<String> {
        let layers = self.get("layers")?;
        let [find, replacement] = self.list("without")[..] else { return Some(headed(layers)) };
        assert_eq!(layers.matches(find).count(), 1, "{}: `{find}` once", self.name());
        Some(headed(&layers.replace(find, replacement)))
    }

    /// The surface file with the element, where it is one of surfaces.
    pub(super) fn surface(&self) -> Option<String> {
        self.get("surface").map(|text| format!("surface = 1\nname = \"s\"\n{text}"))
    }

    /// Everything that decides its values.
    pub(super) fn subject(&self) -> String {
        let keys =
            ["layers", "other", "matrix", "surface", "model", "f64_model", "other_model", "form", "page", "says"];
        let texts = keys.map(|key| self.get(key).unwrap_or_default());
        let lists =
            ["without", "options", "options_without", "wavelengths_without"].map(|key| self.list(key).join("|"));
        format!("{texts:?}{lists:?}{:?}", self.get("function").filter(|_| self.get("page").is_some()))
    }

    /// Refuses keys that nothing reads, and files that are not there.
    pub(super) fn check(&self) {
        for (key, _) in &self.table {
            assert!(KEYS.contains(&key), "{}: `{key}` is no key of an element", self.name());
        }
        for key in ["name", "where", "key", "model", "function", "table", "figure"] {
            self.cell(key);
        }
        let figure = self.cell("figure");
        let folder = root().join("docs/pages/figures");
        let is_picture = Path::new(figure).extension().is_some() && folder.join(figure).exists();
        assert!(
            is_picture || ["open", "none"].iter().any(|word| figure.starts_with(word)),
            "{}: {figure}",
            self.name()
        );
        assert!(self.has_gap() || self.is_measured(), "{}: no values", self.name());
        if let Some(reason) = self.get("hand").and_then(|hand| hand.strip_prefix("none")) {
            assert!(reason.starts_with(": ") && reason.len() > 4, "{}: no reason for `none`", self.name());
        }
    }
}

fn headed(layers: &str) -> String {
    format!("schema = 1\nname = \"m\"\n{layers}")
}
