//! Shaders for exactly the materials and tables at hand.
//!
#![doc = include_str!("../README.md")]
//! # In detail
//!
//! [`emit`] composes WGSL from small modules (`src/wgsl`, one per model or table), leaves out what no material of the set
//! uses, has naga validate it, and gives it as WGSL, GLSL 4.50, GLSL ES 3.00, HLSL or MSL. The result is a snippet to
//! paste: `luthier_eval` and its helpers, no entry point, group 0 for [`bindings`]. [`complete`] puts a small fragment shader
//! around it. [`emit_spirv`] and [`complete_spirv`] give the same as SPIR-V: a library to link, and a shader.
//!
//! `luthier_eval` has no loops, but one step for every layer that a material of the set may have. The functions are finite for all
//! unit directions and slope parameters from 0.001 to 1. GLSL, HLSL and MSL are naga's output with our names and comments put back;
//! nothing on Linux can check MSL, and the snippet says so.
//!
//! Effects: flakes tilt what lies below the first interface, and patina covers it, in the models `elek`, `weidlich-wilkie` and `lobes`;
//! models without such a layer (`granier-heidrich`, `phong`, `microfacet`) or that mix all layers into a few lobes (`belcour`,
//! `yamaguchi`) leave both out. Glitter turns the whole surface, for any model. A shader fills a `LuthierPlace` with
//! `luthier_flake_normal`, `luthier_patina_amount`, `luthier_glitter_normal` and `luthier_film_place`, and calls
//! `luthier_eval_at`.
//!
//! [`MaterialSet::functions`] asks for more: `luthier_prepare` and `luthier_light`, drawn directions, albedos.
//!
//! [`library`] puts any WGSL module of functions, textures and samplers into these languages, and [`library_spirv`] into SPIR-V: look-ups of
//! tables that are no material's.
//!
//! Modules, each on those above it: `functions`, `identifiers`, `style`, `error`; `set`; `validate`; `compose` (WGSL of a set) and `languages` (any WGSL
//! in another language), which do not know each other; `library` and `emit`.
//!
//! Simplifications: bindings of materials are in group 0; the full form knows one film per interface.
//!
//! Sums of `luthier_eval` over lights go through `luthier_bounded` where they are written. Numbers of group 0 from
//! [`RESERVED_BINDINGS`] up are the caller's.

mod compose;
mod emit;
mod error;
mod functions;
mod identifiers;
mod languages;
mod library;
mod set;
mod style;
mod validate;

pub use emit::{complete, complete_spirv, emit, emit_constant, emit_spirv, interface};
pub use error::ShaderError;
pub use languages::spirv::{library_spirv, spirv_words};
pub use library::library;
pub use luthier_manifest::{Form, Target};
pub use set::{MaterialSet, RESERVED_BINDINGS, TableFace, bindings, identifier, surface_identifier};
pub use style::style_name;
pub use validate::validate;
