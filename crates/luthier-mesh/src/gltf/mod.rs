//! glTF 2.0 files, text or binary.

mod accessor;
mod asset;
mod buffers;
mod container;
mod document;
mod extensions;
mod materials;
mod reader;
mod turn;

use std::io;

pub use self::asset::{Asset, PICTURE_BYTES_MAX};
use self::buffers::Buffers;
use self::document::Document;
pub use self::reader::File;
use self::reader::Reader;
use crate::error::MeshError;

/// The triangles of the default scene of a glTF 2.0 file, binary or text. `files` reads buffers beside the file by
/// their relative paths.
///
/// Missing normals are the normals of the triangles. Materials do not count, except that parts with a material named
/// `plain` keep its base colour. Only the data of triangles is read: the rest of the file may be anything.
///
/// # Errors
/// [`MeshError`] for bytes that are not glTF, unsupported required extensions, unreadable buffers, numbers that do not
/// fit, and more than [`TRIANGLES_MAX`](crate::TRIANGLES_MAX) triangles.
pub fn soup(bytes: &[u8], files: &dyn Fn(&str) -> io::Result<Vec<u8>>) -> Result<File, MeshError> {
    read(bytes, files, false)
}

/// The triangles of a file as [`soup`] reads them, each with the number of its material in the file ([`Triangle::material`](crate::Triangle::material)). Triangles without one have the number of materials. No
/// part is plain, and texture coordinates are as they are stored: placements are those of the maps.
///
/// # Errors
/// As [`soup`].
pub fn scene(bytes: &[u8], files: &dyn Fn(&str) -> io::Result<Vec<u8>>) -> Result<File, MeshError> {
    read(bytes, files, true)
}

fn read(bytes: &[u8], files: &dyn Fn(&str) -> io::Result<Vec<u8>>, keeps_materials: bool) -> Result<File, MeshError> {
    let container = container::split(bytes)?;
    let document = Document::parse(container.json)?;
    let passed_over = extensions::passed_over(&document)?;
    let buffers = Buffers::new(&document, container.blob, files);
    let mut reader = Reader::new(&document, &buffers, keeps_materials);
    for name in passed_over {
        reader.leave_out(format!("the extension {name}"));
    }
    if !document.animations.is_empty() {
        reader.leave_out("animations");
    }
    reader.scene()?;
    Ok(reader.finish())
}
