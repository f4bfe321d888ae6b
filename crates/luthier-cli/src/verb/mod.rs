//! One module per verb.

pub(crate) mod audit;
pub(crate) mod bake;
#[cfg(feature = "gpu")]
pub(crate) mod bench;
pub(crate) mod cache;
pub(crate) mod check;
#[cfg(feature = "gpu")]
pub(crate) mod compare;
#[cfg(feature = "cost")]
pub(crate) mod cost;
pub(crate) mod environment;
pub(crate) mod eval;
#[cfg(feature = "gpu")]
pub(crate) mod gallery;
pub(crate) mod ior;
pub(crate) mod models;
#[cfg(feature = "gpu")]
pub(crate) mod preview;
pub(crate) mod report;
pub(crate) mod scene;
pub(crate) mod schema;
pub(crate) mod shader;
pub(crate) mod table;
#[cfg(feature = "view")]
pub(crate) mod view;
