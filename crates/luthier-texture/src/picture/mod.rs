//! Maps of other programs, to read: PNG, JPEG and WebP of 8 or 16 bits.
//!
//! [`decode`] tells the format by its first bytes, because file endings are often wrong. Values stay as stored, without
//! a curve. A JPEG or WebP is turned upright if it states its orientation. Of an animation the first frame counts.

use std::io::Cursor;

use ::image::codecs::jpeg::JpegDecoder;
use ::image::codecs::webp::WebPDecoder;
use ::image::{DynamicImage, ImageDecoder, ImageError};
use luthier_lut::{Picture, PictureSamples};

use crate::error::Container;
use crate::limits::is_plausible;
use crate::size::checked_bytes;
use crate::{TextureError, png};

/// A picture, and the statements of its file about it.
///
/// ```
/// use luthier_texture::{Container, picture, png};
///
/// let decoded = picture::decode(&png::encode_rgb(1, 1, &[255, 0, 51])?)?;
/// assert_eq!((decoded.container, decoded.picture.channels), (Container::Png, 3));
/// assert_eq!(decoded.picture.stored(2), 0.2);
/// # Ok::<(), luthier_texture::TextureError>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Decoded {
    /// Its samples, not linearised.
    pub picture: Picture,
    /// The format.
    pub container: Container,
    /// Whether its colours are stored by the sRGB curve. PNG says so in a chunk; JPEG and WebP always are.
    pub says_srgb: bool,
}

/// Reads a picture.
///
/// # Errors
/// [`TextureError::NoPicture`] for files of other formats, [`TextureError::Malformed`], [`TextureError::PngDecode`] and
/// [`TextureError::PictureDecode`] for damaged ones, [`TextureError::Size`].
pub fn decode(file: &[u8]) -> Result<Decoded, TextureError> {
    if file.starts_with(b"\x89PNG") {
        let picture = png::read(file)?;
        return Ok(Decoded { picture, container: Container::Png, says_srgb: png::says_srgb(file) });
    }
    let (container, picture) = if file.starts_with(b"\xff\xd8\xff") {
        (Container::Jpeg, jpeg(file))
    } else if file.starts_with(b"RIFF") && file.get(8..12) == Some(b"WEBP") {
        (Container::WebP, webp(file))
    } else {
        return Err(TextureError::NoPicture(kind(file)));
    };
    let picture = picture.map_err(|fault| match fault {
        Fault::Codec(reason) => TextureError::PictureDecode { container, reason },
        Fault::Ours(error) => error,
        Fault::Short => TextureError::malformed(container, "it is too short for the size that it states"),
    })?;
    Ok(Decoded { picture, container, says_srgb: true })
}

fn jpeg(file: &[u8]) -> Result<Picture, Fault> {
    pixels(JpegDecoder::new(Cursor::new(file))?, file)
}

fn webp(file: &[u8]) -> Result<Picture, Fault> {
    pixels(WebPDecoder::new(Cursor::new(file))?, file)
}

/// Fault of a file that a decoder refused.
enum Fault {
    Codec(ImageError),
    Ours(TextureError),
    Short,
}

impl From<ImageError> for Fault {
    fn from(error: ImageError) -> Self {
        Self::Codec(error)
    }
}

/// The pixels of the decoder of a file, upright.
fn pixels(mut decoder: impl ImageDecoder, file: &[u8]) -> Result<Picture, Fault> {
    let (width, height) = decoder.dimensions();
    let bytes = checked_bytes(width, height, decoder.color_type().bytes_per_pixel().into()).map_err(Fault::Ours)?;
    if !is_plausible(file, bytes as u64) {
        return Err(Fault::Short);
    }
    let orientation = decoder.orientation()?;
    let mut image = DynamicImage::from_decoder(decoder)?;
    image.apply_orientation(orientation);
    let (width, height) = (image.width(), image.height());
    let (channels, bytes) = match image {
        DynamicImage::ImageLuma8(image) => (1, image.into_raw()),
        DynamicImage::ImageLumaA8(image) => (2, image.into_raw()),
        DynamicImage::ImageRgba8(image) => (4, image.into_raw()),
        other => (3, other.into_rgb8().into_raw()),
    };
    Ok(Picture { width, height, channels, is_srgb: false, samples: PictureSamples::Bits8(bytes) })
}

/// Likely format of a file that is not a picture.
fn kind(file: &[u8]) -> &'static str {
    const SIGNATURES: [(&[u8], &str); 17] = [
        (b"GIF8", "it is a GIF"),
        (b"BM", "it is a Windows bitmap (BMP)"),
        (b"II*\0", "it is a TIFF"),
        (b"MM\0*", "it is a TIFF"),
        (b"\x76\x2f\x31\x01", "it is an OpenEXR file, and maps hold numbers from 0 to 1"),
        (b"#?", "it is a Radiance HDR file, and maps hold numbers from 0 to 1"),
        (b"DDS ", "it is a DDS file"),
        (b"\xabKTX", "it is a KTX file"),
        (b"8BPS", "it is a Photoshop document"),
        (b"gimp xcf", "it is a GIMP document"),
        (b"%PDF", "it is a PDF"),
        (b"<svg", "it is an SVG drawing"),
        (b"<?xml", "it is XML, perhaps a drawing"),
        (b"PK\x03\x04", "it is a ZIP archive: unpack it"),
        (b"version https://git-lfs", "it is a Git LFS pointer: fetch the file with `git lfs pull`"),
        (b"\0\0\0\x0cjP  ", "it is a JPEG 2000 picture"),
        (b"\0\0\0\x0cJXL ", "it is a JPEG XL picture"),
    ];
    if file.is_empty() {
        return "the file is empty";
    }
    let text = String::from_utf8_lossy(&file[..file.len().min(64)]).trim_start().to_lowercase();
    if text.starts_with("<!doctype html") || text.starts_with("<html") {
        return "it is a page of HTML, perhaps in place of a download";
    }
    if file.get(4..8) == Some(b"ftyp") {
        return "it is a HEIC or AVIF picture";
    }
    let found = SIGNATURES.iter().find(|(start, _)| file.starts_with(start));
    found.map_or("it does not begin as a picture does", |(_, kind)| kind)
}

#[cfg(test)]
mod tests;
