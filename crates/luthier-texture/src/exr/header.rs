use super::blocks::{Compression, ImageShape};
use super::{PREFIX, malformed, unsupported};
use crate::{Metadata, TextureError};

const MAGIC: [u8; 4] = 20_000_630_u32.to_le_bytes();
/// Format version 2; the other bits are flags.
const VERSION: u32 = 2;
/// Flag: names may have up to 255 bytes rather than 31.
const LONG_NAMES: u32 = 1 << 10;
const SHORT_NAME: usize = 31;
const LONG_NAME: usize = 255;
/// Pixel type of a channel.
const FLOAT: i32 = 2;

/// What the file says about its pixels.
pub(super) struct Header {
    pub(super) shape: ImageShape,
    /// Row number of the first row.
    pub(super) top: i32,
    pub(super) compression: Compression,
    /// For each channel in the file, its place in the image.
    pub(super) channel_order: Vec<usize>,
    pub(super) metadata: Metadata,
}

/// Channel names in the order of the image.
fn channel_names(channels: u32) -> &'static [&'static str] {
    match channels {
        1 => &["Y"],
        2 => &["Y", "A"],
        3 => &["R", "G", "B"],
        _ => &["R", "G", "B", "A"],
    }
}

/// Places in the image of the channels in the order of the file, which is alphabetical.
pub(super) fn file_order(channels: u32) -> Vec<usize> {
    let names = channel_names(channels);
    let mut order: Vec<usize> = (0..names.len()).collect();
    order.sort_by_key(|&i| names[i]);
    order
}

pub(super) fn write(shape: ImageShape, compression: Compression, metadata: &Metadata) -> Vec<u8> {
    let mut channels = Vec::new();
    for i in file_order(shape.channels) {
        channels.extend_from_slice(channel_names(shape.channels)[i].as_bytes());
        channels.push(0);
        // Type; perceptually linear: no, and three bytes of padding; sampling in x and y.
        for word in [FLOAT, 0, 1, 1] {
            channels.extend_from_slice(&word.to_le_bytes());
        }
    }
    channels.push(0);
    let window = [0, 0, shape.width as i32 - 1, shape.height as i32 - 1].map(i32::to_le_bytes).concat();
    let one = 1.0_f32.to_le_bytes();

    let mut attributes = Vec::new();
    let mut attribute = |name: &str, kind: &str, value: &[u8]| {
        for text in [name, kind] {
            attributes.extend_from_slice(text.as_bytes());
            attributes.push(0);
        }
        attributes.extend_from_slice(&(value.len() as i32).to_le_bytes());
        attributes.extend_from_slice(value);
    };
    attribute("channels", "chlist", &channels);
    attribute("compression", "compression", &[compression.code()]);
    attribute("dataWindow", "box2i", &window);
    attribute("displayWindow", "box2i", &window);
    attribute("lineOrder", "lineOrder", &[0]);
    attribute("pixelAspectRatio", "float", &one);
    attribute("screenWindowCenter", "v2f", &[0; 8]);
    attribute("screenWindowWidth", "float", &one);
    let mut longest = 0;
    for (key, value) in metadata {
        let name = format!("{PREFIX}{key}");
        longest = longest.max(name.len());
        attribute(&name, "string", value.as_bytes());
    }
    attributes.push(0);

    let flags = if longest > SHORT_NAME { LONG_NAMES } else { 0 };
    [MAGIC.as_slice(), &(VERSION | flags).to_le_bytes(), &attributes].concat()
}

