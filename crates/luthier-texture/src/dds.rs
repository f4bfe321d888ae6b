//! DDS (DirectDraw Surface), to read: the first image of a file of uncompressed texels. Texel formats come from the
//! DXGI format of a DX10 header, else from FourCC or bit masks (Microsoft, "Programming Guide for DDS").

use luthier_lut::Image;

use crate::TextureError;
use crate::error::Container;
use crate::size::checked_bytes;
use crate::texels::{Samples, TexelLayout};

const HEADER_BYTES: usize = 128;
const DX10_BYTES: usize = 20;

/// Flags of the pixel format.
const FOUR_CC: u32 = 0x4;
const RGB: u32 = 0x40;
const LUMINANCE: u32 = 0x20000;
/// Capabilities of cube maps and volumes.
const CUBE_OR_VOLUME: u32 = 0x200 | 0x20_0000;

/// Layout and texels of a file.
///
/// # Errors
/// [`TextureError::Malformed`] for damaged files, [`TextureError::Unsupported`] for formats that are not read, [`TextureError::Size`].
pub(crate) fn decode(file: &[u8]) -> Result<(TexelLayout, Image), TextureError> {
    if !file.starts_with(b"DDS ") || file.len() < HEADER_BYTES || word(file, 4) != 124 || word(file, 76) != 32 {
        return Err(TextureError::malformed(Container::Dds, "the header is damaged"));
    }
    let (height, width) = (word(file, 12), word(file, 16));
    if word(file, 112) & CUBE_OR_VOLUME != 0 {
        return Err(unsupported("a cube map or volume"));
    }
    let (flags, four_cc) = (word(file, 80), word(file, 84));
    let mut texels_at = HEADER_BYTES;
    let layout = if flags & FOUR_CC != 0 && four_cc == u32::from_le_bytes(*b"DX10") {
        if file.len() < HEADER_BYTES + DX10_BYTES {
            return Err(TextureError::malformed(Container::Dds, "it ends within the DX10 header"));
        }
        // Two-dimensional, and not six faces.
        if word(file, 132) != 3 || word(file, 136) & 4 != 0 {
            return Err(unsupported("a texture that is not two-dimensional"));
        }
        texels_at += DX10_BYTES;
        let format = word(file, 128);
        dxgi(format).ok_or_else(|| unsupported(format!("texels of DXGI format {format}")))?
    } else if flags & FOUR_CC != 0 {
        d3d9(four_cc).ok_or_else(|| unsupported(format!("texels of FourCC {four_cc:#010x}")))?
    } else {
        let masks = [92, 96, 100, 104].map(|at| word(file, at));
        masked(flags, word(file, 88), masks)
            .ok_or_else(|| unsupported("texels of bit masks that are not bytes or words in order"))?
    };
    let expected = checked_bytes(width, height, layout.texel_bytes())?;
    let texels = file[texels_at..].get(..expected);
    let texels =
        texels.ok_or_else(|| TextureError::malformed(Container::Dds, "it is too short for the size that it states"))?;
    Ok((layout, layout.image(width, height, texels)))
}

fn word(file: &[u8], at: usize) -> u32 {
    file.get(at..).and_then(|rest| rest.first_chunk()).map_or(0, |bytes| u32::from_le_bytes(*bytes))
}

fn unsupported(what: impl Into<std::borrow::Cow<'static, str>>) -> TextureError {
    TextureError::unsupported(Container::Dds, what)
}

/// DXGI_FORMAT.
fn dxgi(format: u32) -> Option<TexelLayout> {
    let (samples, channels) = match format {
        2 => (Samples::Float, 4),
        6 => (Samples::Float, 3),
        10 => (Samples::Half, 4),
        11 => (Samples::Unorm16, 4),
        16 => (Samples::Float, 2),
        24 => (Samples::Unorm10, 4),
        28 | 29 | 87 | 88 | 91 => (Samples::Unorm8, 4),
        34 => (Samples::Half, 2),
        35 => (Samples::Unorm16, 2),
        41 => (Samples::Float, 1),
        49 => (Samples::Unorm8, 2),
        54 => (Samples::Half, 1),
        56 => (Samples::Unorm16, 1),
        61 => (Samples::Unorm8, 1),
        _ => return None,
    };
    Some(TexelLayout { samples, channels, bgr: matches!(format, 87 | 88 | 91), srgb: matches!(format, 29 | 91) })
}

/// D3DFORMAT numbers that older writers put where a FourCC goes.
fn d3d9(format: u32) -> Option<TexelLayout> {
    let (samples, channels) = match format {
        34 => (Samples::Unorm16, 2),
        36 => (Samples::Unorm16, 4),
        111 => (Samples::Half, 1),
        112 => (Samples::Half, 2),
        113 => (Samples::Half, 4),
        114 => (Samples::Float, 1),
        115 => (Samples::Float, 2),
        116 => (Samples::Float, 4),
        _ => return None,
    };
    Some(TexelLayout::of(samples, channels))
}

fn masked(flags: u32, bits: u32, masks: [u32; 4]) -> Option<TexelLayout> {
    let (samples, channels, bgr) = match (flags & (RGB | LUMINANCE), bits, [masks[0], masks[1], masks[2]]) {
        (LUMINANCE, 8, _) => (Samples::Unorm8, 1, false),
        (LUMINANCE, 16, [0xffff, ..]) => (Samples::Unorm16, 1, false),
        (LUMINANCE, 16, [0xff, ..]) => (Samples::Unorm8, 2, false),
        (RGB, 16, [0xff, 0xff00, 0]) => (Samples::Unorm8, 2, false),
        (RGB, 32, [0xffff, 0xffff_0000, 0]) => (Samples::Unorm16, 2, false),
        (RGB, 32, [0xff, 0xff00, 0xff_0000]) => (Samples::Unorm8, 4, false),
        (RGB, 32, [0xff_0000, 0xff00, 0xff]) => (Samples::Unorm8, 4, true),
        (RGB, 24, [0xff, 0xff00, 0xff_0000]) => (Samples::Unorm8, 3, false),
        (RGB, 24, [0xff_0000, 0xff00, 0xff]) => (Samples::Unorm8, 3, true),
        _ => return None,
    };
    Some(TexelLayout { bgr, ..TexelLayout::of(samples, channels) })
}
