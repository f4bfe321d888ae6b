//! Bakes materials in a build script, and writes a module of Rust with all that a program embeds.
//!
#![doc = include_str!("../README.md")]
//! # In detail
//!
//! [`Build::run`] is the whole of a build script; [`Build::in_folder`] does the same without printing. Modules, each of which uses only earlier
//! ones: module, told, build.

mod build;
mod module;
mod told;

pub use build::Build;
pub use told::Told;

pub use luthier;
