//! Errors of reading and writing containers.

use std::borrow::Cow;
use std::fmt;

use luthier_lut::LutError;
use thiserror::Error;

use crate::limits::{MAX_BYTES, MAX_SIDE};

/// The file formats of this crate.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Container {
    /// Khronos texture container, version 2.
    Ktx2,
    /// OpenEXR.
    Exr,
    /// Portable network graphics.
    Png,
    /// JPEG.
    Jpeg,
    /// WebP.
    WebP,
    /// Radiance RGBE.
    Hdr,
    /// DirectDraw Surface.
    Dds,
}

impl fmt::Display for Container {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Ktx2 => "KTX2",
            Self::Exr => "EXR",
            Self::Png => "PNG",
            Self::Jpeg => "JPEG",
            Self::WebP => "WebP",
            Self::Hdr => "Radiance HDR",
            Self::Dds => "DDS",
        })
    }
}

/// Why a texture cannot be written or a file cannot be read.
///
/// ```
/// let error = luthier_texture::ktx2::decode(b"a few bytes").unwrap_err();
/// assert_eq!(error.to_string(), "not a valid KTX2 file: it ends within the header");
/// ```
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum TextureError {
    /// A side is 0 or above [`MAX_SIDE`], or the texels take more than [`MAX_BYTES`].
    #[error("{width} x {height} texels: sides are 1 to {MAX_SIDE}, and all texels take at most {} MiB", MAX_BYTES >> 20)]
    Size {
        /// Texels across.
        width: u32,
        /// Texels down.
        height: u32,
    },
    /// Another number of values than width, height and channels ask for.
    #[error("{found} values where {expected} are needed")]
    Length {
        /// Given.
        found: usize,
        /// Needed.
        expected: usize,
    },
    /// An image with no channels or more than four.
    #[error("{0} channels; an image has 1 to 4")]
    Channels(u32),
    /// A metadata entry that the container cannot hold.
    #[error("metadata `{key}`: {reason}")]
    Metadata {
        /// The key at fault.
        key: String,
        /// Fault of the metadata.
        reason: &'static str,
    },
    /// A file of another format, or a damaged one.
    #[error("not a valid {container} file: {reason}")]
    Malformed {
        /// The format that was expected.
        container: Container,
        /// Fault of the file.
        reason: Cow<'static, str>,
    },
    /// A format that no tables are read from.
    #[error("neither DDS, KTX2, EXR, PNG nor Radiance HDR")]
    UnknownContainer,
    /// A valid file with content that luthier does not read.
    #[error("{container} file with {what}, which luthier does not read")]
    Unsupported {
        /// The format.
        container: Container,
        /// Content that is not supported.
        what: Cow<'static, str>,
    },
    /// Zstandard data of a KTX2 file that does not decompress.
    #[error("not a valid KTX2 file: damaged zstd data")]
    Zstd(#[from] ruzstd::decoding::errors::FrameDecoderError),
    /// An EXR file that does not decode.
    #[error("not a valid EXR file")]
    ExrDecode(#[source] ::exr::error::Error),
    /// The EXR encoder refused.
    #[error("cannot encode EXR")]
    ExrEncode(#[source] ::exr::error::Error),
    /// A PNG file that does not decode.
    #[error("not a valid PNG file: {}", decoder_reason(.0))]
    PngDecode(::image::ImageError),
    /// A JPEG or WebP file that does not decode.
    #[error("not a valid {container} file: {}", decoder_reason(.reason))]
    PictureDecode {
        /// The format according to its first bytes.
        container: Container,
        /// Fault of the file, in the decoder's words.
        reason: ::image::ImageError,
    },
    /// A file of a format that no maps are read from.
    #[error("{0}; PNG, JPEG and WebP are read")]
    NoPicture(&'static str),
    /// The PNG encoder refused.
    #[error("cannot encode PNG")]
    PngEncode(#[source] ::image::ImageError),
    /// The PNG encoder of tables refused.
    #[error("cannot encode PNG")]
    PngTable(#[source] ::png::EncodingError),
    /// Texels that do not fit their format.
    #[error(transparent)]
    Lut(#[from] LutError),
}

/// The decoder's reason, without the name of the format, which the message states before it.
fn decoder_reason(error: &::image::ImageError) -> String {
    use std::error::Error;
    let reason = error.source().map_or_else(|| error.to_string(), ToString::to_string);
    match reason.as_str() {
        sum if sum.starts_with("CRC error") => "the checksum of a chunk does not fit its data".to_owned(),
        short if short.contains("Not enough bytes") || short.contains("unexpected EOF") => "it ends early".to_owned(),
        _ => reason,
    }
}

impl TextureError {
    pub(crate) fn malformed(container: Container, reason: impl Into<Cow<'static, str>>) -> Self {
        Self::Malformed { container, reason: reason.into() }
    }

    pub(crate) fn unsupported(container: Container, what: impl Into<Cow<'static, str>>) -> Self {
        Self::Unsupported { container, what: what.into() }
    }
}
