//! Maps of materials: the quantity that each varies, and the layer.

use luthier_model::Feature;
use serde::{Deserialize, Serialize};

use crate::file::FileEntry;

luthier_lut::named! {
    /// Quantity that a map varies.
    #[derive(Serialize, Deserialize)]
    #[serde(into = "&'static str", try_from = "String")]
    pub enum MapSlot("map") {
        /// Tangent-space normal: RGB is (normal + 1) / 2.
        Normal = "normal",
        /// Factor on the roughness: on the slope parameters its square.
        Roughness = "roughness",
        /// Factor on the thickness of the slab below the layer.
        Thickness = "thickness",
        /// Factor on what the slab below the layer absorbs, RGB.
        Absorption = "absorption",
        /// Factor on the weight of the first layer, a coat.
        Weight = "weight",
        /// Order in which patina develops; dark places come first.
        Patina = "patina",
        /// Normals of flakes, RGB as for [`MapSlot::Normal`], to be read without filtering.
        FlakeNormal = "flake-normal",
        /// Tangent-space normal of the interface of one layer alone, RGB as for [`MapSlot::Normal`].
        Bumps = "bumps",
        /// Factor on the slope parameters of one layer.
        Alpha = "alpha",
        /// Factor on the slope parameter of one layer along its tangent.
        AlphaX = "alpha-x",
        /// Factor on the slope parameter of one layer along its bitangent.
        AlphaY = "alpha-y",
        /// Direction of the tangent of one layer: 2 RG - 1 is the cosine and the sine of twice the angle from the surface's tangent.
        Tangent = "tangent",
        /// Factor on the albedo of a diffuse base, RGB.
        Albedo = "albedo",
        /// Factor on the base colour of a metallic-roughness surface, RGB.
        BaseColor = "base-color",
        /// Factor on how metallic such a surface is.
        Metallic = "metallic",
        /// Factor on the F0 of the dielectric above a diffuse base, RGB.
        F0 = "f0",
        /// Tangent-space normal of the inner boundary of the film or slab, RGB as for [`MapSlot::Normal`].
        Lean = "lean",
    }
}

/// A map of a material: PNG, values in 0..=1, which repeats in both texture coordinates. Texel centres are at
/// (i + 1/2) / size, the first row is at v = 0. Values are linear, unless `srgb` says otherwise.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct MapEntry {
    /// Quantity that the map varies.
    pub slot: MapSlot,
    /// Number of the layer from the top; null for maps of the whole surface.
    pub layer: Option<u32>,
    /// Origin: the path in the material file, or a noise.
    pub source: String,
    /// The file.
    pub file: FileEntry,
    /// Texels across.
    pub width: u32,
    /// Texels down.
    pub height: u32,
    /// Number of the material file that the texels multiply, of maps of a colour or of metal: one number three times, or RGB.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub factor: Option<[f64; 3]>,
    /// Whether R, G and B are stored by the sRGB curve: a texture of the format `rgba8unorm-srgb` reads them. Absent where they are linear.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub srgb: bool,
    /// The two rows that make the map's texture coordinates of (u, v, 1). Absent where these are the surface's.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub transform: Option<[[f64; 3]; 2]>,
}

impl MapSlot {
    /// The feature of a map of one layer; `None` for maps of the whole surface.
    pub fn layer_feature(self, layer: u32) -> Option<Feature> {
        match self {
            Self::Bumps => Some(Feature::Bumps),
            Self::Alpha | Self::AlphaX | Self::AlphaY => Some(Feature::LayerAlpha),
            Self::Tangent => Some(Feature::Tangents),
            Self::Albedo => Some(Feature::AlbedoMap),
            Self::BaseColor | Self::Metallic | Self::F0 => Some(Feature::MetallicMap),
            Self::Lean => Some(Feature::LeanMap),
            Self::Thickness => (layer > 0).then_some(Feature::InnerThickness),
            Self::Absorption if layer > 0 => Some(Feature::InnerAbsorptionMap),
            Self::Absorption => Some(Feature::AbsorptionMap),
            Self::Normal | Self::Roughness | Self::Weight | Self::Patina | Self::FlakeNormal => None,
        }
    }

    /// Whether a map of a layer is a value of `LuthierLayerPlace`; the albedo of a base and a lean are values of the whole `LuthierPlace`.
    pub fn is_of_layer_place(self, layer: u32) -> bool {
        self.layer_feature(layer).is_some() && !matches!(self, Self::Albedo | Self::Lean)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Maps are files called `{material}-{slot}`, and those of a layer have its number behind: no end of a slot's name is the name of another with the same
    /// end of the file.
    #[test]
    fn names_of_maps_are_told_apart() {
        let has_layer = |slot| !matches!(slot, MapSlot::FlakeNormal | MapSlot::Patina);
        for a in MapSlot::ALL {
            for b in MapSlot::ALL.into_iter().filter(|&b| has_layer(b) == has_layer(a)) {
                assert!(!a.name().ends_with(&format!("-{}", b.name())), "{} {}", a.name(), b.name());
            }
        }
    }
}
