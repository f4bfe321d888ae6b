//! Languages of emitted shaders.

use serde::{Deserialize, Serialize};

luthier_lut::named! {
    /// The language of an emitted shader.
    #[derive(Serialize, Deserialize)]
    #[serde(into = "&'static str", try_from = "String")]
    pub enum Target("target") {
        /// WebGPU shading language.
        Wgsl = "wgsl",
        /// Desktop GLSL 4.50; the material buffer is a std430 storage block.
        Glsl450 = "glsl450",
        /// GLSL ES 3.00 (WebGL 2); the material buffer is a texture.
        GlslEs300 = "glsl-es300",
        /// HLSL, shader model 5.1; the material buffer is a `ByteAddressBuffer`.
        Hlsl = "hlsl",
        /// Metal Shading Language 2.0; textures, sampler and material buffer (`device`) are arguments of the functions.
        Msl = "msl",
        /// SPIR-V 1.3, in bytes.
        SpirV = "spirv",
    }
}

impl Target {
    /// The targets that are text.
    pub const TEXT: [Self; 5] = [Self::Wgsl, Self::Glsl450, Self::GlslEs300, Self::Hlsl, Self::Msl];

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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_of_different_languages_end_differently() {
        let endings: std::collections::BTreeSet<&str> = Target::ALL.into_iter().map(Target::extension).collect();
        assert_eq!(endings.len(), Target::ALL.len());
        assert!(!endings.contains(""));
    }
}
