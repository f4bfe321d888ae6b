//! Pages: a judgement as HTML with its charts, as JSON, and as a few lines of text.

pub(crate) mod chart;
pub(crate) mod format;
pub(crate) mod json;
pub(crate) mod page;
pub(crate) mod summary;
