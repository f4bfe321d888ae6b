//! A package in memory, as files in a folder, and back.
//!
#![doc = include_str!("../README.md")]
//! # In detail
//!
//! [`Package::write`] encodes a package and publishes it as a whole; [`Package::read`] reads it back, and [`Folder`] reads parts of one. Neither this
//! crate nor the runtime, `luthier-gpu`, depends on a crate that bakes. The crate `luthier` makes packages.
//!
//! Modules, each of which uses only earlier ones: hash, input, replace, origins, error, publish, package, encode, folder.

mod encode;
mod error;
mod folder;
mod hash;
pub mod input;
mod origins;
mod package;
mod publish;
mod replace;

pub use encode::{Compression, Encoded};
pub use error::PackageError;
pub use folder::Folder;
pub use hash::sha256;
pub use origins::{label, origin, plain};
pub use package::{Map, Package, Shader, Table};
pub use publish::{ENVIRONMENT, REPORT_FILES, REPORT_FOLDER, publish, publish_beside, shared, wait};
pub use replace::{lay, replace};

/// File name of the manifest.
pub const MANIFEST: &str = "manifest.json";

/// Most bytes of any file of a bake: twice the texels of the largest texture, which leaves room for containers and metadata.
pub const MAX_FILE_BYTES: u64 = 2 * luthier_texture::MAX_BYTES;

/// Program and version for manifests and reports.
pub const GENERATOR: &str = concat!("luthier ", env!("CARGO_PKG_VERSION"));
