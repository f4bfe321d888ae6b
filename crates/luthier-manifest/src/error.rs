//! Faults of manifests.

use luthier_lut::TableKind;
use thiserror::Error;

/// Why a manifest is not usable.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum ManifestError {
    /// The manifest is not JSON of the documented shape.
    #[error("not a luthier manifest: {0}")]
    Json(#[from] serde_json::Error),
    /// The manifest was written by another version of the format.
    #[error("manifest schema {found}, this program reads schema {expected}; bake again with this version")]
    Schema {
        /// Version in the file.
        found: u32,
        /// Version understood here.
        expected: u32,
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
}
