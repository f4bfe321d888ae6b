use thiserror::Error;

use crate::{Form, TableKind, TexelFormat};

/// Why a table or a manifest is not usable.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum LutError {
    /// The manifest is not JSON of the documented shape.
    #[error("not a luthier manifest: {0}")]
    Manifest(#[from] serde_json::Error),
    /// The manifest was written by another version of the format.
    #[error("manifest schema {found}, this program reads schema {expected}; bake again with this version")]
    ManifestSchema {
        /// Version in the file.
        found: u32,
        /// Version understood here.
        expected: u32,
    },
    /// Texel bytes that do not fit the layout.
    #[error("{found} bytes of texels where {expected} are needed")]
    TexelBytes {
        /// Given.
        found: usize,
        /// Width x height x bytes per texel.
        expected: usize,
    },
    /// The layout of a table in the manifest is impossible.
    #[error("the manifest gives the {} table an impossible layout", .0.name())]
    Layout(TableKind),
    /// A table has texels that differ from its entry in the manifest.
    #[error("the {} table is {found}; the manifest says {expected}", kind.name())]
    TableMismatch {
        /// The table.
        kind: TableKind,
        /// Size, format and bytes at hand.
        found: String,
        /// Size, format and bytes according to the manifest.
        expected: String,
    },
    /// Blocks that only part of the image fills, or that are not fitted as here.
    #[error("blocks of texels that were not baked here")]
    Blocks,
    /// A texel format that does not exist.
    #[error("unknown texel format `{0}`; known: {known}", known = TexelFormat::ALL.map(TexelFormat::name).join(", "))]
    UnknownFormat(String),
    /// A form of shaders that does not exist.
    #[error("unknown shader form `{0}`; known: {known}", known = Form::ALL.map(Form::name).join(", "))]
    UnknownForm(String),
}
