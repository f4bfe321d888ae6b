//! PNG: pictures to look at, tables of 8 bits, and maps made by others to read.

use std::io::Cursor;

use ::image::codecs::png::{CompressionType, FilterType, PngDecoder, PngEncoder};
use ::image::{ExtendedColorType, ImageDecoder, ImageEncoder, Limits};
use luthier_lut::Image;

use crate::error::Container;
use crate::limits::{check_image, checked_bytes};
use crate::{Metadata, TextureError, metadata, srgb};

/// Deflate expands by at most 1032 (RFC 1951: a match of 258 bytes in two bits); a file that promises more is damaged.
const MAX_EXPANSION: u64 = 1032;

/// Bytes that the decoder may allocate beside the pixels: rows, and the chunks that it keeps.
const MAX_DECODER_BYTES: u64 = 16 << 20;

/// A PNG of sRGB pixels, three bytes each, row by row from the top. It holds no metadata: it is only to look at.
///
/// # Errors
/// [`TextureError::Size`], [`TextureError::Length`], [`TextureError::PngEncode`].
pub fn encode_rgb(width: u32, height: u32, rgb8: &[u8]) -> Result<Vec<u8>, TextureError> {
    let expected = checked_bytes(width, height, 3)?;
    if rgb8.len() != expected {
        return Err(TextureError::Length { found: rgb8.len(), expected });
    }
    let mut file = Vec::new();
    PngEncoder::new_with_quality(&mut file, CompressionType::Best, FilterType::Adaptive)
        .write_image(rgb8, width, height, ExtendedColorType::Rgb8)
        .map_err(TextureError::PngEncode)?;
    Ok(file)
}

/// A PNG of a linear image, sRGB-encoded and clipped to 0..=1. One and two channels become grey; alpha is left out.
///
/// # Errors
/// [`TextureError::Size`], [`TextureError::Channels`], [`TextureError::Length`], [`TextureError::PngEncode`].
pub fn encode_image(image: &Image) -> Result<Vec<u8>, TextureError> {
    check_image(image)?;
    encode_rgb(image.width, image.height, &srgb::rgb8(image))
}

/// A PNG of a table: one to four channels, linear values clipped to 0..=1, as 8 bits without a colour space; statements about it as text.
///
/// # Errors
/// [`TextureError::Size`], [`TextureError::Channels`], [`TextureError::Length`], [`TextureError::Metadata`], [`TextureError::PngTable`].
pub fn encode_table(table: &Image, metadata: &Metadata) -> Result<Vec<u8>, TextureError> {
    check_image(table)?;
    metadata::check(metadata)?;
    let bytes: Vec<u8> = table.data.iter().map(|value| (value.clamp(0.0, 1.0) * 255.0 + 0.5) as u8).collect();
    let mut file = Vec::new();
    let mut encoder = ::png::Encoder::new(&mut file, table.width, table.height);
    encoder.set_depth(::png::BitDepth::Eight);
    encoder.set_color(match table.channels {
        1 => ::png::ColorType::Grayscale,
        2 => ::png::ColorType::GrayscaleAlpha,
        3 => ::png::ColorType::Rgb,
        _ => ::png::ColorType::Rgba,
    });
    encoder.set_compression(::png::Compression::High);
    for (key, value) in metadata {
        encoder.add_itxt_chunk(key.clone(), value.clone()).map_err(TextureError::PngTable)?;
    }
    let mut writer = encoder.write_header().map_err(TextureError::PngTable)?;
    writer.write_image_data(&bytes).map_err(TextureError::PngTable)?;
    writer.finish().map_err(TextureError::PngTable)?;
    Ok(file)
}

/// A PNG of a map: one channel, linear values clipped to 0..=1, as 8 bits of grey, which every engine filters.
///
/// # Errors
/// [`TextureError::Size`], [`TextureError::Channels`], [`TextureError::Length`], [`TextureError::PngEncode`].
pub fn encode_gray(map: &Image) -> Result<Vec<u8>, TextureError> {
    check_image(map)?;
    let gray: Vec<u8> = map.texels().map(|texel| (texel[0].clamp(0.0, 1.0) * 255.0 + 0.5) as u8).collect();
    let mut file = Vec::new();
    PngEncoder::new_with_quality(&mut file, CompressionType::Best, FilterType::Adaptive)
        .write_image(&gray, map.width, map.height, ExtendedColorType::L8)
        .map_err(TextureError::PngEncode)?;
    Ok(file)
}

