//! Errors of packages.

use std::io;
use std::path::PathBuf;

use luthier_lut::TableKind;
use luthier_manifest::{Form, ManifestError};
use luthier_texture::TextureError;
use thiserror::Error;

use crate::MAX_FILE_BYTES;

/// An error of a package that is read, written or used.
///
/// ```
/// use luthier_export::{Package, PackageError};
///
/// let error = Package::read("nowhere".as_ref()).unwrap_err();
/// assert!(matches!(error, PackageError::NoBake { .. }));
/// assert_eq!(error.to_string(), "no bake in nowhere: run `luthier bake` first");
/// ```
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum PackageError {
    /// A folder without a manifest.
    #[error("no bake in {}: run `luthier bake` first", folder.display())]
    NoBake {
        /// The folder.
        folder: PathBuf,
    },
    /// A file cannot be read.
    #[error("cannot read {}: {source}", path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// Error of the system.
        source: io::Error,
    },
    /// The manifest names a file outside its own folder.
    #[error("the manifest names `{path}`, which is not a path inside its folder")]
    Outside {
        /// Path as in the manifest.
        path: String,
    },
    /// A folder, a pipe or a device where a file is expected.
    #[error("{} is not a regular file", path.display())]
    NotAFile {
        /// The path.
        path: PathBuf,
    },
    /// A file larger than any of a bake.
    #[error("{} has more than {} MiB, the most that a file of a bake may have", path.display(), MAX_FILE_BYTES >> 20)]
    TooLarge {
        /// The file.
        path: PathBuf,
    },
    /// A file is not the one that the manifest describes.
    #[error(
        "{} is not the file that the manifest describes (SHA-256 {found}, manifest {expected}); bake again",
        path.display()
    )]
    Hash {
        /// The file.
        path: PathBuf,
        /// Hash of its bytes, hex.
        found: String,
        /// Hash in the manifest, hex.
        expected: String,
    },
    /// The manifest is not one, or contradicts a texture.
    #[error("{}: {source}", path.display())]
    Manifest {
        /// The file.
        path: PathBuf,
        /// Fault of the manifest.
        source: ManifestError,
    },
    /// A texture or a map cannot be decoded.
    #[error("{}: {source}", path.display())]
    Texture {
        /// The file.
        path: PathBuf,
        /// Fault of the texture or map.
        source: TextureError,
    },
    /// A map of another size than the manifest says.
    #[error("{} is {} x {}; the manifest says {} x {}", path.display(), found[0], found[1], expected[0], expected[1])]
    MapSize {
        /// The file.
        path: PathBuf,
        /// Size of the image.
        found: [u32; 2],
        /// Size in the manifest.
        expected: [u32; 2],
    },
    /// A text is not UTF-8.
    #[error("{} is not UTF-8 text", path.display())]
    Text {
        /// The file.
        path: PathBuf,
    },
    /// A file or folder cannot be written.
    #[error("cannot {action} {}: {source}", path.display())]
    Write {
        /// The action in words.
        action: &'static str,
        /// The file or folder.
        path: PathBuf,
        /// Error of the system.
        source: io::Error,
    },
    /// Another bake has been published since this one was read.
    #[error("{} holds another bake than the one that was read: run it again", folder.display())]
    Rebaked {
        /// The folder.
        folder: PathBuf,
    },
    /// The manifest cannot be written, or a table is not the one that it states.
    #[error(transparent)]
    Table(#[from] ManifestError),
    /// Texels that are not those of their format, or cannot be encoded.
    #[error(transparent)]
    Texels(#[from] TextureError),
    /// The manifest lists a table whose texels were not given.
    #[error("no texels for the {} table", kind.name())]
    MissingTexels {
        /// The table.
        kind: TableKind,
    },
    /// A package that was read from a folder has no unrounded values to write.
    #[error("the package was read from a folder, without the unrounded values of its {} table", kind.name())]
    NoTruth {
        /// The table.
        kind: TableKind,
    },
    /// A bake without materials.
    #[error("the bake holds no material")]
    NoMaterials,
    /// A material without layers.
    #[error("material `{name}` has no layer")]
    NoLayers {
        /// The material.
        name: String,
    },
    /// A surface of a material that the bake does not have.
    #[error("the surface `{surface}` names a material that is not in the bake")]
    NoSurfaceMaterial {
        /// The surface.
        surface: String,
    },
    /// No WGSL shader of the form asked for.
    #[error("the bake holds no WGSL shader of the form `{form}`; it has: {known}")]
    NoShader {
        /// The form.
        form: Form,
        /// The forms that there are.
        known: String,
    },
}
