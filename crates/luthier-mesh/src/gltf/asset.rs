//! The whole text of a glTF file, and the bytes of its pictures.

use std::io;

use serde_json::Value;

use super::buffers::{Buffers, of_uri, shortened};
use super::container;
use super::document::Document;
use crate::MeshError;

/// Most bytes of one picture as it is stored.
pub const PICTURE_BYTES_MAX: usize = 256 << 20;

/// A glTF file, whatever it holds.
///
/// ```
/// use luthier_mesh::Asset;
///
/// let text = br#"{"asset": {"version": "2.0"}, "images": [{"uri": "data:,abc"}], "materials": [{"name": "clay"}]}"#;
/// let none = |_: &str| Err(std::io::ErrorKind::NotFound.into());
/// let asset = Asset::open(text, &none).unwrap();
/// assert_eq!(asset.json["materials"][0]["name"], "clay");
/// assert_eq!(asset.picture(0).unwrap(), b"abc");
/// assert!(asset.picture(1).is_err());
/// ```
pub struct Asset<'a> {
    /// The text.
    pub json: Value,
    /// The text as it stands in the file, for the lines of mistakes.
    pub text: &'a [u8],
    document: Document,
    blob: Option<&'a [u8]>,
    files: &'a dyn Fn(&str) -> io::Result<Vec<u8>>,
}

impl<'a> Asset<'a> {
    /// Opens a file, binary or text. `files` reads what lies beside it by relative paths; paths that leave its folder are refused.
    ///
    /// # Errors
    /// [`MeshError::Gltf`] and [`MeshError::Version`].
    pub fn open(bytes: &'a [u8], files: &'a dyn Fn(&str) -> io::Result<Vec<u8>>) -> Result<Self, MeshError> {
        let container = container::split(bytes)?;
        let document = Document::parse(container.json)?;
        let json = serde_json::from_slice(container.json).map_err(|error| MeshError::Gltf(error.to_string()))?;
        Ok(Self { json, text: container.json, document, blob: container.blob, files })
    }

    /// The name of a picture: its own, or that of its file; `None` for pictures without either.
    pub fn picture_name(&self, number: usize) -> Option<&str> {
        let image = &self.json["images"][number];
        let of_uri = || image["uri"].as_str().filter(|uri| !uri.starts_with("data:"));
        let name = image["name"].as_str().filter(|name| !name.is_empty()).or_else(of_uri)?;
        let last = name.rsplit(['/', '\\']).next()?;
        Some(last.rsplit_once('.').map_or(last, |(stem, _)| stem))
    }

    /// The bytes of a picture, as they are stored.
    ///
    /// # Errors
    /// [`MeshError::Buffer`], with the reason.
    pub fn picture(&self, number: usize) -> Result<Vec<u8>, MeshError> {
        let image = &self.json["images"][number];
        let fail = |reason: &str| MeshError::Buffer { uri: format!("of picture {number}"), reason: reason.to_owned() };
        let bytes = match (image["uri"].as_str(), image["bufferView"].as_u64()) {
            (Some(uri), _) => {
                of_uri(uri, self.files).map_err(|reason| MeshError::Buffer { uri: shortened(uri), reason })?
            }
            (None, Some(view)) => {
                let view = self.document.buffer_views.get(view as usize).ok_or_else(|| fail("no such buffer view"))?;
                let buffers = Buffers::new(&self.document, self.blob, self.files);
                let bytes = buffers.get(view.buffer)?.ok_or_else(|| fail("no such buffer"))?;
                let end = view.byte_offset.checked_add(view.byte_length);
                let held = end.and_then(|end| bytes.get(view.byte_offset..end));
                held.ok_or_else(|| fail("its buffer view ends behind its buffer"))?.to_vec()
            }
            (None, None) => return Err(fail("the file does not say where its bytes are")),
        };
        if bytes.len() > PICTURE_BYTES_MAX {
            return Err(fail(&format!("it takes more than {} MiB", PICTURE_BYTES_MAX >> 20)));
        }
        Ok(bytes)
    }
}
