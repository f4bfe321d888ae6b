//! KTX2 (Khronos KTX file format 2.0): one level, or to write also the levels of maps and cubes, with zstd or plain,
//! with a basic data format descriptor.
//!
//! Textures of bakes have the key `KTXwriter` and no other. Khronos' validator warns about every unlisted key, whatever
//! its prefix, so a file with one would not pass `ktx validate --warnings-as-errors`. Tables that travel alone describe
//! themselves in keys of their own ([`Levels::metadata`]).

use ::ktx2::dfd::{Basic, Block};
use ::ktx2::{Format, Header, Index, LevelIndex, ParseError, SupercompressionScheme};
use luthier_lut::{Image, TexelFormat};

use crate::error::Container;
use crate::size::checked_bytes;
use crate::texels::TexelLayout;
use crate::{Metadata, Samples, Texture, TextureError, metadata, zstd};

/// Value of the `KTXwriter` entry.
const WRITER: &str = concat!("luthier ", env!("CARGO_PKG_VERSION"));

/// Bytes of the descriptor section that may differ from ours without a change of meaning: colour primaries, alpha
/// flags, and the plane sizes, which some writers leave 0 under supercompression.
const FREE_DFD_BYTES: [std::ops::Range<usize>; 3] = [13..14, 15..16, 20..28];

/// A KTX2 file of a texture: header, level index, descriptor, the writer's name, zstd texels.
///
/// # Errors
/// [`TextureError::Size`], [`TextureError::Length`] when the bytes do not fit the size.
pub fn encode(texture: &Texture) -> Result<Vec<u8>, TextureError> {
    write(&Levels::one(texture), Some(SupercompressionScheme::Zstandard))
}

/// A KTX2 file of a texture with uncompressed texels, for readers without a decoder of zstd.
///
/// # Errors
/// As [`encode`].
pub fn encode_plain(texture: &Texture) -> Result<Vec<u8>, TextureError> {
    write(&Levels::one(texture), None)
}

/// A KTX2 file of a map or a cube with levels, with zstd or without. The smallest level comes first, as the
/// specification requires.
///
/// # Errors
/// As [`encode`]; [`TextureError::Length`] for a number of faces other than 1 or 6, or for more levels than the sides
/// can be halved; and [`TextureError::Metadata`].
pub fn encode_levels(levels: &Levels<'_>, is_compressed: bool) -> Result<Vec<u8>, TextureError> {
    write(levels, is_compressed.then_some(SupercompressionScheme::Zstandard))
}

/// Texels of a map or a cube, level by level.
///
/// ```
/// use luthier_lut::TexelFormat;
/// use luthier_texture::ktx2::{Levels, encode_levels};
///
/// let levels = vec![vec![255; 16].into(), vec![255; 4].into()];
/// let (format, metadata) = (TexelFormat::Rgba8Unorm, Vec::new());
/// let file = encode_levels(&Levels { format, width: 2, height: 2, faces: 1, levels, metadata }, false)?;
/// assert_eq!(file[40..44], 2_u32.to_le_bytes()); // levelCount of the header
/// # Ok::<(), luthier_texture::TextureError>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Levels<'a> {
    /// Format of the texels.
    pub format: TexelFormat,
    /// Texels across, of the largest level. Each level has half the sides of the one before.
    pub width: u32,
    /// Texels down.
    pub height: u32,
    /// 1, or the 6 faces of a cube: +x, -x, +y, -y, +z, -z.
    pub faces: u32,
    /// The faces of each level one after another, the largest level first.
    pub levels: Vec<std::borrow::Cow<'a, [u8]>>,
    /// Statements of the file about itself, beside its writer. Their keys begin with a small letter.
    pub metadata: Metadata,
}

impl<'a> Levels<'a> {
    /// A texture of one level.
    pub fn one(texture: &'a Texture) -> Self {
        let Texture { format, width, height, ref bytes } = *texture;
        Self { format, width, height, faces: 1, levels: vec![bytes.as_slice().into()], metadata: Metadata::new() }
    }
}

