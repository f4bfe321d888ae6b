//! Choice of the cheapest model, for each material of a scene, whose error against the reference stays inside a budget.
//!
#![doc = include_str!("../README.md")]
//! # In detail
//!
//! [`Judge`] holds one material: its candidates (model, colour, parts of the stack that are left out) in the order of their cost, the
//! directions of the scene, and the reference there. [`Judge::choose`] takes the cheapest candidate that holds, and a [`Director`] those of all materials together.
//!
//! Models are compared with `layered-mc`, the Monte Carlo simulation of the whole stack. Errors of tables and of single precision are not part of
//! these errors; they have budgets of their own. Costs are those of a device ([`CostTable`]), from data that `luthier-lab shapes` and `luthier-lab devices`
//! made: no driver is needed. Where neighbours differ, threads of a wave wait for each other's models ([`scene_cost`]).
//!
//! Simplifications: lights are one direction, a range of directions, or equal from everywhere; effects and maps are not judged;
//! films that vary are judged at their nominal thickness; a pixel's footprint counts as slopes of every interface.

mod candidate;
mod choice;
mod cost;
mod director;
mod divergence;
mod error;
mod probe;
mod reference;
mod shape;
mod simplify;

pub use candidate::{Candidate, forms};
pub use choice::{Judge, MAX_SAMPLES, MODEL_SHARE, TABLE_SHARE, cost_text, label};
pub use cost::{COST_DATA, CostRow, CostTable, ShapeRow, ShapeTable};
pub use director::{Director, Made, SceneFailure, Unchosen};
pub use divergence::{Shaded, scene_cost};
pub use error::{FLOOR, Value};
pub use luthier_cost::DeviceCost;
pub use luthier_manifest::Form;
pub use probe::{Probe, footprint, probes};
pub use shape::{shape, shape_of};
pub use simplify::{LeaveOut, simplified, variants};
