//! Words, numbers and JSON for readers.

pub(crate) mod format;
pub(crate) mod json;
