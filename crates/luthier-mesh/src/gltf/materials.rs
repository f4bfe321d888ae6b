//! Materials of a glTF file: the colour of plain parts, and placements of textures.

use serde_json::Value;

use crate::MeshError;

/// Name of materials with parts that keep their own colour.
const PLAIN: &str = "plain";

/// Textures of a material.
const TEXTURES: [&str; 5] = [
    "/pbrMetallicRoughness/baseColorTexture",
    "/normalTexture",
    "/pbrMetallicRoughness/metallicRoughnessTexture",
    "/occlusionTexture",
    "/emissiveTexture",
];

/// The base colour of a plain material; `None` for others.
pub(super) fn plain_color(material: Option<&Value>) -> Result<Option<[f32; 3]>, MeshError> {
    let Some(material) = material.filter(|material| material["name"] == PLAIN) else { return Ok(None) };
    let factor = match material.pointer("/pbrMetallicRoughness/baseColorFactor") {
        None => [1.0; 4],
        Some(factor) => <[f32; 4] as serde::Deserialize>::deserialize(factor)
            .map_err(|_| MeshError::Gltf(format!("baseColorFactor of the material `{PLAIN}` is not four numbers")))?,
    };
    let [r, g, b, _] = factor;
    Ok(Some([r, g, b].map(|v| v.clamp(0.0, 1.0))))
}

/// Placement of a texture over texture coordinates, `KHR_texture_transform`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Placement {
    offset: [f64; 2],
    rotation: f64,
    scale: [f64; 2],
}

impl Placement {
    /// The placement of the first placed texture of a material.
    pub(super) fn of(material: &Value) -> Option<Self> {
        let mut places = TEXTURES.iter().map(|texture| format!("{texture}/extensions/KHR_texture_transform"));
        let placed = places.find_map(|place| material.pointer(&place))?;
        let [offset, scale] =
            ["offset", "scale"].map(|name| <[f64; 2] as serde::Deserialize>::deserialize(&placed[name]).ok());
        Some(Self {
            offset: offset.unwrap_or([0.0; 2]),
            rotation: placed["rotation"].as_f64().unwrap_or(0.0),
            scale: scale.unwrap_or([1.0; 2]),
        })
    }

    /// Texture coordinates scaled, turned and moved, in this order.
    pub(super) fn of_uv(&self, uv: [f32; 2]) -> [f32; 2] {
        let [u, v] = [0, 1].map(|i| self.scale[i] * f64::from(uv[i]));
        let (sin, cos) = (libm::sin(self.rotation), libm::cos(self.rotation));
        [(cos * u + sin * v + self.offset[0]) as f32, (cos * v - sin * u + self.offset[1]) as f32]
    }
}
