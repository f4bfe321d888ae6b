//! The library's front door: materials become a [`Package`] in memory, a package becomes files, and files become a package again.
//!
#![cfg_attr(feature = "bake", doc = include_str!("../README.md"))]
//! # In detail
//!
//! With the feature `bake`, which is the default, packages are made from materials, and material files are read with all that is wrong with
//! them. Without it the crate reads packages only, and depends on nothing that bakes: so does the runtime, `luthier-gpu`.
//!
//! A set of materials outside the domain of its model is refused here, and by every program that is built on this crate.

mod encode;
mod error;
mod folder;
pub mod input;
mod package;
mod publish;

#[cfg(feature = "bake")]
mod beams;
#[cfg(feature = "bake")]
mod doubts;
#[cfg(feature = "bake")]
mod energy;
#[cfg(feature = "bake")]
mod inner;
#[cfg(feature = "bake")]
mod make;
#[cfg(feature = "bake")]
mod origins;
#[cfg(feature = "bake")]
mod parts;
#[cfg(feature = "bake")]
mod pictures;
#[cfg(feature = "bake")]
mod refusals;
#[cfg(feature = "bake")]
mod renderer;
#[cfg(feature = "bake")]
mod sources;
#[cfg(feature = "bake")]
mod surfaces;

pub use encode::{Compression, Encoded, sha256};
pub use error::PackageError;
pub use folder::{Folder, MANIFEST, MAX_FILE_BYTES};
pub use package::{Map, Package, Shader, Table};
pub use publish::{ENVIRONMENT, REPORT_FILES, REPORT_FOLDER, publish, publish_beside, shared, wait};

#[cfg(feature = "bake")]
pub use doubts::{of_domain, of_model};
#[cfg(feature = "bake")]
pub use energy::{Returned, of_energy, returned};
#[cfg(feature = "bake")]
pub use inner::{inner_files, inner_packages};
#[cfg(feature = "bake")]
pub use luthier_bake::{MemoryStore, Missing, Share, Store};
#[cfg(feature = "bake")]
pub use luthier_material::{LeftOut, left_out};
#[cfg(feature = "bake")]
pub use make::{Bake, ExportError, outline, source_hash, unfitted};
#[cfg(feature = "bake")]
pub use origins::origin;
#[cfg(feature = "bake")]
pub use parts::{of_function, of_parts, of_scene, parts_of};
#[cfg(feature = "bake")]
pub use pictures::{read_image, read_picture};
#[cfg(feature = "bake")]
pub use refusals::{refuse, refuse_too_many};
#[cfg(feature = "bake")]
pub use renderer::{lit, lit_functions};
#[cfg(feature = "bake")]
pub use sources::{Source, find, label, of_text, parse, plain, read, read_all, read_one};
#[cfg(feature = "bake")]
pub use surfaces::{Gathered, SurfaceSource, doubt_surfaces, gather, refuse_surfaces, surface_map};

pub(crate) use publish::READY;

/// Program and version, as manifests and reports name it.
pub const GENERATOR: &str = concat!("luthier ", env!("CARGO_PKG_VERSION"));
