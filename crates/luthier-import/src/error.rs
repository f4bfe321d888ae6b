//! Errors of imports.

use thiserror::Error;

/// Reason why a file gives no materials.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum ImportError {
    /// A file that is not glTF.
    #[error(transparent)]
    Gltf(#[from] luthier_mesh::MeshError),
    /// A material whose numbers have other types than the format asks for.
    #[error("material {number}{name}: {reason}")]
    Material {
        /// Its place in the file, from 0.
        number: usize,
        /// Its name in quotes, after a space; empty without one.
        name: String,
        /// The mistake in it.
        reason: String,
    },
    /// A text that is not what its format asks for.
    #[error("{0}")]
    Json(#[source] serde_json::Error),
    /// A file without materials that are read, and why after a colon.
    #[error("the file has no materials that are read{0}")]
    Empty(String),
    /// A MaterialX file that is none, or one of its includes.
    #[error("{place}: {reason}")]
    Xml {
        /// Its file, where it is an include, and its line.
        place: String,
        /// The mistake in it.
        reason: String,
    },
}
