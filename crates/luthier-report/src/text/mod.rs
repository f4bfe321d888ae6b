//! Words, numbers and JSON as a reader wants them.

pub(crate) mod format;
pub(crate) mod json;