fn write(texture: &Levels<'_>, scheme: Option<SupercompressionScheme>) -> Result<Vec<u8>, TextureError> {
    level_bytes(texture.format, texture.width, texture.height)?;
    let count = texture.levels.len() as u32;
    let is_map = texture.faces == 1 || texture.faces == 6 && texture.width == texture.height;
    if !is_map || count == 0 || count > texture.width.max(texture.height).ilog2() + 1 {
        return Err(TextureError::Length { found: texture.levels.len(), expected: 1 });
    }
    for (level, bytes) in (0..).zip(&texture.levels) {
        let [width, height] = [texture.width, texture.height].map(|side| (side >> level).max(1));
        let expected = level_bytes(texture.format, width, height)? * texture.faces as usize;
        if bytes.len() != expected {
            return Err(TextureError::Length { found: bytes.len(), expected });
        }
    }

    let (descriptor, type_size) = descriptor_section(texture.format)?;
    let key_values = key_value_section(&texture.metadata)?;
    let alignment = if scheme.is_some() { 1 } else { block_bytes(texture.format) };
    let stored: Vec<std::borrow::Cow<'_, [u8]>> = match scheme {
        Some(_) => {
            let packed = texture.levels.iter().map(|bytes| Ok(zstd::compress(bytes)?.into()));
            packed.collect::<Result<_, TextureError>>()?
        }
        None => texture.levels.clone(),
    };

    // Descriptor and key/value entries are multiples of 4 bytes. Plain levels lie at multiples of 4 and of the bytes of
    // a block of texels; supercompressed levels need no alignment.
    let descriptor_at = Header::LENGTH + LevelIndex::LENGTH * stored.len();
    let key_values_at = descriptor_at + descriptor.len();
    let key_values_end = key_values_at + key_values.len();
    let texels_at = key_values_end.next_multiple_of(alignment);
    let header = Header {
        format: Some(vulkan_format(texture.format)),
        type_size,
        pixel_width: texture.width,
        pixel_height: texture.height,
        pixel_depth: 0,
        layer_count: 0,
        face_count: texture.faces,
        level_count: count,
        supercompression_scheme: scheme,
        index: Index {
            dfd_byte_offset: descriptor_at as u32,
            dfd_byte_length: descriptor.len() as u32,
            kvd_byte_offset: key_values_at as u32,
            kvd_byte_length: key_values.len() as u32,
            sgd_byte_offset: 0,
            sgd_byte_length: 0,
        },
    };
    let mut body = vec![0; texels_at - key_values_end];
    let mut index = vec![Vec::new(); stored.len()];
    // The smallest level comes first.
    for (level, bytes) in stored.iter().enumerate().rev() {
        let end = key_values_end + body.len();
        body.resize(body.len() + end.next_multiple_of(alignment) - end, 0);
        let entry = LevelIndex {
            byte_offset: (key_values_end + body.len()) as u64,
            byte_length: bytes.len() as u64,
            uncompressed_byte_length: texture.levels[level].len() as u64,
        };
        index[level] = entry.as_bytes().to_vec();
        body.extend_from_slice(bytes);
    }
    Ok([&header.as_bytes(), index.concat().as_slice(), &descriptor, &key_values, &body].concat())
}

/// Reads a KTX2 file of the shape that [`encode`] writes, with zstd or no supercompression. Of the key/value data only
/// the orientation counts.
///
/// # Errors
/// [`TextureError::Malformed`] and [`TextureError::Zstd`] for damaged files, [`TextureError::Unsupported`] for other
/// formats and shapes, [`TextureError::Size`].
pub fn decode(file: &[u8]) -> Result<Texture, TextureError> {
    let header = header(file)?;
    let format = texel_format(&header)?;
    check_shape(&header)?;
    let expected = level_bytes(format, header.pixel_width, header.pixel_height)?;

    let index = header.index;
    let descriptor = section(file, index.dfd_byte_offset.into(), index.dfd_byte_length.into())?;
    if !describes(descriptor, &descriptor_section(format)?.0) {
        return Err(malformed("the data format descriptor contradicts the format"));
    }
    check_orientation(section(file, index.kvd_byte_offset.into(), index.kvd_byte_length.into())?)?;

    let bytes = first_level(file, &header, expected)?;
    Ok(Texture { format, width: header.pixel_width, height: header.pixel_height, bytes })
}

/// Reads the largest level of a two-dimensional KTX2 file of uncompressed texels by any maker, with zstd or no
/// supercompression. The header states the format. The descriptor does not count, because some writers get it wrong.
///
/// # Errors
/// As [`decode`].
pub(crate) fn decode_table(file: &[u8]) -> Result<(TexelLayout, Image), TextureError> {
    let header = header(file)?;
    let layout = header.format.and_then(table_layout).ok_or_else(|| match header.format {
        Some(format) => unsupported(format!("{format:?} texels")),
        None => unsupported("texels of undefined format"),
    })?;
    let Header { pixel_width, pixel_height, pixel_depth, layer_count, face_count, .. } = header;
    if pixel_depth != 0 || layer_count > 1 || face_count != 1 {
        return Err(unsupported("a texture that is not two-dimensional, or several layers or faces"));
    }
    // A texture of one dimension states no height.
    let height = pixel_height.max(1);
    let expected = checked_bytes(pixel_width, height, layout.texel_bytes())?;
    let bytes = first_level(file, &header, expected)?;
    Ok((layout, layout.image(pixel_width, height, &bytes)))
}

