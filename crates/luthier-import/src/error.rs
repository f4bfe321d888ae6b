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
    /// A file without materials.
    #[error("the file has no materials")]
    Empty,
}
