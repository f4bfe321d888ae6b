//! PNG: pictures to look at, tables of 8 bits, and maps of other programs.

use std::io::Cursor;

use ::image::codecs::png::{CompressionType, FilterType, PngDecoder, PngEncoder};
use ::image::{ExtendedColorType, ImageDecoder, ImageEncoder, Limits};
use luthier_lut::{Image, Picture, PictureSamples};

use crate::error::Container;
use crate::size::{check_image, checked_bytes};
use crate::{Metadata, TextureError, metadata, srgb};

/// Largest expansion of deflate (RFC 1951: a match of 258 bytes in two bits). A file that promises more is damaged.
const MAX_EXPANSION: u64 = 1032;

/// Bytes that the decoder may allocate beside the pixels, for rows and kept chunks.
const MAX_DECODER_BYTES: u64 = 16 << 20;

/// A PNG of sRGB pixels, three bytes each, row by row from the top. It holds no metadata.
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

/// A PNG of a table of one to four channels: linear values clipped to 0..=1, as 8 bits without a colour space. Metadata
/// are text chunks.
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

/// A PNG of a map of one channel: linear values clipped to 0..=1, as 8 bits of grey, which every engine filters.
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

/// A PNG of a picture of one channel or of RGB, with the same bits. Texels of floats become 16 bits.
///
/// # Errors
/// [`TextureError::Size`], [`TextureError::Length`], [`TextureError::PngTable`].
pub fn encode_picture(picture: &Picture) -> Result<Vec<u8>, TextureError> {
    let (width, height, channels) = (picture.width, picture.height, picture.channels as usize);
    let bytes = match &picture.samples {
        PictureSamples::Bits8(values) => values.clone(),
        PictureSamples::Bits16(values) => values.iter().flat_map(|value| value.to_be_bytes()).collect(),
        PictureSamples::Float(values) => {
            let codes = values.iter().map(|value| (value.clamp(0.0, 1.0) * 65535.0).round() as u16);
            codes.flat_map(u16::to_be_bytes).collect()
        }
    };
    let size = if matches!(picture.samples, PictureSamples::Bits8(_)) { 1 } else { 2 };
    let expected = checked_bytes(width, height, (size * channels) as u32)?;
    if bytes.len() != expected {
        return Err(TextureError::Length { found: bytes.len() / size, expected: expected / size });
    }
    let mut file = Vec::new();
    let mut encoder = ::png::Encoder::new(&mut file, width, height);
    encoder.set_depth(if size == 1 { ::png::BitDepth::Eight } else { ::png::BitDepth::Sixteen });
    encoder.set_color(match channels {
        1 => ::png::ColorType::Grayscale,
        2 => ::png::ColorType::GrayscaleAlpha,
        3 => ::png::ColorType::Rgb,
        _ => ::png::ColorType::Rgba,
    });
    encoder.set_compression(::png::Compression::Balanced);
    let mut writer = encoder.write_header().map_err(TextureError::PngTable)?;
    writer.write_image_data(&bytes).map_err(TextureError::PngTable)?;
    writer.finish().map_err(TextureError::PngTable)?;
    Ok(file)
}

/// Reads an image as RGBA in 0..=1: stored values over their maximum (8 or 16 bits), not linearised. Alpha is 1 if the
/// file has none.
///
/// # Errors
/// [`TextureError::Malformed`] and [`TextureError::PngDecode`] for damaged files, [`TextureError::Size`].
pub fn decode(file: &[u8]) -> Result<Image, TextureError> {
    let picture = read(file)?;
    checked_bytes(picture.width, picture.height, 16)?;
    Ok(picture.image())
}