/// The bytes of a level of whole blocks.
fn level_bytes(format: TexelFormat, width: u32, height: u32) -> Result<usize, TextureError> {
    let side = format.block_side();
    if !width.is_multiple_of(side) || !height.is_multiple_of(side) {
        return Err(TextureError::Size { width, height });
    }
    checked_bytes(width, height, format.texel_bytes())
}

/// Bytes of a texel, or of a block of them.
fn block_bytes(format: TexelFormat) -> usize {
    let side = format.block_side();
    (side * side * format.texel_bytes()) as usize
}

fn table_layout(format: Format) -> Option<TexelLayout> {
    let (samples, channels) = match format {
        Format::R8_UNORM => (Samples::Unorm8, 1),
        Format::R8G8_UNORM => (Samples::Unorm8, 2),
        Format::R8G8B8_UNORM | Format::R8G8B8_SRGB => (Samples::Unorm8, 3),
        Format::R8G8B8A8_UNORM | Format::R8G8B8A8_SRGB | Format::B8G8R8A8_UNORM => (Samples::Unorm8, 4),
        Format::A2B10G10R10_UNORM_PACK32 => (Samples::Unorm10, 4),
        Format::R16_UNORM => (Samples::Unorm16, 1),
        Format::R16G16_UNORM => (Samples::Unorm16, 2),
        Format::R16G16B16_UNORM => (Samples::Unorm16, 3),
        Format::R16G16B16A16_UNORM => (Samples::Unorm16, 4),
        Format::R16_SFLOAT => (Samples::Half, 1),
        Format::R16G16_SFLOAT => (Samples::Half, 2),
        Format::R16G16B16_SFLOAT => (Samples::Half, 3),
        Format::R16G16B16A16_SFLOAT => (Samples::Half, 4),
        Format::R32_SFLOAT => (Samples::Float, 1),
        Format::R32G32_SFLOAT => (Samples::Float, 2),
        Format::R32G32B32_SFLOAT => (Samples::Float, 3),
        Format::R32G32B32A32_SFLOAT => (Samples::Float, 4),
        _ => return None,
    };
    let srgb = matches!(format, Format::R8G8B8A8_SRGB | Format::R8G8B8_SRGB);
    Some(TexelLayout { samples, channels, bgr: format == Format::B8G8R8A8_UNORM, srgb })
}

fn header(file: &[u8]) -> Result<Header, TextureError> {
    let fixed = file.first_chunk().ok_or_else(|| malformed("it ends within the header"))?;
    Header::from_bytes(fixed).map_err(|error| {
        malformed(match error {
            ParseError::BadMagic => "it does not begin with the KTX 2.0 identifier",
            ParseError::ZeroWidth => "the width is 0",
            ParseError::ZeroFaceCount => "there are 0 faces",
            _ => "the header does not parse",
        })
    })
}

/// The texels of the first level, the largest.
fn first_level(file: &[u8], header: &Header, expected: usize) -> Result<Vec<u8>, TextureError> {
    let level = section(file, Header::LENGTH as u64, LevelIndex::LENGTH as u64)?;
    let level = LevelIndex::from_bytes(level.first_chunk().ok_or_else(|| malformed("the level index is missing"))?);
    if level.uncompressed_byte_length != expected as u64 {
        return Err(malformed("the level has another length than its size and format need"));
    }
    let stored = section(file, level.byte_offset, level.byte_length)?;
    match header.supercompression_scheme {
        None if stored.len() == expected => Ok(stored.to_vec()),
        None => Err(malformed("the level has another length than its size and format need")),
        Some(SupercompressionScheme::Zstandard) => zstd::decompress(stored, expected),
        Some(other) => Err(unsupported(format!("{other:?} supercompression"))),
    }
}

fn malformed(reason: &'static str) -> TextureError {
    TextureError::malformed(Container::Ktx2, reason)
}

fn unsupported(what: impl Into<std::borrow::Cow<'static, str>>) -> TextureError {
    TextureError::unsupported(Container::Ktx2, what)
}

fn vulkan_format(format: TexelFormat) -> Format {
    match format {
        TexelFormat::R16Float => Format::R16_SFLOAT,
        TexelFormat::Rg16Float => Format::R16G16_SFLOAT,
        TexelFormat::R32Float => Format::R32_SFLOAT,
        TexelFormat::Rgba8Unorm => Format::R8G8B8A8_UNORM,
        TexelFormat::Rgb10a2Unorm => Format::A2B10G10R10_UNORM_PACK32,
        TexelFormat::Rg11b10Ufloat => Format::B10G11R11_UFLOAT_PACK32,
        TexelFormat::Rgba16Unorm => Format::R16G16B16A16_UNORM,
        TexelFormat::Bc6hRgbUfloat => Format::BC6H_UFLOAT_BLOCK,
        TexelFormat::Rgba16Float => Format::R16G16B16A16_SFLOAT,
        TexelFormat::Rgba32Float => Format::R32G32B32A32_SFLOAT,
        TexelFormat::Rgba16FloatSteps => Format::R32G32B32A32_UINT,
    }
}

