//! Reflectance models by name, with one row of facts for each.
//!
#![doc = include_str!("../README.md")]
//! # In detail
//!
//! [`ShadingModel::facts`] gives the row of a model ([`Facts`]); all rows are in `rows.rs`. Crates ask the row, and keep no list of models of
//! their own.

mod ask;
mod default_for;
mod domain;
mod facts;
mod feature;
mod form;
mod parts;
mod rows;
mod tolerance;

pub use default_for::DefaultFor;
pub use domain::{INDEX_MAX, Limit, Quantity};
pub use facts::{Facts, Family, Reach, ReadWhen, Shows, TableRead};
pub use feature::Feature;
pub use form::Form;
pub use parts::{
    DiffusePart, DiffuseTerm, InternalReflection, LobeHeight, LowerAlpha, LowerCosine, LowerFacets, LowerReflectance,
    Masking, ModelPart, PathParts, Reflectance, ReflectanceCurve,
};
pub use rows::ShadingModel;
pub use tolerance::{Tolerance, Tolerances};
