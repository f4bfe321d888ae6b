//! The text of a glTF 2.0 file, as far as luthier reads it: meshes, the nodes that hold them, and their numbers. All
//! else is skipped, whatever it is.

use std::collections::BTreeMap;

use serde::Deserialize;
use serde::de::IgnoredAny;
use serde_json::Value;

use crate::MeshError;

/// Names of extensions.
pub(super) type Extensions = BTreeMap<String, IgnoredAny>;

#[derive(Debug, Default, Deserialize)]
#[serde(default, rename_all = "camelCase")]
pub(super) struct Document {
    pub(super) extensions_required: Vec<String>,
    pub(super) scene: Option<usize>,
    pub(super) scenes: Vec<Scene>,
    pub(super) nodes: Vec<Node>,
    pub(super) meshes: Vec<Mesh>,
    pub(super) materials: Vec<Value>,
    pub(super) accessors: Vec<Accessor>,
    pub(super) buffer_views: Vec<View>,
    pub(super) buffers: Vec<Buffer>,
    pub(super) animations: Vec<IgnoredAny>,
}

#[derive(Debug, Default, Deserialize)]
#[serde(default)]
pub(super) struct Scene {
    pub(super) nodes: Vec<usize>,
}

#[derive(Debug, Default, Deserialize)]
#[serde(default)]
pub(super) struct Node {
    pub(super) mesh: Option<usize>,
    pub(super) skin: Option<IgnoredAny>,
    pub(super) children: Vec<usize>,
    pub(super) matrix: Option<[f64; 16]>,
    pub(super) translation: Option<[f64; 3]>,
    pub(super) rotation: Option<[f64; 4]>,
    pub(super) scale: Option<[f64; 3]>,
    pub(super) extensions: Extensions,
}

#[derive(Debug, Default, Deserialize)]
#[serde(default)]
pub(super) struct Mesh {
    pub(super) name: Option<String>,
    pub(super) primitives: Vec<Primitive>,
}

#[derive(Debug, Default, Deserialize)]
#[serde(default)]
pub(super) struct Primitive {
    pub(super) attributes: Attributes,
    pub(super) indices: Option<usize>,
    pub(super) material: Option<usize>,
    pub(super) mode: Option<u32>,
    pub(super) targets: Vec<IgnoredAny>,
    pub(super) extensions: Extensions,
}

/// Accessors by their content; other names are skipped.
#[derive(Debug, Default, Deserialize)]
#[serde(default)]
pub(super) struct Attributes {
    #[serde(rename = "POSITION")]
    pub(super) positions: Option<usize>,
    #[serde(rename = "NORMAL")]
    pub(super) normals: Option<usize>,
    #[serde(rename = "TANGENT")]
    pub(super) tangents: Option<usize>,
    #[serde(rename = "TEXCOORD_0")]
    pub(super) uvs: Option<usize>,
}

#[derive(Debug, Default, Deserialize)]
#[serde(default, rename_all = "camelCase")]
pub(super) struct Accessor {
    pub(super) buffer_view: Option<usize>,
    pub(super) byte_offset: usize,
    pub(super) component_type: u32,
    pub(super) normalized: bool,
    pub(super) count: usize,
    #[serde(rename = "type")]
    pub(super) shape: String,
    pub(super) sparse: Option<Sparse>,
}

/// Elements that differ from those of the buffer view.
#[derive(Debug, Default, Deserialize)]
#[serde(default)]
pub(super) struct Sparse {
    pub(super) count: usize,
    pub(super) indices: Packed,
    pub(super) values: Packed,
}

#[derive(Debug, Default, Deserialize)]
#[serde(default, rename_all = "camelCase")]
pub(super) struct Packed {
    pub(super) buffer_view: usize,
    pub(super) byte_offset: usize,
    pub(super) component_type: u32,
}

#[derive(Debug, Default, Deserialize)]
#[serde(default, rename_all = "camelCase")]
pub(super) struct View {
    pub(super) buffer: usize,
    pub(super) byte_offset: usize,
    pub(super) byte_length: usize,
    pub(super) byte_stride: Option<usize>,
}

#[derive(Debug, Default, Deserialize)]
#[serde(default, rename_all = "camelCase")]
pub(super) struct Buffer {
    pub(super) uri: Option<String>,
    pub(super) byte_length: usize,
    pub(super) extensions: Extensions,
}

/// The version of a text.
#[derive(Debug, Deserialize)]
struct Heading {
    asset: Option<Asset>,
}

#[derive(Debug, Default, Deserialize)]
#[serde(default, rename_all = "camelCase")]
struct Asset {
    version: Value,
    min_version: Value,
}

impl Document {
    /// # Errors
    /// [`MeshError::Version`] for versions other than 2, [`MeshError::Gltf`] for text that is no glTF.
    pub(super) fn parse(json: &[u8]) -> Result<Self, MeshError> {
        let heading: Heading = serde_json::from_slice(json).map_err(|error| invalid(&error))?;
        let Asset { version, min_version } = heading.asset.unwrap_or_default();
        if version.is_null() {
            return Err(MeshError::Gltf("it does not state its version (asset.version)".to_owned()));
        }
        if said(&version).split('.').next() != Some("2") {
            return Err(MeshError::Version(said(&version)));
        }
        if !min_version.is_null() && said(&min_version) != "2.0" {
            return Err(MeshError::Version(said(&min_version)));
        }
        serde_json::from_slice(json).map_err(|error| invalid(&error))
    }
}

fn invalid(error: &serde_json::Error) -> MeshError {
    MeshError::Gltf(error.to_string())
}

/// A string without quotes, another value as JSON.
fn said(value: &Value) -> String {
    value.as_str().map_or_else(|| value.to_string(), str::to_owned)
}
