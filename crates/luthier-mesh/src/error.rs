//! Errors of meshes.

use thiserror::Error;

/// Reason why a file is not a mesh that can be shown.
///
/// ```
/// use luthier_mesh::{MeshError, soup};
///
/// let text = br#"{"asset": {"version": "1.0"}}"#;
/// let error = soup(text, &|_| Err(std::io::ErrorKind::NotFound.into())).unwrap_err();
/// assert!(matches!(error, MeshError::Version(version) if version == "1.0"));
/// ```
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum MeshError {
    /// Bytes that are not glTF.
    #[error("no glTF 2.0 file: {0}")]
    Gltf(String),
    /// Another version of glTF.
    #[error("glTF {0}, of which nothing is read: export the mesh as glTF 2.0")]
    Version(String),
    /// A required extension that is not supported.
    #[error("the file needs the extension {0}, which is not supported: export the mesh without it")]
    Extension(String),
    /// A compression of the numbers.
    #[error("the mesh is compressed ({0}), which is not supported: export it without compression")]
    Compressed(String),
    /// A buffer that cannot be read.
    #[error("buffer `{uri}`: {reason}")]
    Buffer {
        /// The buffer, as the file names it.
        uri: String,
        /// The mistake in it.
        reason: String,
    },
    /// Numbers that break the rules of glTF.
    #[error("{what} of mesh `{mesh}`: {reason}")]
    Accessor {
        /// The numbers, such as positions.
        what: &'static str,
        /// Name or number of the mesh.
        mesh: String,
        /// The mistake in them.
        reason: String,
    },
    /// No triangle to show.
    #[error(
        "the file has no triangles that take a material: parts whose glTF material is named `plain` keep a colour of their own"
    )]
    Empty,
    /// More triangles than pictures of materials are made for.
    #[error("{count} triangles; at most {limit} are shown: export a coarser mesh")]
    TooLarge {
        /// Triangles of the file.
        count: usize,
        /// The limit.
        limit: usize,
    },
}