fn texel_format(header: &Header) -> Result<TexelFormat, TextureError> {
    let found = TexelFormat::ALL.into_iter().find(|&format| Some(vulkan_format(format)) == header.format);
    found.ok_or_else(|| match header.format {
        Some(format) => unsupported(format!("{format:?} texels")),
        None => unsupported("texels of undefined format"),
    })
}

fn check_shape(header: &Header) -> Result<(), TextureError> {
    let Header { pixel_height, pixel_depth, layer_count, face_count, level_count, .. } = *header;
    if pixel_height == 0 || pixel_depth != 0 {
        Err(unsupported("a texture that is not two-dimensional"))
    } else if layer_count != 0 || face_count != 1 || level_count > 1 {
        Err(unsupported("several layers, faces or levels"))
    } else {
        Ok(())
    }
}

/// The descriptor section (its length, then one basic block), and the type size of the header for endian conversion.
fn descriptor_section(format: TexelFormat) -> Result<(Vec<u8>, u32), TextureError> {
    let (basic, type_size) = Basic::from_format(vulkan_format(format))
        .map_err(|_| unsupported(format!("{format} texels, for which there is no descriptor")))?;
    let block = Block::Basic(basic).to_vec();
    let length = (block.len() + 4) as u32;
    Ok(([length.to_le_bytes().as_slice(), &block].concat(), type_size))
}

/// Whether two descriptor sections mean the same texels.
fn describes(found: &[u8], expected: &[u8]) -> bool {
    let mut bytes = found.iter().zip(expected).enumerate();
    found.len() == expected.len()
        && bytes.all(|(i, (a, b))| a == b || FREE_DFD_BYTES.iter().any(|range| range.contains(&i)))
}

/// Entries by section 3.11 of the specification, sorted by key: length, key, NUL, value, NUL, padding to 4 bytes.
fn key_value_section(metadata: &Metadata) -> Result<Vec<u8>, TextureError> {
    metadata::check(metadata)?;
    if let Some((key, _)) = metadata.iter().find(|(key, _)| !key.starts_with(|c: char| c.is_ascii_lowercase())) {
        return Err(TextureError::Metadata {
            key: key.clone(),
            reason: "a key of KTX2 begins with a small letter here",
        });
    }
    let mut entries: Vec<(&str, &str)> = metadata.iter().map(|(key, value)| (key.as_str(), value.as_str())).collect();
    entries.push(("KTXwriter", WRITER));
    entries.sort_unstable();
    let mut section = Vec::new();
    for (key, value) in entries {
        let entry = [key, "\0", value, "\0"].concat();
        section.extend_from_slice(&(entry.len() as u32).to_le_bytes());
        section.extend_from_slice(entry.as_bytes());
        section.resize(section.len().next_multiple_of(4), 0);
    }
    Ok(section)
}

/// The fault of key/value data that end within an entry.
const CUT_OFF: &str = "a key/value entry is cut off";

/// Checks that the key/value data hold whole entries, and that rows go from the top down. A file that does not state it
/// means the same.
fn check_orientation(mut section: &[u8]) -> Result<(), TextureError> {
    while let Some((length, rest)) = section.split_first_chunk() {
        let length = u32::from_le_bytes(*length) as usize;
        let entry = rest.get(..length).ok_or_else(|| malformed(CUT_OFF))?;
        section = rest.get(length.next_multiple_of(4)..).unwrap_or_default();
        let key_end = entry.iter().position(|&b| b == 0).ok_or_else(|| malformed("a key does not end"))?;
        if &entry[..key_end] == b"KTXorientation" && !entry[key_end + 1..].starts_with(b"rd") {
            return Err(unsupported("rows from the bottom or columns from the right"));
        }
    }
    if section.is_empty() { Ok(()) } else { Err(malformed(CUT_OFF)) }
}

fn section(file: &[u8], offset: u64, length: u64) -> Result<&[u8], TextureError> {
    let range = usize::try_from(offset).ok().zip(offset.checked_add(length).and_then(|end| usize::try_from(end).ok()));
    range.and_then(|(start, end)| file.get(start..end)).ok_or_else(|| malformed("a section lies outside the file"))
}

#[cfg(test)]
mod tests;
