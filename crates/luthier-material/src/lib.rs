//! Material files: TOML to a validated layer stack, with diagnostics that point at the mistake.
//!
#![doc = include_str!("../README.md")]
//! # In detail
//!
//! [`parse`] reads one file. A declarative grammar (keys, types, ranges, alternatives) checks it first, a decoder then
//! builds the [`Stack`](luthier_optics::stack::Stack); both report as much as they can in one run. [`schema`] is the same
//! grammar as JSON Schema, and [`reference()`] in words. [`parse_scene`] and [`scene_schema`] do the same for scenes, which name materials, and
//! [`parse_surface`] and [`surface_schema`] for surfaces, which say where materials are.
//!
//! Physical nonsense is an error, doubtful physics a warning. This crate crosses the units of files (degrees, artist's
//! roughness) into those of the optics (radians, slope parameters), once.
//!
//! # Rooms
//!
//! Each uses those above it, none below.
//!
//! - `bake_settings`, `class`, `diagnostic`, `picture`, `suggest`: words of materials and of messages.
//! - `effects`, `section`, `places`, `material`: a material, and where its values stand in the file.
//! - `left_out`, `default_model`, `doubt`, `cross_section`, `rewrite`: what follows from a material.
//! - `grammar`: keys, kinds and bounds as data; `schema` and `reference` put them into words.
//! - `correct`, `check`, `decode`, `parse`: from a text to a material; `scene` and `surface` to those of other files.
//! - `template`: files to begin with.

mod bake_settings;
mod check;
mod class;
mod correct;
mod cross_section;
mod decode;
mod default_model;
mod diagnostic;
mod doubt;
mod effects;
mod grammar;
mod left_out;
mod material;
mod parse;
mod picture;
mod places;
mod reference;
mod rewrite;
mod scene;
mod schema;
mod section;
mod suggest;
mod surface;
mod template;

pub use bake_settings::{
    AlphaMapping, BakeSettings, Beams, DEFAULT_WAVELENGTHS_NM, DistributionMapping, DistributionSettings,
    FresnelMapping, FresnelSettings, GridSettings, RowSettings,
};
pub use class::{SMOOTH_SLOPE_DEG, SurfaceClass};
pub use cross_section::{CrossSection, Part, PartKind, PartNumber};
pub use diagnostic::{Diagnostic, Severity};
pub use doubt::ALPHA_MIN;
pub use effects::{Effects, FlakeSource, Flakes, Glitter, Patina};
pub use left_out::{LeftOut, distribution_key, left_out};
pub use material::{
    FilmVariation, LayerExtras, Maps, Material, Metallic, NamedImage, NamedMap, SlopeRanges, TexelRanges,
};
pub use parse::{FileKind, Parsed, parse, parse_partly};
pub use picture::{Channel, PictureRef, TexelUse, UvTransform, VariationSource};
pub use places::Places;
pub use reference::{KeyReference, TableReference, reference};
pub use rewrite::rewritten;
pub use scene::{Light, Scene, SceneMaterial, SceneTarget, View, parse_scene};
pub use schema::{scene_schema, schema, surface_schema};
pub use suggest::did_you_mean;
pub use surface::{NamedMaterial, Surface, SurfaceCells, SurfaceGlitter, SurfaceSwitch, parse_surface};
pub use template::Template;
