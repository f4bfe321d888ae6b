//! Tables of other programs, to read: DDS, KTX2, EXR, PNG, Radiance HDR or raw values, in the formats that tables come
//! in.
//!
//! [`read`] tells the container by its first bytes. Values are those of a sampler: unsigned normalised over their
//! maximum, sRGB formats of DDS and KTX2 linearised. PNG files do not state their content, so their values stay as
//! stored. The largest level of the first layer is read. Cube maps, volumes and block-compressed formats are refused.

use std::io::Cursor;

use ::exr::prelude::{FlatSamples, ReadChannels, ReadLayers, read as read_exr};
use luthier_lut::Image;

use crate::error::Container;
use crate::limits::is_plausible;
use crate::size::checked_bytes;
use crate::texels::{Samples, TexelLayout};
use crate::{TextureError, dds, exr, ktx2, png, radiance};

/// A table as read from a file.
///
/// ```
/// use luthier_texture::{Samples, table};
///
/// let table = table::raw(&[0, 255], 2, 1, 1, Samples::Unorm8)?;
/// assert_eq!((table.image.data, table.format.as_str()), (vec![0.0, 1.0], "raw r8unorm"));
/// # Ok::<(), luthier_texture::TextureError>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Table {
    /// Its values, 1 to 4 channels in the order R, G, B, A.
    pub image: Image,
    /// How one value is stored.
    pub samples: Samples,
    /// The file format, and the name of the texel format if it has one.
    pub format: String,
    /// A sentence for each part of the file that was converted or left out.
    pub notes: Vec<String>,
}

/// Reads a table of any container but raw.
///
/// # Errors
/// [`TextureError`] for damaged files, formats that are not read, and sizes beyond the limits.
pub fn read(file: &[u8]) -> Result<Table, TextureError> {
    if file.starts_with(b"DDS ") {
        let (layout, image) = dds::decode(file)?;
        Ok(Table { image, samples: layout.samples, format: format!("DDS {layout}"), notes: Vec::new() })
    } else if file.starts_with(b"\xabKTX 20\xbb\r\n\x1a\n") {
        let (layout, image) = ktx2::decode_table(file)?;
        Ok(Table { image, samples: layout.samples, format: format!("KTX2 {layout}"), notes: Vec::new() })
    } else if file.starts_with(b"\x89PNG") {
        let (image, bits) = png::decode_table(file)?;
        let samples = if bits == 16 { Samples::Unorm16 } else { Samples::Unorm8 };
        Ok(Table { image, samples, format: format!("PNG, {bits} bits"), notes: Vec::new() })
    } else if file.starts_with(&[0x76, 0x2f, 0x31, 0x01]) {
        exr_table(file)
    } else if file.starts_with(b"#?") {
        let radiance::Picture { image, notes } = radiance::decode(file)?;
        // Eight bits of mantissa.
        Ok(Table { image, samples: Samples::Unorm8, format: "Radiance HDR".to_owned(), notes })
    } else {
        Err(TextureError::UnknownContainer)
    }
}

/// Reads values without a header: rows from the top, channels interleaved, little-endian.
///
/// # Errors
/// [`TextureError::Size`], [`TextureError::Channels`], and [`TextureError::Length`] (in values) when the bytes do not fit.
pub fn raw(file: &[u8], width: u32, height: u32, channels: u32, samples: Samples) -> Result<Table, TextureError> {
    // Ten-bit texels are words of four values.
    if !(1..=4).contains(&channels) || samples == Samples::Unorm10 && channels != 4 {
        return Err(TextureError::Channels(channels));
    }
    let layout = TexelLayout::of(samples, channels);
    let expected = checked_bytes(width, height, layout.texel_bytes())?;
    if file.len() != expected {
        let bytes = layout.texel_bytes() as usize / channels as usize;
        return Err(TextureError::Length { found: file.len() / bytes, expected: expected / bytes });
    }
    Ok(Table { image: layout.image(width, height, file), samples, format: format!("raw {layout}"), notes: Vec::new() })
}

/// Reads the first layer of an EXR file without deep data, of any compression. Channels come in the order R, G, B, A,
/// X, Y, Z, V, then the others by name.
fn exr_table(file: &[u8]) -> Result<Table, TextureError> {
    // All sizes are checked before anything is allocated for them.
    let meta = ::exr::meta::MetaData::read_from_buffered(Cursor::new(file), true).map_err(exr::read_error)?;
    for header in &meta.headers {
        let [width, height] = [header.layer_size.0, header.layer_size.1].map(exr::side);
        let channels = exr::side(header.channels.list.len());
        if !(1..=4).contains(&channels) {
            return Err(TextureError::Channels(channels));
        }
        let stored = header.channels.list.iter().map(|channel| channel.sample_type.bytes_per_sample()).sum();
        checked_bytes(width, height, exr::side(stored))?;
        if !is_plausible(file, 4 * u64::from(channels) * u64::from(width) * u64::from(height)) {
            let reason = format!("{} bytes are too short for {width} x {height} texels", file.len());
            return Err(exr::malformed(reason));
        }
    }
    exr::dwa::check(file)?;
    let image = read_exr()
        .no_deep_data()
        .largest_resolution_level()
        .all_channels()
        .first_valid_layer()
        .all_attributes()
        .non_parallel()
        .from_buffered(Cursor::new(file))
        .map_err(exr::read_error)?;
    let layer = image.layer_data;
    let (width, height) = (layer.size.0 as u32, layer.size.1 as u32);
    let mut planes: Vec<_> = layer.channel_data.list.into_iter().collect();
    planes.sort_by_cached_key(|plane| exr::rank(&plane.name.to_string()));
    let (channels, texels) = (planes.len(), width as usize * height as usize);
    let half = planes.iter().all(|plane| matches!(plane.sample_data, FlatSamples::F16(_)));
    let mut data = vec![0.0; channels * texels];
    for (c, plane) in planes.iter().enumerate() {
        if plane.sample_data.len() != texels {
            return Err(TextureError::unsupported(Container::Exr, "subsampled channels"));
        }
        data.iter_mut()
            .skip(c)
            .step_by(channels)
            .zip(plane.sample_data.values_as_f32())
            .for_each(|(place, value)| *place = value);
    }
    let samples = if half { Samples::Half } else { Samples::Float };
    let names: Vec<String> = planes.iter().map(|plane| plane.name.to_string()).collect();
    let separator = if names.iter().all(|name| name.len() == 1) { "" } else { " " };
    let format = format!("EXR {}, {}", names.join(separator), if half { "half" } else { "float" });
    Ok(Table { image: Image { width, height, channels: channels as u32, data }, samples, format, notes: Vec::new() })
}

#[cfg(test)]
mod tests;
