//! PNG: pictures to look at, and maps made by others to read.

use std::io::Cursor;

use ::png::{BitDepth, ColorType, Compression, Decoder, Encoder, SrgbRenderingIntent, Transformations};
use luthier_lut::Image;

use crate::error::Container;
use crate::limits::{check_image, checked_bytes};
use crate::{TextureError, metadata, srgb};

/// Deflate expands by at most 1032 (RFC 1951: a match of 258 bytes in two bits); a file that promises more is damaged.
const MAX_EXPANSION: u64 = 1032;

/// A PNG of sRGB pixels, three bytes each, row by row from the top. Metadata (see [`crate::Metadata`]) become text
/// chunks in the given order: tEXt, or iTXt where they are not ASCII.
///
/// # Errors
/// [`TextureError::Size`], [`TextureError::Length`], [`TextureError::Metadata`].
pub fn encode_rgb(
    width: u32,
    height: u32,
    rgb8: &[u8],
    metadata: &[(String, String)],
) -> Result<Vec<u8>, TextureError> {
    let expected = checked_bytes(width, height, 3)?;
    if rgb8.len() != expected {
        return Err(TextureError::Length { found: rgb8.len(), expected });
    }
    metadata::check(metadata)?;
    let mut file = Vec::new();
    let mut encoder = Encoder::new(&mut file, width, height);
    encoder.set_color(ColorType::Rgb);
    encoder.set_depth(BitDepth::Eight);
    encoder.set_compression(Compression::High);
    encoder.set_source_srgb(SrgbRenderingIntent::RelativeColorimetric);
    for (key, value) in metadata {
        if value.is_ascii() {
            encoder.add_text_chunk(key.clone(), value.clone())?;
        } else {
            encoder.add_itxt_chunk(key.clone(), value.clone())?;
        }
    }
    let mut writer = encoder.write_header()?;
    writer.write_image_data(rgb8)?;
    writer.finish()?;
    Ok(file)
}

/// A PNG of a linear image, sRGB-encoded and clipped to 0..=1. One and two channels become grey; alpha is left out.
///
/// # Errors
/// [`TextureError::Size`], [`TextureError::Channels`], [`TextureError::Length`].
pub fn encode_image(image: &Image) -> Result<Vec<u8>, TextureError> {
    check_image(image)?;
    encode_rgb(image.width, image.height, &srgb::rgb8(image), &[])
}

/// A map: one channel in 0..=1, the stored values over their maximum (8 or 16 bits), not linearised. Alpha is ignored;
/// a colour image will do if it is grey throughout.
///
/// # Errors
/// As [`decode`], and [`TextureError::NotGrey`].
pub fn decode_gray(file: &[u8]) -> Result<Image, TextureError> {
    let Pixels { width, height, channels, values } = read(file, 1)?;
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
    let Pixels { width, height, channels, values } = read(file, 4)?;
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

struct Pixels {
    width: u32,
    height: u32,
    /// 1 grey, 2 grey and alpha, 3 RGB, 4 RGBA.
    channels: usize,
    values: Vec<f32>,
}

/// Reads pixels that will become an image of `channels_wanted`.
fn read(file: &[u8], channels_wanted: u32) -> Result<Pixels, TextureError> {
    let malformed = |reason: &'static str| TextureError::malformed(Container::Png, reason);
    let mut decoder = Decoder::new(Cursor::new(file));
    // Palettes, 1 to 4 bits and colour keys become 8-bit channels.
    decoder.set_transformations(Transformations::EXPAND);
    let mut reader = decoder.read_info()?;
    let info = reader.info();
    let (width, height) = (info.width, info.height);
    let bits = u64::from(width) * u64::from(height) * info.bits_per_pixel() as u64;

    let (color, depth) = reader.output_color_type();
    let channels = color.samples();
    checked_bytes(width, height, 4 * channels_wanted.max(channels as u32))?;
    if bits / 8 > MAX_EXPANSION * file.len() as u64 {
        return Err(malformed("it is too short for the size that it states"));
    }
    let size = reader.output_buffer_size().ok_or(TextureError::Size { width, height })?;
    let mut bytes = vec![0; size];
    reader.next_frame(&mut bytes)?;
    let values = match depth {
        BitDepth::Sixteen => {
            bytes.chunks_exact(2).map(|b| f32::from(u16::from_be_bytes([b[0], b[1]])) / 65535.0).collect()
        }
        _ => bytes.iter().map(|&b| f32::from(b) / 255.0).collect(),
    };
    Ok(Pixels { width, height, channels, values })
}

#[cfg(test)]
mod tests;
