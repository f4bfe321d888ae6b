//! Tables that renderers read beside a material: split sums, energy compensation, cloth, thin films, area lights, sheen.
//!
#![doc = include_str!("../README.md")]
//! # In detail
//!
//! A [`DfgTable`] states a function, axes, contents and texels. [`DfgTable::bake`] fills it, [`DfgTable::error`]
//! measures the reads of a sampler, and [`search`] finds the smallest table. [`Preset`]s are the tables of engines.
//! [`ClosedForm::fit`] finds a form without a table: two quotients of polynomials and a fifth power.
//! [`search_beside_form`] finds the cheapest form that holds an error together with a table of limited bytes.
//! [`DfgTable::wgsl`] and [`ClosedForm::wgsl`] write the shader function `luthier_dfg`.
//!
//! An [`EnergyTable`] states a table of albedos for energy compensation, of metals and of dielectrics from both sides.
//! [`EnergyPreset`]s are the tables of renderers.
//!
//! A [`FilmTable`] holds the colour of a plane under a thin film, over angle and thickness. A [`FresnelTable`] holds
//! the reflectance of a plane of any index, over angle, n and k. [`LtcTable`] and [`SheenTable`] hold linearly
//! transformed cosines: of rough metals for area lights, and of a layer of fibres.
//!
//! Simplifications: tables have one level, and are read by linear filtering along each axis. Split sums are for light
//! from above and for Schlick's reflectance.

mod axes;
mod base;
mod closed;
mod dfg;
mod energy;
mod film;
mod fresnel;
mod lookup;
mod ltc;
mod preset;
pub mod rgbd;
mod search;
mod slices;
mod stored;
mod value;

pub use axes::{AxesError, AxisSpec, Layout, Nodes, Quantity};
pub use base::Base;
pub use closed::{ClosedForm, Cost, FittedForm, Polynomial, Rational, measure_form};
pub use dfg::DfgTable;
pub use energy::{
    EnergyContainer, EnergyDomain, EnergyFile, EnergyLayout, EnergyPreset, EnergySurface, EnergyTable, EnergyValue,
};
pub use film::{FilmLayout, FilmTable};
pub use fresnel::{FresnelLayout, FresnelTable};
pub use lookup::{Bindings, LOOKUP, REFLECTANCE, REFLECTANCE_SAMPLER, REFLECTANCE_TEXTURE, SAMPLER, TEXTURE};
pub use ltc::{
    IrradianceError, Lobe, LtcError, LtcTable, LtcTexels, PlacedError, SheenTable, clipped_sphere_form_factor,
};
pub use preset::{Container, Preset};
pub use search::{Found, SPLIT_SUM, search, search_beside_form};
pub use stored::Stored;
pub use value::Value;