/// Reads the header; gives what follows it as well.
pub(super) fn read(file: &[u8]) -> Result<(Header, &[u8]), TextureError> {
    let mut bytes = Bytes { rest: file };
    if bytes.take(4)? != MAGIC {
        return Err(malformed("it does not begin with the OpenEXR magic number"));
    }
    let version = bytes.u32()?;
    if version & 0xff != VERSION {
        return Err(unsupported("a version other than 2"));
    }
    if version & !0xff & !LONG_NAMES != 0 {
        return Err(unsupported("tiles, deep data or several parts"));
    }

    let (mut channels, mut compression, mut window) = (None, None, None);
    let mut metadata = Metadata::new();
    loop {
        let name = bytes.name()?;
        if name.is_empty() {
            break;
        }
        let kind = bytes.name()?;
        let length = bytes.u32()?;
        let value = bytes.take(length as usize)?;
        match (name, kind) {
            ("channels", "chlist") => channels = Some(read_channels(value)?),
            ("compression", "compression") => compression = Some(Compression::from_code(value)?),
            ("dataWindow", "box2i") => window = Some(read_window(value)?),
            (name, "string") => {
                if let Some(key) = name.strip_prefix(PREFIX) {
                    let value = std::str::from_utf8(value).map_err(|_| malformed("an attribute is not UTF-8"))?;
                    metadata.push((key.to_owned(), value.to_owned()));
                }
            }
            _ => {}
        }
    }
    let channel_order = channels.ok_or_else(|| malformed("there is no channel list"))?;
    let compression = compression.ok_or_else(|| malformed("there is no compression attribute"))?;
    let (width, height, top) = window.ok_or_else(|| malformed("there is no data window"))?;
    let shape = ImageShape { width, height, channels: channel_order.len() as u32 };
    Ok((Header { shape, top, compression, channel_order, metadata }, bytes.rest))
}

fn read_channels(list: &[u8]) -> Result<Vec<usize>, TextureError> {
    let mut bytes = Bytes { rest: list };
    let mut names = Vec::new();
    loop {
        let name = bytes.name()?;
        if name.is_empty() {
            break;
        }
        let words = [bytes.u32()?, bytes.u32()?, bytes.u32()?, bytes.u32()?];
        if words[0] != FLOAT as u32 {
            return Err(unsupported("channels that are not 32-bit float"));
        }
        if words[2..] != [1, 1] {
            return Err(unsupported("subsampled channels"));
        }
        names.push(name);
    }
    let wanted = channel_names(names.len() as u32);
    let order: Vec<usize> = names.iter().filter_map(|name| wanted.iter().position(|w| w == name)).collect();
    let mut places = order.clone();
    places.sort_unstable();
    if names.len() == wanted.len() && places.iter().copied().eq(0..wanted.len()) {
        Ok(order)
    } else {
        Err(unsupported("channels other than Y, YA, RGB or RGBA"))
    }
}

/// Width, height and first row number. Sides beyond `u32` become its maximum, which no limit lets pass.
fn read_window(value: &[u8]) -> Result<(u32, u32, i32), TextureError> {
    let mut bytes = Bytes { rest: value };
    let mut corner = || Ok::<i32, TextureError>(bytes.u32()? as i32);
    let [left, top, right, bottom] = [corner()?, corner()?, corner()?, corner()?];
    let side =
        |first: i32, last: i32| u32::try_from((i64::from(last) - i64::from(first) + 1).max(0)).unwrap_or(u32::MAX);
    Ok((side(left, right), side(top, bottom), top))
}

struct Bytes<'a> {
    rest: &'a [u8],
}

impl<'a> Bytes<'a> {
    fn take(&mut self, count: usize) -> Result<&'a [u8], TextureError> {
        let (taken, rest) = self.rest.split_at_checked(count).ok_or_else(|| malformed("it ends within the header"))?;
        self.rest = rest;
        Ok(taken)
    }

    fn u32(&mut self) -> Result<u32, TextureError> {
        let bytes = self.take(4)?;
        Ok(u32::from_le_bytes([bytes[0], bytes[1], bytes[2], bytes[3]]))
    }

    /// A name that ends in NUL; empty at the end of a list.
    fn name(&mut self) -> Result<&'a str, TextureError> {
        let end = self.rest.iter().take(LONG_NAME + 1).position(|&b| b == 0);
        let name = self.take(end.ok_or_else(|| malformed("a name in the header does not end"))?)?;
        self.take(1)?;
        std::str::from_utf8(name).map_err(|_| malformed("a name in the header is not text"))
    }
}
