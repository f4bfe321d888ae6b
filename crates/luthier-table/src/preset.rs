//! Split-sum tables as engines have them.

use luthier_optics::split_sum::Masking;
use luthier_optics::stack::Distribution;

use crate::{DfgTable, Layout, Nodes, Stored, Value};

/// Container in which an engine takes its table.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Container {
    /// KTX2.
    Ktx2,
    /// PNG of 8 bits.
    Png,
    /// Texels and nothing else, little-endian, rows from the top.
    Raw,
    /// A JavaScript module that exports the words of half floats as `DFG_LUT_DATA`.
    JavaScript,
}

/// The split-sum table of an engine.
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
    /// How the table reaches the engine; none where a channel holds more than a split sum.
    pub container: Option<Container>,
    /// Where the layout was read.
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
            values: &[Value::Bias, Value::Albedo],
            size: [256, 256],
            stored: Stored::Unorm8,
            container: None,
            source: "npm @babylonjs/core 9.35.0: environmentBRDFTexture; RGBD, so that rgb = pow(c, 2.2) / a",
        },
        Self {
            name: "bevy",
            masking: Masking::SmithCorrelated,
            axes: "cos_theta,roughness",
            nodes: Nodes::CENTRES,
            values: &[Value::Scale, Value::Bias],
            size: [64, 64],
            stored: Stored::Half,
            container: Some(Container::Ktx2),
            source: "bevyengine/bevy: the resource DfgLut of bevy_pbr, dfg.ktx2",
        },
        Self {
            name: "filament",
            masking: Masking::SmithCorrelated,
            axes: "cos_theta,-roughness",
            nodes: Nodes::CENTRES,
            values: &[Value::Bias, Value::Albedo],
            size: [128, 128],
            stored: Stored::Half,
            container: None,
            source: "google/filament, libs/ibl/src/CubemapIBL.cpp: DFG, DFV_Multiscatter",
        },
        Self {
            name: "gltf",
            masking: Masking::SmithCorrelated,
            axes: "cos_theta,roughness",
            nodes: Nodes::CENTRES,
            values: &[Value::Scale, Value::Bias, Value::Zero],
            size: [1024, 1024],
            stored: Stored::Unorm8,
            container: Some(Container::Png),
            source: "KhronosGroup/glTF-IBL-Sampler, lib/source/shaders/filter.frag: LUT; lut_ggx.png of glTF-Sample-Viewer",
        },
        Self {
            name: "godot",
            masking: Masking::SchlickHalf,
            axes: "cos_theta,-roughness",
            nodes: Nodes::CENTRES,
            values: &[Value::Bias, Value::Albedo],
            size: [128, 128],
            stored: Stored::Half,
            container: None,
            source: "godotengine/godot, servers/rendering/renderer_rd/shaders/forward_clustered/integrate_dfg.glsl",
        },
        Self {
            name: "hdrp",
            masking: Masking::SmithCorrelated,
            axes: "sqrt_cos_theta,roughness",
            nodes: Nodes::Ends,
            values: &[Value::Bias, Value::Albedo],
            size: [64, 64],
            stored: Stored::Unorm10,
            container: None,
            source: "Unity-Technologies/Graphics, preIntegratedFGD_GGXDisneyDiffuse.shader",
        },
        Self {
            name: "three",
            masking: Masking::SmithCorrelated,
            axes: "roughness,cos_theta",
            nodes: Nodes::CENTRES,
            values: &[Value::Scale, Value::Bias],
            size: [16, 16],
            stored: Stored::Half,
            container: Some(Container::JavaScript),
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
            container: Some(Container::Raw),
            source: "Unreal Engine 4, SystemTextures.cpp: PreintegratedGF, Vis_SmithJointApprox; the idea in Karis 2013",
        },
    ];

    /// The preset of a name.
    pub fn named(name: &str) -> Option<&'static Self> {
        Self::ALL.iter().find(|preset| preset.name == name)
    }

    /// The table that the engine would read.
    pub fn table(&self) -> DfgTable {
        DfgTable {
            distribution: Distribution::Ggx,
            masking: self.masking,
            layout: Layout::parse(self.axes, self.nodes).unwrap_or_else(|error| unreachable!("{error}")),
            values: self.values.to_vec(),
            size: self.size,
            stored: self.stored,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_preset_bakes() {
        for preset in Preset::ALL.iter().filter(|preset| preset.size[0] <= 128) {
            let table = preset.table();
            let texels = table.bake();
            assert_eq!([texels.width, texels.height], preset.size, "{}", preset.name);
            // Engines' axes are linear: what they miss at grazing angles on smooth surfaces is theirs.
            let error = table.error(&texels, 0.1, 0.1).max_abs_err;
            assert!(error < 0.05, "{}: {error:e}", preset.name);
        }
        assert!(Preset::ALL.is_sorted_by_key(|preset| preset.name));
    }
}
