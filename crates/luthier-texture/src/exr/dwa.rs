//! Check of the chunks of the compressions DWAA and DWAB, which state how many values they hold. The `exr` crate
//! allocates memory for as many before it looks for them, so a file of a kilobyte could end the program. The statements
//! are therefore compared with the size of the chunk first.

use std::io::Cursor;

use ::exr::block;
use ::exr::block::chunk::{CompressedBlock, CompressedScanLineBlock, CompressedTileBlock};
use ::exr::meta::attribute::Compression;
use ::exr::meta::header::Header;

use super::{malformed, read_error};
use crate::TextureError;

/// Side of the blocks of the transform.
const BLOCK: usize = 8;

/// Checks all chunks of a file with checked sizes. Files of other compressions pass unread.
///
/// # Errors
/// [`TextureError::Malformed`] for a chunk that states too many values, [`TextureError::ExrDecode`] for a file that is
/// cut off.
pub(crate) fn check(file: &[u8]) -> Result<(), TextureError> {
    let reader = block::read(Cursor::new(file), false).map_err(read_error)?;
    if !reader.headers().iter().any(is_dwa) {
        return Ok(());
    }
    let headers = reader.headers().to_vec();
    for chunk in reader.filter_chunks(false, |_, _, _| true).map_err(read_error)? {
        let chunk = chunk.map_err(read_error)?;
        let header = headers.get(chunk.layer_index).ok_or_else(|| malformed("a chunk is of no part"))?;
        let (CompressedBlock::ScanLine(CompressedScanLineBlock { compressed_pixels_le: bytes, .. })
        | CompressedBlock::Tile(CompressedTileBlock { compressed_pixels_le: bytes, .. })) = &chunk.compressed_block
        else {
            continue;
        };
        if !is_dwa(header) {
            continue;
        }
        let place = header.get_block_data_indices(&chunk.compressed_block).map_err(read_error)?;
        let part = header.get_absolute_block_pixel_coordinates(place).map_err(read_error)?;
        part.validate(Some(header.layer_size)).map_err(read_error)?;
        // A chunk as long as its pixels stores them uncompressed.
        if bytes.len() != part.size.area() * header.channels.bytes_per_pixel
            && !is_plausible(bytes, header, part.size.0, part.size.1)
        {
            return Err(malformed("a chunk states more values than it has pixels for"));
        }
    }
    Ok(())
}

fn is_dwa(header: &Header) -> bool {
    matches!(header.compression, Compression::DWAA(_) | Compression::DWAB(_))
}

/// Whether the counters in front of a chunk fit its pixels. Of eleven words of 64 bits they are the second and the
/// seventh to the tenth (OpenEXR, `internal_dwa_compressor.h`).
fn is_plausible(bytes: &[u8], header: &Header, width: usize, height: usize) -> bool {
    let values = (width.next_multiple_of(BLOCK) * height.next_multiple_of(BLOCK) * header.channels.list.len()) as u64;
    let counters: Vec<u64> = bytes.as_chunks().0.iter().take(11).map(|word| u64::from_le_bytes(*word)).collect();
    let [_, unknown, _, _, _, _, runs, raw, ac, dc, _] = counters[..] else { return true };
    // Up to four bytes a value; runs that repeat nothing take up to twice what they stand for.
    unknown <= 4 * values && raw <= 4 * values && runs <= 8 * values && ac <= values && dc <= values
}
