//! Rooms: one folder for each model with a shader, with its formula, its kernels and their f64 twin.

use crate::model::Model;
use crate::models::parts::Parts;
use crate::models::shade::{Given, Shade};

/// Contents of a model's room for the rest of the crates.
#[derive(Debug, Clone, Copy)]
pub struct Room {
    /// Text of its kernels.
    pub kernels: Kernels,
    /// Its twin for a surface.
    pub(crate) twin: fn(&Given<'_>) -> Box<dyn Shade>,
    /// The model at one wavelength and its variants, for listings.
    pub(crate) models: fn() -> Vec<Box<dyn Model>>,
    /// The model at one wavelength with parts that a material chooses; `None` for a model without a choice.
    pub composed: fn(Parts) -> Option<Box<dyn Model>>,
}

/// Kernels of a model: modules in the template language of luthier-shader (docs/shader-modules.md). An empty text is no module.
///
/// Families `Path` and `Statistics` have a function that depends on the stacks of the set. luthier-shader writes it from the steps here: adding an
/// interface, spreading a lobe. Other families have whole functions here.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Kernels {
    /// `luthier_eval_<model>`, or its steps.
    pub eval: &'static str,
    /// `luthier_parts_<model>`: lobes to draw directions from.
    pub parts: &'static str,
    /// Drawing of directions, for models that do not draw by parts.
    pub sample: &'static str,
    /// Light of an environment.
    pub environment: &'static str,
}

impl Kernels {
    /// No kernels.
    pub const NONE: Self = Self { eval: "", parts: "", sample: "", environment: "" };
}
