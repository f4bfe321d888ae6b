use luthier_lut::Image;
use miniz_oxide::deflate::compress_to_vec_zlib;
use miniz_oxide::inflate::decompress_to_vec_zlib_with_limit;

use super::header::file_order;
use super::{malformed, unsupported};
use crate::TextureError;

/// zlib effort. Above 6 the tables shrink by less than 1 %.
const ZLIB_LEVEL: u8 = 6;

/// Size of an image or of a block of its rows.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct ImageShape {
    pub(super) width: u32,
    pub(super) height: u32,
    pub(super) channels: u32,
}

/// The compressions that are read.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Compression {
    None,
    /// zlib over single rows.
    ZipSingle,
    /// zlib over 16 rows.
    Zip,
}

impl Compression {
    pub(super) fn code(self) -> u8 {
        match self {
            Self::None => 0,
            Self::ZipSingle => 2,
            Self::Zip => 3,
        }
    }

    pub(super) fn from_code(value: &[u8]) -> Result<Self, TextureError> {
        let known = [Self::None, Self::ZipSingle, Self::Zip];
        let found = known.into_iter().find(|c| [c.code()] == *value);
        found.ok_or_else(|| unsupported("a compression other than none and ZIP"))
    }

    /// Rows to a block.
    pub(super) fn lines(self) -> u32 {
        match self {
            Self::None | Self::ZipSingle => 1,
            Self::Zip => 16,
        }
    }
}

/// The blocks of an image from the top down, each with its row number and length in front.
pub(super) fn compress(image: &Image, shape: ImageShape) -> Vec<Vec<u8>> {
    let row_values = (shape.width * shape.channels) as usize;
    let lines = Compression::Zip.lines();
    let order = file_order(shape.channels);
    let blocks = image.data.chunks(row_values * lines as usize).enumerate();
    blocks
        .map(|(i, rows)| {
            let mut planar = Vec::with_capacity(4 * rows.len());
            for row in rows.chunks_exact(row_values) {
                for &channel in &order {
                    let values = row.iter().skip(channel).step_by(shape.channels as usize);
                    planar.extend(values.flat_map(|value| value.to_le_bytes()));
                }
            }
            let zipped = compress_to_vec_zlib(&split_and_predict(&planar), ZLIB_LEVEL);
            // What does not shrink is stored as it is; readers tell by the length.
            let stored = if zipped.len() < planar.len() { zipped } else { planar };
            let row = i as i32 * lines as i32;
            [row.to_le_bytes().as_slice(), &(stored.len() as i32).to_le_bytes(), &stored].concat()
        })
        .collect()
}

/// Appends the values of one block, channels interleaved. `block` begins with the row number and may be followed by
/// other blocks; `shape` is that of the block.
pub(super) fn decompress(
    block: &[u8],
    shape: ImageShape,
    row: i64,
    compression: Compression,
    channel_order: &[usize],
    data: &mut Vec<f32>,
) -> Result<(), TextureError> {
    let cut = || malformed("a block is cut off");
    let (found_row, block) = block.split_first_chunk().ok_or_else(cut)?;
    let (length, block) = block.split_first_chunk().ok_or_else(cut)?;
    if i64::from(i32::from_le_bytes(*found_row)) != row {
        return Err(malformed("a block has another row number than the offset table says"));
    }
    let stored = block.get(..u32::from_le_bytes(*length) as usize).ok_or_else(cut)?;

    let expected = 4 * (shape.width * shape.height * shape.channels) as usize;
    let unzipped;
    let planar = if stored.len() == expected {
        stored
    } else if compression == Compression::None {
        return Err(malformed("an uncompressed block has the wrong length"));
    } else {
        let split = decompress_to_vec_zlib_with_limit(stored, expected)
            .map_err(|_| malformed("a block has damaged zlib data or unpacks to more than its rows"))?;
        if split.len() != expected {
            return Err(malformed("a block unpacks to less than its rows"));
        }
        unzipped = unpredict_and_join(split);
        &unzipped
    };

    let (width, channels) = (shape.width as usize, shape.channels as usize);
    for row in planar.chunks_exact(4 * width * channels) {
        let start = data.len();
        data.resize(start + width * channels, 0.0);
        for (plane, &channel) in row.chunks_exact(4 * width).zip(channel_order) {
            for (x, value) in plane.chunks_exact(4).enumerate() {
                data[start + x * channels + channel] = f32::from_le_bytes([value[0], value[1], value[2], value[3]]);
            }
        }
    }
    Ok(())
}

/// Bytes at even places, then those at odd places; then each as its difference from the one before, plus 128.
fn split_and_predict(bytes: &[u8]) -> Vec<u8> {
    let mut split: Vec<u8> = bytes.iter().step_by(2).chain(bytes.iter().skip(1).step_by(2)).copied().collect();
    for i in (1..split.len()).rev() {
        split[i] = split[i].wrapping_sub(split[i - 1]).wrapping_add(128);
    }
    split
}

fn unpredict_and_join(mut split: Vec<u8>) -> Vec<u8> {
    for i in 1..split.len() {
        split[i] = split[i].wrapping_add(split[i - 1]).wrapping_sub(128);
    }
    let (even, odd) = split.split_at(split.len().div_ceil(2));
    (0..split.len()).map(|i| if i % 2 == 0 { even[i / 2] } else { odd[i / 2] }).collect()
}