/// Reads a table with the channels of the file (grey has 1), values over their maximum, and its bits per value.
///
/// # Errors
/// As [`decode`].
pub(crate) fn decode_table(file: &[u8]) -> Result<(Image, u32), TextureError> {
    let picture = read(file)?;
    let bits = if matches!(picture.samples, PictureSamples::Bits8(_)) { 8 } else { 16 };
    let data = (0..picture.texel_count() * picture.channels as usize).map(|i| picture.stored(i)).collect();
    Ok((Image { width: picture.width, height: picture.height, channels: picture.channels, data }, bits))
}

/// Reads the pixels of a file as stored.
pub(crate) fn read(file: &[u8]) -> Result<Picture, TextureError> {
    if let Some(reason) = unreadable(file) {
        return Err(TextureError::malformed(Container::Png, reason));
    }
    check_palette(file)?;
    let mut limits = Limits::default();
    limits.max_alloc = Some(MAX_DECODER_BYTES);
    // Palettes, 1 to 4 bits and colour keys become 8-bit channels.
    let decoder = PngDecoder::with_limits(Cursor::new(file), limits).map_err(TextureError::PngDecode)?;
    let (width, height) = decoder.dimensions();
    let color = decoder.color_type();
    checked_bytes(width, height, color.bytes_per_pixel().into())?;
    // A pixel takes one bit at least.
    if u64::from(width) * u64::from(height) / 8 > MAX_EXPANSION * file.len() as u64 {
        return Err(TextureError::malformed(Container::Png, "it is too short for the size that it states"));
    }
    let size = usize::try_from(decoder.total_bytes()).map_err(|_| TextureError::Size { width, height })?;
    let mut bytes = vec![0; size];
    decoder.read_image(&mut bytes).map_err(TextureError::PngDecode)?;
    let channels = u32::from(color.channel_count());
    let samples = if u32::from(color.bytes_per_pixel()) == channels {
        PictureSamples::Bits8(bytes)
    } else {
        PictureSamples::Bits16(bytes.as_chunks().0.iter().map(|&b| u16::from_ne_bytes(b)).collect())
    };
    Ok(Picture { width, height, channels, is_srgb: false, samples })
}

/// Whether a file says that its colours are stored by the sRGB curve, or by a power near it.
pub(crate) fn says_srgb(file: &[u8]) -> bool {
    chunks(file).any(|(kind, data)| match kind {
        b"sRGB" | b"iCCP" => true,
        b"gAMA" => data.first_chunk().is_some_and(|gamma| (45_000..46_000).contains(&u32::from_be_bytes(*gamma))),
        _ => false,
    })
}

/// Reason why other programs than its maker cannot read a file with the signature of PNG.
fn unreadable(file: &[u8]) -> Option<&'static str> {
    let apple = chunks(file).next().is_some_and(|(kind, _)| kind == b"CgBI");
    apple.then_some("Xcode made it for iOS (chunk CgBI), which no other program reads; export the picture again")
}

/// The chunks of a file: kind and data, up to its end.
fn chunks(file: &[u8]) -> impl Iterator<Item = (&[u8; 4], &[u8])> {
    // Chunks: length, kind, data, sum.
    let mut rest = file.get(8..).unwrap_or_default();
    std::iter::from_fn(move || {
        let (length, chunk) = rest.split_first_chunk()?;
        let (kind, data) = chunk.split_first_chunk()?;
        let length = u32::from_be_bytes(*length) as usize;
        rest = data.get(length.saturating_add(4)..).unwrap_or_default();
        Some((kind, data.get(..length).unwrap_or(data)))
    })
}

/// Refuses palettes that do not consist of 1 to 256 colours (section 11.2.2 of the PNG specification). The decoder
/// would read beyond their end.
fn check_palette(file: &[u8]) -> Result<(), TextureError> {
    if chunks(file).any(|(kind, data): (&[u8; 4], &[u8])| {
        kind == b"PLTE" && !(data.len().is_multiple_of(3) && (3..=768).contains(&data.len()))
    }) {
        return Err(TextureError::malformed(Container::Png, "the palette does not consist of 1 to 256 colours"));
    }
    Ok(())
}

#[cfg(test)]
mod tests;
