//! Split-sum tables of engines.

use luthier_optics::split_sum::Masking;
use luthier_optics::stack::Distribution;

use crate::{DfgTable, Layout, Nodes, Stored, Value};

/// File format of an engine's table.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Container {
    /// KTX2.
    Ktx2,
    /// PNG of 8 bits.
    Png,
    /// Bare texels, little-endian, rows from the top.
    Raw,
    /// A JavaScript module that exports the words of half floats as `DFG_LUT_DATA`.
    JavaScript,
    /// PNG of 8 bits and four channels: the bytes of [`crate::rgbd`].
    RgbdPng,
    /// OpenEXR.
    Exr,
}

/// The split-sum table of an engine.
///
/// ```
/// use luthier_table::{Bindings, Preset};
///
/// let table = Preset::named("babylon").unwrap().table();
/// assert_eq!(table.bytes(), 256 * 256 * 4);
/// assert!(table.wgsl(Bindings::default()).unwrap().contains("fn luthier_dfg("));
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Preset {
    /// Name on command lines.
    pub name: &'static str,
    /// Masking term, with GGX.
    pub masking: Masking,
    /// Axes, the one across first, in the grammar of [`Layout::parse`].
    pub axes: &'static str,
    /// Positions of the nodes.
    pub nodes: Nodes,
    /// Content of the channels.
    pub values: &'static [Value],
    /// Texels across and down.
    pub size: [u32; 2],
    /// Number type of the texels.
    pub stored: Stored,
    /// File format of the table.
    pub container: Container,
    /// Source of the layout.
    pub source: &'static str,
}

impl Preset {
    /// All presets, by name.
    pub const ALL: [Self; 8] = [
        Self {
            name: "babylon",
            masking: Masking::SmithCorrelated,
            axes: "cos_theta,roughness",
            nodes: Nodes::CENTRES,
            values: &[Value::Bias, Value::Albedo, Value::Cloth],
            size: [256, 256],
            stored: Stored::Rgbd,
            container: Container::RgbdPng,
            source: "npm @babylonjs/core 9.35.0, Misc/brdfTextureTools.js: environmentBRDFTexture; Shaders/ShadersInclude/helperFunctions.js: fromRGBD",
        },
        Self {
            name: "bevy",
            masking: Masking::SmithCorrelated,
            axes: "cos_theta,roughness",
            nodes: Nodes::CENTRES,
            values: &[Value::Scale, Value::Bias],
            size: [64, 64],
            stored: Stored::Half,
            container: Container::Ktx2,
            source: "bevyengine/bevy: the resource DfgLut of bevy_pbr, dfg.ktx2",
        },
        Self {
            name: "filament",
            masking: Masking::SmithCorrelated,
            axes: "cos_theta,roughness",
            nodes: Nodes::CENTRES,
            values: &[Value::Bias, Value::Albedo, Value::Cloth],
            size: [128, 128],
            stored: Stored::Half,
            container: Container::Raw,
            source: "google/filament, filament/src/DFG.cpp, shaders/src/surface_light_indirect.fs: PrefilteredDFG_LUT; libs/ibl/src/CubemapIBL.cpp: DFG",
        },
        Self {
            name: "gltf",
            masking: Masking::SmithCorrelated,
            axes: "cos_theta,roughness",
            nodes: Nodes::CENTRES,
            values: &[Value::Scale, Value::Bias, Value::Cloth],
            size: [1024, 1024],
            stored: Stored::Unorm8,
            container: Container::Png,
            source: "KhronosGroup/glTF-IBL-Sampler, lib/shaders/filter.frag: LUT_GGX, LUT_CharlieUniform; lut_ggx.png and lut_charlie.png of glTF-Sample-Viewer",
        },
        Self {
            name: "godot",
            masking: Masking::SchlickHalf,
            axes: "cos_theta,-roughness",
            nodes: Nodes::CENTRES,
            values: &[Value::Bias, Value::Albedo, Value::Cloth, Value::One],
            size: [128, 128],
            stored: Stored::Half,
            container: Container::Raw,
            source: "godotengine/godot, servers/rendering/renderer_rd/shaders/forward_clustered/integrate_dfg.glsl",
        },
        Self {
            name: "hdrp",
            masking: Masking::SmithCorrelated,
            axes: "sqrt_cos_theta,-roughness",
            nodes: Nodes::Ends,
            values: &[Value::Bias, Value::Albedo, Value::Disney, Value::One],
            size: [64, 64],
            stored: Stored::Unorm10,
            container: Container::Exr,
            source: "Unity-Technologies/Graphics, preIntegratedFGD_GGXDisneyDiffuse.shader, PreIntegratedFGD.cs; images of Unity have v = 0 at the bottom",
        },
        Self {
            name: "three",
            masking: Masking::SmithCorrelated,
            axes: "roughness,cos_theta",
            nodes: Nodes::CENTRES,
            values: &[Value::Scale, Value::Bias],
            size: [16, 16],
            stored: Stored::Half,
            container: Container::JavaScript,
            source: "npm three 0.187.0, src/renderers/shaders/DFGLUTData.js",
        },
        Self {
            name: "unreal",
            masking: Masking::SmithJointApprox,
            axes: "cos_theta,roughness",
            nodes: Nodes::CENTRES,
            values: &[Value::Scale, Value::Bias],
            size: [128, 32],
            stored: Stored::Unorm16,
            container: Container::Raw,
            source: "Unreal Engine 4, SystemTextures.cpp: PreintegratedGF, Vis_SmithJointApprox; the idea in Karis 2013",
        },
    ];

