//! The front door of luthier: files of materials become a package of tables and shaders. Every fault is a diagnostic with its place in a file.
//!
#![doc = include_str!("../README.md")]
//! # In detail
//!
//! - [`Sources`]: scenes, surfaces and materials, each file read once, with diagnostics that have places in files;
//! - [`Shading`]: the caller's choice of models, before that of the files; [`Bake`]: all options of a bake;
//! - [`Bake::package`]: materials to a [`Package`], which is in memory until [`Package::write`] publishes it in a folder;
//! - [`refusals`]: every reason to refuse or doubt a material;
//! - [`function`]: a model of a material as a function of two directions, without a bake.
//!
//! A bake computes what its [`Store`] lacks: [`MemoryStore`] starts empty, `luthier_store::DiskStore` keeps results between processes. An
//! [`Observer`] is told of every job, and may cancel the bake.
//!
//! Modules, each of which uses only earlier ones: paths, pictures, refusals, shading, sources, function, bake.

mod bake;
mod error;
pub mod function;
mod paths;
mod pictures;
pub mod refusals;
mod shading;
mod sources;

pub use bake::{Bake, lit, of_materials, outline, row_layout, source_hash};
pub use error::Error;
pub use paths::{find, inner_files};
pub use pictures::{read_image, read_picture};
pub use shading::Shading;
pub use sources::{
    Files, SceneSource, Source, Sources, SurfaceSource, TomlFile, named_files, parse, read_materials, refuse,
    surface_map,
};

pub use luthier_bake::{MemoryStore, Missing, Observer, Options, Share, Silent, Store};
pub use luthier_export::{Compression, Encoded, Folder, Package, PackageError, sha256};
pub use luthier_manifest::{Form, FunctionGroup, Functions, Manifest, ShadingModel, Target};
pub use luthier_material::{Diagnostic, Material, Severity};
