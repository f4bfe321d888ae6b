//! Bakes materials into tables, by a graph of pure jobs.
//!
#![doc = include_str!("../README.md")]
//! # In detail
//!
//! [`bake`] plans one job per distinct table tile, runs the graph on the rayon pool, and assembles one atlas per kind.
//! Layer records refer to the tiles by number. A job is a pure function of its inputs; its [`Key`] is the hash of
//! these. Equal interfaces of different materials therefore share a tile, and the bytes depend on neither threads,
//! build profile nor platform.
//!
//! Simplifications: albedos are tabulated at the nominal thickness of a film, reflectances over its whole range of
//! thickness. Anisotropic surfaces enter with the geometric mean of their slope parameters, except in lobes.
//!
//! # Rooms
//!
//! Each room uses those above it, none below.
//!
//! - `error`, `json`, `grid`, `tile`: refusals, the text of keys, functions on grids, tiles.
//! - `graph`: jobs, their results, and stores of these.
//! - `form`, `options`, `settings`, `relief`, `plan`: data of a bake, from requests to jobs.
//! - `candidates`: forms that a table may have, and the choice among them.
//! - `kinds`: each kind of table, with its jobs and its candidates.
//! - `records`, `veil`, `constants`, `maps`: the part of a material that is not in tables.
//! - `limits`, `planner`, `check`: from materials to a plan, and refusals before anything is computed.
//! - `search`: the shapes of tables, from a lock or from candidates.
//! - `assemble`, `share`, [`goals`]: whole bakes, shares of one, and figures of the search.

mod assemble;
mod candidates;
mod check;
mod constants;
mod error;
mod form;
pub mod goals;
mod graph;
mod grid;
mod json;
mod kinds;
mod limits;
mod maps;
mod options;
mod plan;
mod planner;
mod records;
mod relief;
mod search;
mod settings;
mod share;
mod tile;
mod veil;

pub use assemble::{Baked, BakedMaterial, Outline, bake, bake_with, kinked_rows, outline, outline_with};
pub use candidates::{AIM, DEFAULT_BUDGET};
pub use check::check;
pub use error::BakeError;
pub use graph::{Artefact, Function, JobKind, Key, MemoryStore, Observer, Share, Silent, Store, Task, kept};
pub use kinds::lobes::{VARIED_LAYERS_MAX, fitted, has_lone_rows, is_too_deep};
pub use maps::{MapSource, MaterialMap, height_normals, live_numbers};
pub use options::Options;
pub use relief::ImageReader;
pub use share::{Missing, bake_share, missing};
