//! Translation of WGSL by naga, with luthier's names and comments put back.

pub(crate) mod glsl;
pub(crate) mod hlsl;
mod lint;
pub(crate) mod msl;
pub(crate) mod spirv;
pub(crate) mod text;
