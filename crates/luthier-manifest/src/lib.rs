//! Names and records of a bake: the manifest, the records of layers that shaders and their f64 twins read, budgets of tables, choices of
//! scenes; targets and colour modes by name. Models, features and forms are those of [`luthier_model`].
//!
#![doc = include_str!("../README.md")]
//! # In detail
//!
//! Every crate that reads or writes a bake says these things with the types of this crate.

mod choice;
mod constants;
mod distribution;
mod error;
mod functions;
mod interface;
mod limits;
mod lock;
mod manifest;
mod map;
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
pub use functions::{FunctionGroup, Functions};
pub use interface::{FunctionEntry, Interface, StructureEntry};
pub use limits::{BUFFER_WORDS_MAX, MaterialTexture, SIDE, SIDE_MAX};
pub use lock::{Decision, Lock};
pub use luthier_model::{
    Feature, Form, InternalReflection, LowerReflectance, Masking, ModelPart, Reflectance, ReflectanceCurve,
    ShadingModel,
};
pub use luthier_optics::stack::Distribution;
pub use manifest::{
    BindingEntry, ColorMode, FileEntry, MANIFEST_SCHEMA, Manifest, MaterialEntry, ShaderEntry, TableEntry,
};
pub use map::{MapEntry, MapSlot};
pub use place::{LayerValues, PlaceValues};
pub use reads::reads;
pub use record::{LAYER_WORDS, LayerKind, LayerRecord, MATERIAL_WORDS, material_buffer};
pub use search::{Budget, Candidate, CandidateForm, MeasuredError, REL_FLOOR, Search};
pub use surface::{CellsRecord, ParticlesRecord, SurfaceEntry, SwitchBy, SwitchRecord};
pub use target::Target;
pub use tiles::Tiles;
