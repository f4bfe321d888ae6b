//! Material files from materials of other formats.
//!
#![doc = include_str!("../README.md")]
//! # In detail
//!
//! ```
//! let text = br#"{
//!     "asset": {"version": "2.0"},
//!     "materials": [{
//!         "name": "Red Lacquer",
//!         "pbrMetallicRoughness": {"baseColorFactor": [0.5, 0.1, 0.1, 1], "metallicFactor": 0},
//!         "extensions": {"KHR_materials_clearcoat": {"clearcoatFactor": 1}}
//!     }]
//! }"#;
//! let none = |_: &str| Err(std::io::ErrorKind::NotFound.into());
//! let import = luthier_import::gltf("lacquer.gltf", text, &none).unwrap();
//! let lacquer = &import.materials[0];
//! assert_eq!(lacquer.name, "red-lacquer");
//! assert!(lacquer.text.contains("darkening = false"));
//! ```
//!
//! Simplifications: a surface is a coat, a film and a base, of which each may be absent. Light that goes through the surface, cloth and light from below the surface of a thick body are dropped, and told.
//!
//! # Rooms
//!
//! Each uses those above it, none below.
//!
//! - `error`, `fate`, `name`: refusals, what becomes of a property, names of materials and of pictures.
//! - `draft`: a material file as layers with keys, and its text.
//! - `rules`: numbers that formats share, and how a file says them.
//! - `pictures`: pictures of a source, unchanged or computed.
//! - `gltf`, `mtlx`, `physically_based`: materials of glTF, of MaterialX, and of a database.
//! - `together`: several imports in one folder, and the report on them.

mod draft;
mod error;
mod fate;
mod gltf;
mod mtlx;
mod name;
mod physically_based;
mod pictures;
mod rules;
mod together;

use std::collections::BTreeMap;
use std::io;

pub use error::ImportError;
pub use fate::{Fate, Line};
pub use gltf::{GltfPoint, GltfPoints, gltf, gltf_points};
pub use mtlx::materialx;
pub use physically_based::physically_based;
pub use together::{Source, report, together};

/// Materials of a file, with their pictures.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Import {
    /// The materials, in the order of the file.
    pub materials: Vec<Imported>,
    /// Bytes of the pictures by path, relative to the material files.
    pub pictures: BTreeMap<String, Vec<u8>>,
    /// Properties of the file that belong to no material.
    pub lines: Vec<Line>,
}

impl Import {
    /// All files by path, relative to one folder: those of the materials, and the pictures.
    pub fn files(&self) -> impl Iterator<Item = (String, &[u8])> {
        let materials = self.materials.iter().map(|of| (format!("{}.toml", of.name), of.text.as_bytes()));
        materials.chain(self.pictures.iter().map(|(path, bytes)| (path.clone(), bytes.as_slice())))
    }
}

/// A material.
#[derive(Debug, Clone, PartialEq)]
pub struct Imported {
    /// Its name, valid and unique in the import.
    pub name: String,
    /// Its name in the source.
    pub source_name: String,
    /// The material file.
    pub text: String,
    /// Properties of the source with their fates.
    pub lines: Vec<Line>,
}

/// The materials of a file of any of the formats, told by its content: see [`gltf`], [`materialx`] and [`physically_based`].
///
/// # Errors
/// Those of the format; of glTF where it is none of them.
pub fn import(label: &str, bytes: &[u8], files: &dyn Fn(&str) -> io::Result<Vec<u8>>) -> Result<Import, ImportError> {
    if mtlx::is_xml(bytes) {
        return materialx(label, bytes, files);
    }
    let is_text = bytes.trim_ascii_start().starts_with(b"{");
    let text = is_text.then(|| serde_json::from_slice(bytes).ok()).flatten();
    if text.is_some_and(|text| physically_based::is_database(&text)) {
        return physically_based(label, bytes);
    }
    gltf(label, bytes, files)
}

/// Comments on what a file does not say as its source does.
pub(crate) fn told(lines: &[Line]) -> impl Iterator<Item = String> {
    let changed = lines.iter().filter(|line| matches!(line.fate, Fate::Approximated | Fate::Dropped));
    changed.map(|Line { property, fate, note }| format!("{property}, {fate}: {note}"))
}
