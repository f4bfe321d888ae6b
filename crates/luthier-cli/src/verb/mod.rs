//! One module per verb.

pub(crate) mod audit;
pub(crate) mod bake;
pub(crate) mod check;
#[cfg(feature = "gpu")]
pub(crate) mod compare;
pub(crate) mod eval;
#[cfg(feature = "gpu")]
pub(crate) mod figures;
#[cfg(feature = "gpu")]
pub(crate) mod gallery;
pub(crate) mod ior;
pub(crate) mod models;
#[cfg(feature = "gpu")]
pub(crate) mod parity;
#[cfg(feature = "gpu")]
pub(crate) mod preview;
pub(crate) mod report;
pub(crate) mod schema;
pub(crate) mod shader;
#[cfg(feature = "view")]
pub(crate) mod view;
