//! Look-up tables as data: named axes with their mappings, texel formats, atlases of tiles, a sampler that
//! behaves as texture hardware does, error statistics, and the manifest that ties a bake together.
//!
//! This crate is the one source of truth for where a value lies in a texture. The baker writes by it, the
//! shader emitter prints it, the judge reads by it.
//!
//! Simplifications: tables have one or two axes and one mip level; filtering is bilinear with
//! clamp-to-edge.
//!
//! Out of scope: file containers (`luthier-texture`), the functions that fill tables (`luthier-optics`).

mod atlas;
mod axis;
mod base;
mod bc6h;
mod choice;
mod constants;
mod critical;
mod encoding;
mod error;
mod feature;
mod form;
mod format;
mod image;
mod limits;
mod manifest;
mod measure;
mod record;
mod sampler;
mod search;
mod shading;

pub use atlas::{Atlas, AtlasLayout, TableKind, Tile, read};
pub use axis::{Axis, Mapping};
pub use base::{RowBase, SchlickBase};
pub use choice::{MaterialChoice, SceneBudget, SceneCandidate, SceneChoice, SceneError, Verdict};
pub use constants::{FlakesRecord, GlitterRecord, MaterialConstants, PatinaRecord};
pub use critical::{incident_cosine, refracted_cosine};
pub use encoding::Encoding;
pub use error::LutError;
pub use feature::Feature;
pub use form::Form;
pub use format::{FormatSet, TexelFormat};
pub use image::Image;
pub use limits::{BUFFER_WORDS_MAX, MaterialTexture, SIDE, SIDE_MAX};
pub use manifest::{
    BindingEntry, ColorMode, FileEntry, MANIFEST_SCHEMA, Manifest, MapEntry, MapSlot, MaterialEntry, ShaderEntry,
    TableEntry,
};
pub use measure::{Comparison, ErrorStats, Scan, Worst, measure, measure_at, measure_scan};
pub use record::{LAYER_WORDS, LayerKind, LayerRecord, MATERIAL_WORDS, material_buffer};
pub use sampler::{WeightBits, bilinear};
pub use search::{Budget, Candidate, CandidateForm, MeasuredError, REL_FLOOR, Search};
pub use shading::ShadingModel;
