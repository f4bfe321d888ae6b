//! Choice of the cheapest model, for each material of a scene, whose error against the reference stays inside a budget.
//!
#![doc = include_str!("../README.md")]
//! # In detail
//!
//! [`Judge`] holds one material: its candidates (model, colour, parts of the stack that are left out) in the order of their cost, the
//! directions of the scene, and the reference there. [`Judge::choose`] takes the first candidate that holds.
//!
//! Models are compared with `layered-mc`, the Monte Carlo simulation of the whole stack. Errors of tables and of single precision are not part of
//! these errors; they have budgets of their own. Costs come from data that `luthier-lab shapes` made: no driver is needed.
//!
//! Simplifications: lights are one direction, a range of directions, or equal from everywhere; effects and maps are not judged;
//! films that vary are judged at their nominal thickness; a pixel's footprint counts as slopes of every interface.

mod candidate;
mod choice;
mod cost;
mod director;
mod error;
mod probe;
mod reference;
mod shape;
mod simplify;

pub use candidate::Candidate;
pub use choice::{Judge, MAX_SAMPLES, MODEL_SHARE, TABLE_SHARE, label};
pub use cost::{COST_DATA, CostRow, CostTable};
pub use director::{Director, Made, SceneFailure};
pub use error::{FLOOR, Value};
pub use luthier_manifest::Form;
pub use probe::{Probe, footprint, probes};
pub use shape::{shape, shape_of};
pub use simplify::{LeaveOut, simplified, variants};