/// A map: one channel in 0..=1, the stored values over their maximum (8 or 16 bits), not linearised. Alpha is ignored;
/// a colour image will do if it is grey throughout.
///
/// # Errors
/// As [`decode`], and [`TextureError::NotGrey`].
pub fn decode_gray(file: &[u8]) -> Result<Image, TextureError> {
    let Pixels { width, height, channels, values, .. } = read(file, 1)?;
    let mut data = Vec::with_capacity(values.len() / channels);
    for (i, pixel) in values.chunks_exact(channels).enumerate() {
        if channels >= 3 && (pixel[0] != pixel[1] || pixel[1] != pixel[2]) {
            let i = i as u32;
            return Err(TextureError::NotGrey { x: i % width, y: i / width });
        }
        data.push(pixel[0]);
    }
    Ok(Image { width, height, channels: 1, data })
}

/// An image as RGBA in 0..=1, the stored values over their maximum (8 or 16 bits), not linearised; alpha is 1 where the
/// file has none.
///
/// # Errors
/// [`TextureError::Malformed`] and [`TextureError::PngDecode`] for damaged files, [`TextureError::Size`].
pub fn decode(file: &[u8]) -> Result<Image, TextureError> {
    let Pixels { width, height, channels, values, .. } = read(file, 4)?;
    let rgba = |pixel: &[f32]| match *pixel {
        [y] => [y, y, y, 1.0],
        [y, a] => [y, y, y, a],
        [r, g, b] => [r, g, b, 1.0],
        [r, g, b, a, ..] => [r, g, b, a],
        [] => [0.0; 4],
    };
    let data = values.chunks_exact(channels).flat_map(rgba).collect();
    Ok(Image { width, height, channels: 4, data })
}

/// A table with as many channels as the file has (a grey one has 1), values over their maximum, and its bits per value.
///
/// # Errors
/// As [`decode`].
pub(crate) fn decode_table(file: &[u8]) -> Result<(Image, u32), TextureError> {
    let Pixels { width, height, channels, bits, values } = read(file, 1)?;
    Ok((Image { width, height, channels: channels as u32, data: values }, bits))
}

struct Pixels {
    width: u32,
    height: u32,
    /// 1 grey, 2 grey and alpha, 3 RGB, 4 RGBA.
    channels: usize,
    /// 8 or 16.
    bits: u32,
    values: Vec<f32>,
}

/// Reads pixels that will become an image of `channels_wanted`.
fn read(file: &[u8], channels_wanted: u32) -> Result<Pixels, TextureError> {
    let mut limits = Limits::default();
    limits.max_alloc = Some(MAX_DECODER_BYTES);
    check_palette(file)?;
    // Palettes, 1 to 4 bits and colour keys become 8-bit channels.
    let decoder = PngDecoder::with_limits(Cursor::new(file), limits).map_err(TextureError::PngDecode)?;
    let (width, height) = decoder.dimensions();
    let color = decoder.color_type();
    let channels = color.channel_count();
    checked_bytes(width, height, 4 * channels_wanted.max(channels.into()))?;
    // A pixel takes one bit at least.
    if u64::from(width) * u64::from(height) / 8 > MAX_EXPANSION * file.len() as u64 {
        return Err(TextureError::malformed(Container::Png, "it is too short for the size that it states"));
    }
    let size = usize::try_from(decoder.total_bytes()).map_err(|_| TextureError::Size { width, height })?;
    let mut bytes = vec![0; size];
    decoder.read_image(&mut bytes).map_err(TextureError::PngDecode)?;
    let bits = 8 * u32::from(color.bytes_per_pixel() / channels);
    let values = if bits == 8 {
        bytes.iter().map(|&b| f32::from(b) / 255.0).collect()
    } else {
        bytes.as_chunks().0.iter().map(|&b| f32::from(u16::from_ne_bytes(b)) / 65535.0).collect()
    };
    Ok(Pixels { width, height, channels: channels.into(), bits, values })
}

/// Refuses palettes that do not consist of 1 to 256 colours (section 11.2.2 of the PNG specification): the decoder reads beyond their end.
fn check_palette(file: &[u8]) -> Result<(), TextureError> {
    // Chunks: length, kind, data, sum.
    let mut rest = file.get(8..).unwrap_or_default();
    while let Some((length, chunk)) = rest.split_first_chunk() {
        let length = u32::from_be_bytes(*length) as usize;
        if chunk.starts_with(b"PLTE") && !(length.is_multiple_of(3) && (3..=768).contains(&length)) {
            return Err(TextureError::malformed(Container::Png, "the palette does not consist of 1 to 256 colours"));
        }
        rest = chunk.get(length.saturating_add(8)..).unwrap_or_default();
    }
    Ok(())
}

#[cfg(test)]
mod tests;