    /// The preset of a name.
    pub fn named(name: &str) -> Option<&'static Self> {
        Self::ALL.iter().find(|preset| preset.name == name)
    }

    /// The engine's table.
    pub fn table(&self) -> DfgTable {
        DfgTable {
            distribution: Distribution::Ggx,
            masking: self.masking,
            layout: Layout::parse(self.axes, self.nodes).unwrap_or_else(|error| unreachable!("{error}")),
            values: self.values.to_vec(),
            size: self.size,
            stored: self.stored,
            base: None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Of 256 x 256 texels at the most.
    #[test]
    fn every_preset_bakes() {
        for preset in &Preset::ALL {
            let mut table = preset.table();
            table.size = table.size.map(|side| side.min(256));
            let texels = table.bake();
            assert_eq!([texels.width, texels.height], table.size, "{}", preset.name);
            assert_eq!(texels.channels as usize, preset.values.len());
            assert!(texels.data.iter().all(|value| value.is_finite() && *value >= 0.0), "{}", preset.name);
            // Engines' axes are linear: what they miss at grazing angles on smooth surfaces is theirs.
            let error = table.error_against(&texels, [0.1, 0.1], 24, |alpha, cos| table.at(alpha, cos)).max_abs_err;
            assert!(error < 0.05, "{}: {error:e}", preset.name);
        }
        assert!(Preset::ALL.is_sorted_by_key(|preset| preset.name));
    }

    /// Texels of the table that Babylon.js 9.35.0 ships, as its own decoding reads them: bytes of 8 bits, sampled, and half a texel off at places.
    #[test]
    fn babylon_ships_this_table() {
        let texels = Preset::named("babylon").unwrap().table().bake();
        for (x, y, expected) in [
            (64, 64, [0.1975, 0.9574, 0.3941]),
            (64, 128, [0.0781, 0.8355, 0.4313]),
            (128, 128, [0.0220, 0.8513, 0.2310]),
            (255, 128, [0.0, 0.9075, 0.0329]),
            (64, 200, [0.0242, 0.7227, 0.4045]),
            (255, 255, [0.0, 0.3066, 0.1420]),
        ] {
            for (found, expected) in texels.texel(x, y).iter().zip(expected) {
                assert!((f64::from(*found) - expected).abs() < 0.02, "{x} {y}: {found} {expected}");
            }
        }
    }
}
