//! The languages of shaders, by name.

use std::fmt;
use std::str::FromStr;

use crate::ShaderError;

/// The language of an emitted shader.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Target {
    /// WebGPU shading language.
    Wgsl,
    /// Desktop GLSL 4.50; the material buffer is a std430 storage block.
    Glsl450,
    /// GLSL ES 3.00 (WebGL 2); the material buffer is a texture.
    GlslEs300,
    /// HLSL, shader model 5.1; the material buffer is a `ByteAddressBuffer`.
    Hlsl,
    /// Metal Shading Language 2.0; textures, sampler and material buffer (`device`) are arguments of the functions.
    Msl,
    /// SPIR-V 1.3, in bytes.
    SpirV,
}

impl Target {
    /// All targets.
    pub const ALL: [Self; 6] = [Self::Wgsl, Self::Glsl450, Self::GlslEs300, Self::Hlsl, Self::Msl, Self::SpirV];

    /// The targets that are text.
    pub const TEXT: [Self; 5] = [Self::Wgsl, Self::Glsl450, Self::GlslEs300, Self::Hlsl, Self::Msl];

    /// The name in manifests and on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Wgsl => "wgsl",
            Self::Glsl450 => "glsl450",
            Self::GlslEs300 => "glsl-es300",
            Self::Hlsl => "hlsl",
            Self::Msl => "msl",
            Self::SpirV => "spirv",
        }
    }

    /// The ending of a file in this language, without the leading dot; different for every target.
    pub fn extension(self) -> &'static str {
        match self {
            Self::Wgsl => "wgsl",
            Self::Glsl450 => "450.glsl",
            Self::GlslEs300 => "es300.glsl",
            Self::Hlsl => "hlsl",
            Self::Msl => "metal",
            Self::SpirV => "spv",
        }
    }
}

impl fmt::Display for Target {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

impl FromStr for Target {
    type Err = ShaderError;

    fn from_str(s: &str) -> Result<Self, ShaderError> {
        Self::ALL.into_iter().find(|t| t.name() == s).ok_or_else(|| ShaderError::UnknownTarget(s.to_owned()))
    }
}
