//! The languages that composed WGSL is put into, by naga, with our names and comments.

pub(crate) mod glsl;
pub(crate) mod hlsl;
mod lint;
pub(crate) mod msl;
pub(crate) mod spirv;
pub(crate) mod text;
