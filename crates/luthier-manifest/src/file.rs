//! Files of a bake.

use serde::{Deserialize, Serialize};

/// A file of the bake.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct FileEntry {
    /// Path relative to the manifest, with forward slashes.
    pub path: String,
    /// SHA-256 of its bytes, hex.
    pub sha256: String,
}
