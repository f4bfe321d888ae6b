//! Errors of meshes.

use thiserror::Error;

/// Why a file is no mesh that can be shown.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum MeshError {
    /// Bytes that are no glTF.
    #[error("no glTF 2.0 file: {0}")]
    Gltf(String),
    /// Another version of glTF.
    #[error("glTF {0}, of which nothing is read: export the mesh as glTF 2.0")]
    Version(String),
    /// An extension without which the file means something else.
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
    /// Numbers that are not as glTF has them.
    #[error("{what} of mesh `{mesh}`: {reason}")]
    Accessor {
        /// The numbers, such as positions.
        what: &'static str,
        /// Name or number of the mesh.
        mesh: String,
        /// The mistake in them.
        reason: String,
    },
    /// Nothing to show.
    #[error(
        "the file has no triangles that take a material: parts whose glTF material is named `plain` keep a colour of their own"
    )]
    Empty,
    /// More than pictures of materials are made for.
    #[error("{count} triangles; at most {limit} are shown: export a coarser mesh")]
    TooLarge {
        /// Triangles of the file.
        count: usize,
        /// The most that are taken.
        limit: usize,
    },
}
