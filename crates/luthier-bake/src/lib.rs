//! Bakes materials into tables, by a graph of pure jobs.
//!
#![doc = include_str!("../README.md")]
//! # In detail
//!
//! [`bake`] plans one job per distinct table tile, runs the graph on the rayon pool, and assembles one atlas per kind with
//! the layer records that refer to its tiles. A job is a pure function of its inputs; its [`Key`] is the hash of these, so
//! equal interfaces of different materials share a tile, and the bytes depend on nothing else: not on threads, build
//! profile or platform.
//!
//! Simplifications: albedos are tabulated at the nominal thickness of films, reflectances over all of their thickness where it
//! varies; anisotropic surfaces enter with the geometric mean of their slope parameters, except in lobes.

mod assemble;
mod constants;
mod decide;
mod error;
mod graph;
mod grid;
mod json;
mod kinds;
mod limits;
mod maps;
mod plan;
mod records;
mod search;
mod settings;
mod share;
mod tile;
mod veil;

pub use assemble::{
    Baked, BakedMaterial, Options, Outline, bake, bake_with, check, kinked_rows, outline, outline_with,
};
pub use error::BakeError;
pub use graph::{Artefact, Function, JobKind, Key, MemoryStore, Observer, Share, Silent, Store, Task, kept};
pub use kinds::lobes::{VARIED_LAYERS_MAX, fitted, is_too_deep};
pub use maps::{MapSource, MaterialMap, height_normals};
pub use plan::ImageReader;
pub use search::{AIM, DEFAULT_BUDGET, goals};
pub use share::{Missing, bake_share, missing};
