//! OpenEXR: single-part scan-line images of 32-bit floats, ZIP-compressed (lossless), through the `exr` crate.
//!
//! The `exr` crate keeps custom attributes in a hash map, whose order differs from run to run. All metadata are
//! therefore one attribute, so that bytes do not differ: `luthier`, a string with a JSON object of strings, sorted by
//! key.

pub(crate) mod dwa;

use std::borrow::Cow;
use std::collections::BTreeMap;
use std::io::Cursor;

use ::exr::block;
use ::exr::block::UncompressedBlock;
use ::exr::block::reader::ChunksReader;
use ::exr::error::Error;
use ::exr::meta::attribute::{AttributeValue, ChannelList, Compression, LineOrder, SampleType, Text};
use ::exr::meta::header::{Header, LayerAttributes};
use ::exr::meta::{BlockDescription, MetaData};
use ::exr::prelude::{
    AnyChannel, AnyChannels, Blocks, Encoding, FlatSamples, Image as ExrImage, Layer, SmallVec, Vec2, WritableImage,
};
use luthier_lut::Image;

use crate::error::Container;
use crate::size::{check_image, checked_bytes};
use crate::{Metadata, TextureError, metadata};

/// Name of the attribute that holds the metadata.
const ATTRIBUTE: &str = "luthier";
/// Key with the value of the standard attribute `software`.
const GENERATOR: &str = "generator";

/// Names of the channels of a picture.
pub const RGB: [&str; 3] = ["R", "G", "B"];

/// An EXR file of an image, bit-exact, with a name for each of its channels. Metadata become the JSON object described
/// above. The value of `generator` is also the standard attribute `software`.
///
/// # Errors
/// [`TextureError::Size`], [`TextureError::Channels`] if names and channels differ in number, [`TextureError::Length`],
/// [`TextureError::Metadata`], [`TextureError::ExrEncode`].
pub fn encode(image: &Image, names: &[&str], metadata: &Metadata) -> Result<Vec<u8>, TextureError> {
    check_image(image)?;
    metadata::check(metadata)?;
    let channels = image.channels as usize;
    if names.len() != channels {
        return Err(TextureError::Channels(image.channels));
    }
    let planes = names.iter().enumerate().map(|(c, &name)| {
        let values = image.data.iter().skip(c).step_by(channels).copied();
        AnyChannel::new(name, FlatSamples::F32(values.collect()))
    });

    let mut attributes = LayerAttributes::default();
    if !metadata.is_empty() {
        let object: BTreeMap<&str, &str> = metadata.iter().map(|(key, value)| (key.as_str(), value.as_str())).collect();
        let json = serde_json::to_string(&object)
            .map_err(|_| TextureError::Metadata { key: ATTRIBUTE.into(), reason: "it cannot be written as JSON" })?;
        attributes.other.insert(Text::from(ATTRIBUTE), AttributeValue::Text(utf8(&json)));
        attributes.software_name = object.get(GENERATOR).map(|name| utf8(name));
    }
    let encoding =
        Encoding { compression: Compression::ZIP16, blocks: Blocks::ScanLines, line_order: LineOrder::Increasing };
    let size = (image.width as usize, image.height as usize);
    let layer = Layer::new(size, attributes, encoding, AnyChannels::sort(planes.collect()));

    let mut file = Cursor::new(Vec::new());
    ExrImage::from_layer(layer).write().non_parallel().to_buffered(&mut file).map_err(TextureError::ExrEncode)?;
    Ok(file.into_inner())
}

/// Reads an EXR file of the shape that [`encode`] writes: one part, scan lines from the top, one to four channels of
/// 32-bit float, uncompressed or ZIP. Channels come in the order R, G, B, A, X, Y, Z, V, then the others by name. The
/// metadata are sorted by key, and empty in files of other makers.
///
/// # Errors
/// [`TextureError::Malformed`] and [`TextureError::ExrDecode`] for damaged files, [`TextureError::Unsupported`] for
/// other shapes, [`TextureError::Size`].
pub fn decode(file: &[u8]) -> Result<(Image, Metadata), TextureError> {
    let reader = block::read(Cursor::new(file), true).map_err(read_error)?;
    let [header] = reader.headers() else { return Err(unsupported("several parts")) };
    let places = channel_places(&header.channels)?;
    let (width, height, channels) = (side(header.layer_size.0), side(header.layer_size.1), places.len());
    let values = checked_bytes(width, height, 4 * channels as u32)? / 4;
    check_shape(header)?;
    let metadata = read_metadata(header)?;

    // Rows are appended as they come, so that memory follows the data found.
    let row_values = width as usize * channels;
    let mut data = Vec::new();
    let blocks = reader.all_chunks(true).map_err(read_error)?;
    let mut in_order = true;
    blocks
        .decompress_sequential(true, |meta, block| {
            in_order &= block.index.pixel_position == Vec2(0, data.len() / row_values);
            if in_order {
                append_rows(&mut data, meta, &block, &places);
            }
            Ok(())
        })
        .map_err(read_error)?;
    if !in_order {
        return Err(unsupported("rows in another order than from the top"));
    }
    if data.len() != values {
        return Err(malformed("it has fewer rows than it states"));
    }
    Ok((Image { width, height, channels: channels as u32, data }, metadata))
}

