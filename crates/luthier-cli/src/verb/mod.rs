//! One module per verb.

pub(crate) mod bake;
pub(crate) mod check;
pub(crate) mod eval;
pub(crate) mod ior;
pub(crate) mod models;
#[cfg(feature = "gpu")]
pub(crate) mod preview;
pub(crate) mod report;
pub(crate) mod schema;
pub(crate) mod shader;
