//! Rooms: a folder for each model that has a shader, with its formula, its kernels and their f64 twin.

use crate::model::Model;
use crate::models::parts::Parts;
use crate::models::shade::{Given, Shade};

/// The door of a model's room.
#[derive(Debug, Clone, Copy)]
pub struct Room {
    /// The text of its kernels.
    pub kernels: Kernels,
    /// Its twin for a surface.
    pub(crate) twin: fn(&Given<'_>) -> Box<dyn Shade>,
    /// The model at one wavelength, and variants of it, for listings.
    pub(crate) models: fn() -> Vec<Box<dyn Model>>,
    /// The model at one wavelength with parts that a material chooses; `None` of one without a choice.
    pub composed: fn(Parts) -> Option<Box<dyn Model>>,
}

/// Kernels of a model: modules in the template language of luthier-shader (docs/shader-modules.md). An empty text is no module.
///
/// A model whose family writes a function for each stack (`Path`, `Statistics`) gives steps of it: what an interface adds, or how lobes
/// spread. Others give whole functions.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Kernels {
    /// `luthier_eval_<model>`, or its steps.
    pub eval: &'static str,
    /// `luthier_parts_<model>`: lobes to draw directions from.
    pub parts: &'static str,
    /// Drawing of directions, where it is not by parts.
    pub sample: &'static str,
    /// Light from all around.
    pub environment: &'static str,
}

impl Kernels {
    /// No kernels.
    pub const NONE: Self = Self { eval: "", parts: "", sample: "", environment: "" };
}