/// Appends the rows of a block, channels interleaved. `places` has the place in a texel of each channel of the file.
fn append_rows(data: &mut Vec<f32>, meta: &MetaData, block: &UncompressedBlock, places: &[usize]) {
    let Vec2(width, height) = block.index.pixel_size;
    let start = data.len();
    data.resize(start + width * height * places.len(), 0.0);
    for line in meta.headers.iter().flat_map(|header| block.lines(&header.channels)) {
        let row = line.location.position.1 - block.index.pixel_position.1;
        let first = start + row * width * places.len() + places[line.location.channel];
        let texels = data[first..].iter_mut().step_by(places.len());
        for (value, bytes) in texels.zip(line.value.as_chunks().0) {
            *value = f32::from_ne_bytes(*bytes);
        }
    }
}

/// Sort key of a channel among those of its image, by name.
pub(crate) fn rank(name: &str) -> (usize, String) {
    let known = "RGBAXYZV".find(name).filter(|_| name.len() == 1);
    (known.unwrap_or(usize::MAX), name.to_owned())
}

/// The place in a texel of each channel of the file.
fn channel_places(channels: &ChannelList) -> Result<SmallVec<[usize; 4]>, TextureError> {
    let count = u32::try_from(channels.list.len()).unwrap_or(u32::MAX);
    if !(1..=4).contains(&count) {
        return Err(TextureError::Channels(count));
    }
    if channels.list.iter().any(|channel| channel.sample_type != SampleType::F32 || channel.sampling != Vec2(1, 1)) {
        return Err(unsupported("channels that are subsampled or not 32-bit float"));
    }
    // The crate has checked that names are distinct.
    let ranks: Vec<_> = channels.list.iter().map(|channel| rank(&channel.name.to_string())).collect();
    Ok(ranks.iter().map(|rank| ranks.iter().filter(|other| *other < rank).count()).collect())
}

fn check_shape(header: &Header) -> Result<(), TextureError> {
    if header.deep || header.blocks != BlockDescription::ScanLines {
        return Err(unsupported("tiles or deep data"));
    }
    match header.compression {
        Compression::Uncompressed | Compression::ZIP1 | Compression::ZIP16 => Ok(()),
        _ => Err(unsupported("a compression other than none and ZIP")),
    }
}

fn read_metadata(header: &Header) -> Result<Metadata, TextureError> {
    let Some(value) = header.own_attributes.other.get(ATTRIBUTE.as_bytes()) else { return Ok(Metadata::new()) };
    let AttributeValue::Text(json) = value else { return Err(malformed("the attribute `luthier` is not a string")) };
    let object: BTreeMap<String, String> = serde_json::from_slice(json.as_slice())
        .map_err(|_| malformed("the attribute `luthier` is not a JSON object of strings"))?;
    Ok(object.into_iter().collect())
}

/// A side as `u32`. Larger ones become its maximum, which no limit lets pass.
pub(crate) fn side(length: usize) -> u32 {
    u32::try_from(length).unwrap_or(u32::MAX)
}

/// A string of UTF-8. The crate's own constructor takes Latin-1 only; the format allows both.
fn utf8(text: &str) -> Text {
    Text::from_slice_unchecked(text.as_bytes())
}

pub(crate) fn read_error(error: Error) -> TextureError {
    match error {
        Error::NotSupported(what) if what.contains("subsampling") => {
            unsupported("subsampled channels (luminance and chroma, Y, RY and BY, are to be saved as R, G and B)")
        }
        Error::NotSupported(what) if what.contains("deep data") => unsupported("deep data (it is to be flattened)"),
        Error::NotSupported(what) => TextureError::unsupported(Container::Exr, what),
        error => TextureError::ExrDecode(error),
    }
}

pub(crate) fn malformed(reason: impl Into<Cow<'static, str>>) -> TextureError {
    TextureError::malformed(Container::Exr, reason)
}

fn unsupported(what: &'static str) -> TextureError {
    TextureError::unsupported(Container::Exr, what)
}

#[cfg(test)]
mod tests;
