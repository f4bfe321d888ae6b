//! Pictures of radiance of other programs, to read: OpenEXR of any compression, 16 or 32 bits, and Radiance HDR (RGBE
//! and XYZE).

mod channels;
mod hdr;
mod header;
mod open_exr;
mod picture;
mod primaries;

pub use self::picture::Picture;
use crate::TextureError;
use crate::error::Container;

const EXR_MAGIC: [u8; 4] = [0x76, 0x2f, 0x31, 0x01];

/// Reads a Radiance HDR file, or the colours of an OpenEXR file. Of OpenEXR, the first part with colours is read, at
/// its largest resolution.
///
/// Colours are brought to linear Rec.709 if the file states other primaries (`PRIMARIES`, `32-bit_rle_xyze`,
/// `chromaticities`), by Bradford's adaptation. Values of Radiance HDR are divided by `EXPOSURE` and `COLORCORR`. The
/// picture of OpenEXR is the display window; alpha is left out.
///
/// # Errors
/// [`TextureError::Malformed`] and [`TextureError::ExrDecode`] for damaged and other files, [`TextureError::Unsupported`] for deep data,
/// cubes and files without colours, [`TextureError::Size`].
pub fn decode(file: &[u8]) -> Result<Picture, TextureError> {
    if file.starts_with(&EXR_MAGIC) {
        return open_exr::decode(file);
    }
    if file.starts_with(b"#?") {
        return hdr::decode(file);
    }
    Err(TextureError::malformed(Container::Exr, "it is neither OpenEXR nor Radiance HDR"))
}
