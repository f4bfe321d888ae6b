//! OpenEXR: single-part scan-line images of 32-bit floats, ZIP-compressed (lossless).
//!
//! Written here rather than through the `exr` crate, which keeps custom attributes in a hash map and so writes them in
//! another order each time, and which allocates by the header when it reads. That crate is the oracle of the tests.
//! Layout: "OpenEXR File Layout", openexr.com, version 2.

mod blocks;
mod header;

use luthier_lut::Image;

use crate::error::Container;
use crate::limits::{check_image, checked_bytes};
use crate::{Metadata, TextureError, metadata};
use blocks::{Compression, ImageShape};
use header::Header;

/// What the names of metadata attributes begin with.
const PREFIX: &str = "luthier.";

/// An EXR file of an image, bit-exact. Channels are named by their count: Y; Y, A; R, G, B; R, G, B, A. Metadata become
/// string attributes named `luthier.` and the key, in the given order.
///
/// # Errors
/// [`TextureError::Size`], [`TextureError::Channels`], [`TextureError::Length`], [`TextureError::Metadata`].
pub fn encode(image: &Image, metadata: &Metadata) -> Result<Vec<u8>, TextureError> {
    check_image(image)?;
    metadata::check(metadata)?;
    let shape = ImageShape { width: image.width, height: image.height, channels: image.channels };
    let mut file = header::write(shape, Compression::Zip, metadata);

    let blocks = blocks::compress(image, shape);
    let mut offset = (file.len() + 8 * blocks.len()) as u64;
    for block in &blocks {
        file.extend_from_slice(&offset.to_le_bytes());
        offset += block.len() as u64;
    }
    file.extend(blocks.into_iter().flatten());
    Ok(file)
}

/// Reads an EXR file of the shape that [`encode`] writes: one part, scan lines, 32-bit float channels named as there,
/// uncompressed or ZIP. Attributes of other makers are left out of the metadata.
///
/// # Errors
/// [`TextureError::Malformed`] for damaged files, [`TextureError::Unsupported`] for other shapes,
/// [`TextureError::Size`].
pub fn decode(file: &[u8]) -> Result<(Image, Metadata), TextureError> {
    let (Header { shape, top, compression, channel_order, metadata }, after_header) = header::read(file)?;
    let ImageShape { width, height, channels } = shape;
    let values = checked_bytes(width, height, 4 * channels)? / 4;

    let count = height.div_ceil(compression.lines()) as usize;
    let table = after_header.get(..8 * count).ok_or_else(|| malformed("it ends within the offset table"))?;
    let mut data = Vec::new();
    for (i, offset) in table.chunks_exact(8).enumerate() {
        let offset = offset.iter().rev().fold(0, |sum, &byte| sum << 8 | u64::from(byte));
        let block = usize::try_from(offset).ok().and_then(|start| file.get(start..));
        let block = block.ok_or_else(|| malformed("a block lies outside the file"))?;
        let first_row = i as u32 * compression.lines();
        let rows = compression.lines().min(height - first_row);
        let part = ImageShape { height: rows, ..shape };
        blocks::decompress(block, part, i64::from(top) + i64::from(first_row), compression, &channel_order, &mut data)?;
    }
    debug_assert_eq!(data.len(), values);
    Ok((Image { width, height, channels, data }, metadata))
}

fn malformed(reason: &'static str) -> TextureError {
    TextureError::malformed(Container::Exr, reason)
}

fn unsupported(what: &'static str) -> TextureError {
    TextureError::unsupported(Container::Exr, what)
}

#[cfg(test)]
mod tests;
