//! Materials as glTF 2.0 writes them, with defaults of the specification.

use std::collections::BTreeMap;

use serde::Deserialize;
use serde_json::Value;

/// Members by name that the specification of a structure does not have.
pub(super) type Unknown = BTreeMap<String, Value>;

#[derive(Debug, Default, Deserialize)]
#[serde(default, rename_all = "camelCase")]
pub(super) struct Material {
    pub(super) name: Option<String>,
    pub(super) pbr_metallic_roughness: Metallic,
    pub(super) normal_texture: Option<Texture>,
    pub(super) occlusion_texture: Option<Texture>,
    pub(super) emissive_texture: Option<Texture>,
    pub(super) emissive_factor: [f64; 3],
    pub(super) alpha_mode: Option<String>,
    pub(super) double_sided: bool,
    pub(super) extensions: Extensions,
    /// Members that are not known.
    #[serde(flatten)]
    pub(super) unknown: Unknown,
}

#[derive(Debug, Deserialize)]
#[serde(default, rename_all = "camelCase")]
pub(super) struct Metallic {
    pub(super) base_color_factor: [f64; 4],
    pub(super) base_color_texture: Option<Texture>,
    pub(super) metallic_factor: f64,
    pub(super) roughness_factor: f64,
    pub(super) metallic_roughness_texture: Option<Texture>,
    /// Members that are not known.
    #[serde(flatten)]
    pub(super) unknown: Unknown,
}

impl Default for Metallic {
    fn default() -> Self {
        Self {
            base_color_factor: [1.0; 4],
            base_color_texture: None,
            metallic_factor: 1.0,
            roughness_factor: 1.0,
            metallic_roughness_texture: None,
            unknown: Unknown::new(),
        }
    }
}

#[derive(Debug, Clone, Default, PartialEq, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct Texture {
    pub(super) index: usize,
    #[serde(default)]
    pub(super) tex_coord: u32,
    /// Of normals.
    #[serde(default)]
    pub(super) scale: Option<f64>,
    #[serde(default)]
    pub(super) extensions: TextureExtensions,
}

#[derive(Debug, Clone, Default, PartialEq, Deserialize)]
#[serde(default)]
pub(super) struct TextureExtensions {
    #[serde(rename = "KHR_texture_transform")]
    pub(super) transform: Option<Transform>,
    #[serde(flatten)]
    pub(super) unknown: Unknown,
}

#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(default, rename_all = "camelCase")]
pub(super) struct Transform {
    pub(super) offset: [f64; 2],
    pub(super) rotation: f64,
    pub(super) scale: [f64; 2],
    pub(super) tex_coord: Option<u32>,
}

impl Default for Transform {
    fn default() -> Self {
        Self { offset: [0.0; 2], rotation: 0.0, scale: [1.0; 2], tex_coord: None }
    }
}

#[derive(Debug, Default, Deserialize)]
#[serde(default)]
pub(super) struct Extensions {
    #[serde(rename = "KHR_materials_clearcoat")]
    pub(super) clearcoat: Option<Clearcoat>,
    #[serde(rename = "KHR_materials_ior")]
    pub(super) ior: Option<Ior>,
    #[serde(rename = "KHR_materials_specular")]
    pub(super) specular: Option<Specular>,
    #[serde(rename = "KHR_materials_anisotropy")]
    pub(super) anisotropy: Option<Anisotropy>,
    #[serde(rename = "KHR_materials_iridescence")]
    pub(super) iridescence: Option<Iridescence>,
    #[serde(rename = "KHR_materials_transmission")]
    pub(super) transmission: Option<Transmission>,
    #[serde(flatten)]
    pub(super) others: Unknown,
}

/// The first member that should be an object, and is none; serde reads arrays as structures, too.
pub(super) fn misplaced(value: &Value) -> Option<&str> {
    let members = value.as_object()?;
    members.iter().find_map(|(name, member)| {
        let wants_object = name.ends_with("Texture")
            || ["KHR_", "EXT_"].iter().any(|beginning| name.starts_with(beginning))
            || ["extensions", "pbrMetallicRoughness"].contains(&name.as_str());
        if wants_object && !member.is_object() { Some(name.as_str()) } else { misplaced(member) }
    })
}

#[derive(Debug, Default, Deserialize)]
#[serde(default, rename_all = "camelCase")]
pub(super) struct Clearcoat {
    pub(super) clearcoat_factor: f64,
    pub(super) clearcoat_texture: Option<Texture>,
    pub(super) clearcoat_roughness_factor: f64,
    pub(super) clearcoat_roughness_texture: Option<Texture>,
    pub(super) clearcoat_normal_texture: Option<Texture>,
    /// Members that are not known.
    #[serde(flatten)]
    pub(super) unknown: Unknown,
}

#[derive(Debug, Deserialize)]
#[serde(default)]
pub(super) struct Ior {
    pub(super) ior: f64,
    /// Members that are not known.
    #[serde(flatten)]
    pub(super) unknown: Unknown,
}

impl Default for Ior {
    fn default() -> Self {
        Self { ior: 1.5, unknown: Unknown::new() }
    }
}

#[derive(Debug, Clone, Deserialize)]
#[serde(default, rename_all = "camelCase")]
pub(super) struct Specular {
    pub(super) specular_factor: f64,
    pub(super) specular_texture: Option<Texture>,
    pub(super) specular_color_factor: [f64; 3],
    pub(super) specular_color_texture: Option<Texture>,
    /// Members that are not known.
    #[serde(flatten)]
    pub(super) unknown: Unknown,
}

impl Default for Specular {
    fn default() -> Self {
        Self {
            specular_factor: 1.0,
            specular_texture: None,
            specular_color_factor: [1.0; 3],
            specular_color_texture: None,
            unknown: Unknown::new(),
        }
    }
}

#[derive(Debug, Default, Deserialize)]
#[serde(default, rename_all = "camelCase")]
pub(super) struct Anisotropy {
    pub(super) anisotropy_strength: f64,
    pub(super) anisotropy_rotation: f64,
    pub(super) anisotropy_texture: Option<Texture>,
    /// Members that are not known.
    #[serde(flatten)]
    pub(super) unknown: Unknown,
}

#[derive(Debug, Deserialize)]
#[serde(default, rename_all = "camelCase")]
pub(super) struct Iridescence {
    pub(super) iridescence_factor: f64,
    pub(super) iridescence_texture: Option<Texture>,
    pub(super) iridescence_ior: f64,
    pub(super) iridescence_thickness_minimum: f64,
    pub(super) iridescence_thickness_maximum: f64,
    pub(super) iridescence_thickness_texture: Option<Texture>,
    /// Members that are not known.
    #[serde(flatten)]
    pub(super) unknown: Unknown,
}

impl Default for Iridescence {
    fn default() -> Self {
        Self {
            iridescence_factor: 0.0,
            iridescence_texture: None,
            iridescence_ior: 1.3,
            iridescence_thickness_minimum: 100.0,
            iridescence_thickness_maximum: 400.0,
            iridescence_thickness_texture: None,
            unknown: Unknown::new(),
        }
    }
}

#[derive(Debug, Default, Deserialize)]
#[serde(default, rename_all = "camelCase")]
pub(super) struct Transmission {
    pub(super) transmission_factor: f64,
    /// Members that are not known.
    #[serde(flatten)]
    pub(super) unknown: Unknown,
}
