//! One module per verb.

pub(crate) mod bake;
#[cfg(feature = "gpu")]
pub(crate) mod bench;
pub(crate) mod budgets;
pub(crate) mod check;
#[cfg(feature = "gpu")]
pub(crate) mod compare;
pub(crate) mod cost;
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
#[cfg(feature = "gpu")]
pub(crate) mod stability;
#[cfg(feature = "view")]
pub(crate) mod view;
