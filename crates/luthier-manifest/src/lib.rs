//! Names and records of a bake: the manifest, the records of layers that shaders and their f64 twins read, budgets of tables, choices of
//! scenes; models, features, forms, targets and colour modes by name.
//!
#![doc = include_str!("../README.md")]
//! # In detail
//!
//! Every crate that reads or writes a bake says these things with the types of this crate.

mod choice;
mod constants;
mod distribution;
mod error;
mod feature;
mod form;
mod functions;
mod limits;
mod lock;
mod manifest;
mod map;
mod model;
mod parts;
mod place;
mod reads;
mod record;
mod search;
mod surface;
mod target;
mod tiles;

pub use choice::{MaterialChoice, SceneBudget, SceneCandidate, SceneChoice, SceneDirection, SceneError, Verdict};
pub use constants::{
    AxesRecord, BeamsRecord, FlakesRecord, GlitterRecord, LobesError, LobesRecord, MaterialConstants, PaintedRecord,
    PatinaRecord, VaryingFactor, VaryingRecord,
};
pub use error::ManifestError;
pub use feature::Feature;
pub use form::Form;
pub use functions::{FunctionGroup, Functions};
pub use limits::{BUFFER_WORDS_MAX, MaterialTexture, SIDE, SIDE_MAX};
pub use lock::{Decision, Lock};
pub use luthier_optics::stack::Distribution;
pub use manifest::{
    BindingEntry, ColorMode, FileEntry, MANIFEST_SCHEMA, Manifest, MaterialEntry, ShaderEntry, TableEntry,
};
pub use map::{MapEntry, MapSlot};
pub use model::ShadingModel;
pub use parts::{InternalReflection, LowerReflectance, Masking, Reflectance, ReflectanceCurve};
pub use place::{LayerValues, PlaceValues};
pub use record::{LAYER_WORDS, LayerKind, LayerRecord, MATERIAL_WORDS, material_buffer};
pub use search::{Budget, Candidate, CandidateForm, MeasuredError, REL_FLOOR, Search};
pub use surface::{CellsRecord, ParticlesRecord, SurfaceEntry, SwitchBy, SwitchRecord};
pub use target::Target;
pub use tiles::Tiles;
