//! One module per verb.

pub(crate) mod bake;
pub(crate) mod check;
pub(crate) mod ior;
#[cfg(feature = "gpu")]
pub(crate) mod preview;
pub(crate) mod report;
pub(crate) mod schema;
pub(crate) mod shader;
