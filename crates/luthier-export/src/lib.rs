//! A package in memory, as files in a folder, and back.
//!
#![doc = include_str!("../README.md")]
//! # In detail
//!
//! [`Package::write`] encodes a package and publishes it as a whole; [`Package::read`] reads it back, and [`Folder`] reads parts of one. This crate
//! depends on nothing that bakes: so does the runtime, `luthier-gpu`. Packages are made by the crate `luthier`.

mod encode;
mod error;
mod folder;
pub mod input;
mod origins;
mod package;
mod publish;

pub use encode::{Compression, Encoded, sha256};
pub use error::PackageError;
pub use folder::{Folder, MANIFEST, MAX_FILE_BYTES};
pub use origins::{label, origin, plain};
pub use package::{Map, Package, Shader, Table};
pub use publish::{ENVIRONMENT, REPORT_FILES, REPORT_FOLDER, publish, publish_beside, shared, wait};

pub(crate) use publish::READY;

/// Program and version, as manifests and reports name it.
pub const GENERATOR: &str = concat!("luthier ", env!("CARGO_PKG_VERSION"));
