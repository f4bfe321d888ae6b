//! Names and records of a bake: the manifest, the records of layers that shaders and their f64 twins read, budgets of tables, choices of
//! scenes; targets and colour modes by name. Models, features and forms are those of [`luthier_model`].
//!
#![doc = include_str!("../README.md")]
//! # In detail
//!
//! Every crate that reads or writes a bake says these things with the types of this crate.
//!
//! # Rooms
//!
//! Each uses those above it, none below.
//!
//! - `color`, `distribution`, `error`, `file`, `limits`, `place`, `search`, `shader`, `surface`, `target`, `tiles`: names and numbers.
//! - `record`, `constants`: layers and whole surfaces to a shader; `reads` says which tables a layer reads.
//! - `map`, `live`, `material`: maps, numbers that a program sets, and materials with all of these; `buffer` writes them down for shaders.
//! - `choice`, `manifest`, `lock`: how a scene chose, the whole bake, and its decisions that stay.

mod buffer;
mod choice;
mod color;
mod constants;
mod distribution;
mod error;
mod file;
mod limits;
mod live;
mod lock;
mod manifest;
mod map;
mod material;
mod place;
mod reads;
mod record;
mod search;
mod shader;
mod surface;
mod target;
mod tiles;

pub use buffer::{MATERIAL_WORDS, material_buffer};
pub use choice::{
    CostDevice, MaterialChoice, SceneBudget, SceneCandidate, SceneChoice, SceneDirection, SceneError, Verdict,
};
pub use color::ColorMode;
pub use constants::{
    AxesRecord, BeamsRecord, BrighteningRecord, CoatRecord, FamilyRecord, FlakesRecord, GlitterRecord, LobesError,
    LobesForm, LobesRecord, MaterialConstants, PaintedRecord, PatinaRecord, ShortRecord, SideRecord, SlopesRecord,
    VaryingFactor, VaryingRecord,
};
pub use error::ManifestError;
pub use file::FileEntry;
pub use limits::{BUFFER_WORDS_MAX, MaterialTexture, SIDE, SIDE_MAX};
pub use live::{LiveEntry, LiveRange};
pub use lock::{Decision, Lock};
pub use luthier_model::{
    DiffusePart, DiffuseTerm, Feature, Form, InternalReflection, LobeHeight, LowerAlpha, LowerCosine, LowerFacets,
    LowerReflectance, Masking, ModelPart, PathParts, Reflectance, ReflectanceCurve, ShadingModel,
};
pub use luthier_optics::stack::Distribution;
pub use manifest::{BindingEntry, MANIFEST_SCHEMA, Manifest, ShaderEntry, TableEntry};
pub use map::{MapEntry, MapSlot};
pub use material::MaterialEntry;
pub use place::{LayerValues, PlaceValues};
pub use reads::reads;
pub use record::{LAYER_WORDS, LayerKind, LayerRecord};
pub use search::{Budget, Candidate, CandidateForm, MeasuredError, REL_FLOOR, Search};
pub use shader::{Check, FunctionEntry, FunctionGroup, Functions, Interface, Names, StructureEntry};
pub use surface::{CellsRecord, ParticlesRecord, SurfaceEntry, SwitchBy, SwitchRecord};
pub use target::Target;
pub use tiles::Tiles;
