//! Shaders for exactly the materials and tables at hand.
//!
#![doc = include_str!("../README.md")]
//! # In detail
//!
//! [`emit`] composes WGSL from small modules: those in `src/wgsl`, and the kernels of models from luthier-layers. It leaves out everything
//! that no material of the set uses, has naga validate the text, and translates it. The result is a snippet to paste: `luthier_eval` and its
//! helpers, no entry point, group 0 for [`bindings`]. [`complete`] puts a small fragment shader around it. [`emit_spirv`] writes a library
//! to link, and [`complete_spirv`] a shader.
//!
//! `luthier_eval` has no loops: it has one step for each depth of the deepest material. Its value is finite for all unit directions and slope
//! parameters from 0.001 to 1. GLSL, HLSL and MSL are naga's output with luthier's names and comments put back. No compiler on Linux checks
//! MSL, and the snippet says so.
//!
//! Effects: flakes tilt the layers below the first interface, and patina covers them, in the models `elek`, `weidlich-wilkie` and `lobes`.
//! Other models leave both out: `granier-heidrich`, `phong` and `microfacet` have no such layer, `belcour` and `yamaguchi` mix all layers into
//! a few lobes. Glitter turns the whole surface, for any model. A shader fills a `LuthierPlace` with `luthier_flake_normal`,
//! `luthier_patina_amount`, `luthier_glitter_normal` and `luthier_film_place`, and calls `luthier_eval_at`.
//!
//! [`MaterialSet::functions`] asks for more: `luthier_prepare` and `luthier_light`, drawn directions, albedos.
//!
//! [`library`] translates any WGSL module of functions, textures and samplers, and [`library_spirv`] compiles it to SPIR-V. Tables of engines,
//! which belong to no material, get their look-ups this way.
//!
//! [`Yardstick`] has shaders of engines, to compare costs with. [`count`] counts the operations of an evaluation from its text: reads by kind, special
//! functions, plain arithmetic.
//!
//! Modules use only those named before them: `functions`, `identifiers`, `style`, `error`, `yardstick`; `set`; `validate`; `compose` (WGSL of a set) and
//! `languages` (any WGSL in another language) and `count` (operations of any WGSL), which do not use each other; `library` and `emit`.
//!
//! Simplifications: bindings of materials are in group 0; the full form has one film per interface.
//!
//! A shader that writes sums of `luthier_eval` over lights passes them through `luthier_bounded`. Binding numbers of group 0 from
//! [`RESERVED_BINDINGS`] up are the caller's.

mod compose;
mod count;
mod emit;
mod error;
mod functions;
mod identifiers;
mod languages;
mod library;
mod set;
mod style;
mod validate;
mod yardstick;

pub use count::{Record, Sides, StaticCounts, count, count_sides};
pub use emit::{complete, complete_spirv, emit, emit_constant, emit_spirv, interface};
pub use error::ShaderError;
pub use languages::spirv::{library_spirv, spirv_words};
pub use library::library;
pub use luthier_manifest::{Form, Target};
pub use set::{MaterialSet, RESERVED_BINDINGS, TableFace, Within, bindings, identifier, surface_identifier};
pub use style::style_name;
pub use validate::{checks, validate};
pub use yardstick::{CoatNumbers, Yardstick};
