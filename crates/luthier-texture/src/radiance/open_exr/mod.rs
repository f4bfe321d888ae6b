//! Colours of OpenEXR files of any maker.

use std::io::Cursor;

use ::exr::block;
use ::exr::block::reader::ChunksReader;
use ::exr::math::Vec2;
use ::exr::meta::attribute::{EnvironmentMap, IntegerBounds, SampleType};
use ::exr::meta::header::Header;
use half::f16;
use luthier_lut::Image;

use super::channels::{Colors, colors};
use super::picture::Picture;
use super::primaries::{self, Primaries};
use crate::TextureError;
use crate::error::Container;
use crate::exr::{dwa, malformed, read_error, side};
use crate::limits::is_plausible;
use crate::size::checked_bytes;

/// Reads the first part of a file that has colours, its largest level, onto the display window.
pub(super) fn decode(file: &[u8]) -> Result<Picture, TextureError> {
    // All sizes are checked before anything is allocated for them.
    let reader = block::read(Cursor::new(file), false).map_err(read_error)?;
    let headers = reader.headers().to_vec();
    for header in &headers {
        check_size(header.layer_size, header, file)?;
        check_size(header.shared_attributes.display_window.size, header, file)?;
    }
    let (part, colors) = part(&headers)?;
    let header = &headers[part];
    if header.own_attributes.environment_map == Some(EnvironmentMap::Cube) {
        return Err(unsupported(
            "the six sides of a cube (attribute `envmap`; it is to be converted to latitude and longitude)".to_owned(),
        ));
    }
    dwa::check(file)?;
    let window = Window::of(header)?;
    let mut image = Image::zeros(side(window.size[0] as usize), side(window.size[1] as usize), 3);

    let whole = Vec2(0, 0);
    let chunks = reader
        .filter_chunks(false, |_, tile, block| block.layer == part && tile.level_index == whole)
        .map_err(read_error)?;
    let blocks = chunks.sequential_decompressor(false);
    for block in blocks {
        let block = block.map_err(read_error)?;
        for line in block.lines(&header.channels) {
            let at = line.location;
            let kind = header.channels.list[at.channel].sample_type;
            for (place, _) in colors.places.iter().enumerate().filter(|(_, channel)| **channel == at.channel) {
                window.put(&mut image, [at.position.0, at.position.1], place, kind, line.value);
            }
        }
    }
    let mut notes = notes(header, &window, &colors);
    if let Some(note) = to_rec709(header, &colors, &mut image)? {
        notes.push(note);
    }
    Ok(Picture { image, notes })
}

fn check_size(size: Vec2<usize>, header: &Header, file: &[u8]) -> Result<(), TextureError> {
    let stored = header.channels.list.iter().map(|channel| channel.sample_type.bytes_per_sample()).sum();
    let (width, height) = (side(size.0), side(size.1));
    checked_bytes(width, height, side(stored))?;
    if is_plausible(file, 12 * u64::from(width) * u64::from(height)) {
        return Ok(());
    }
    Err(malformed(format!("{} bytes are too short for {width} x {height} texels", file.len())))
}

/// The first part that has colours.
fn part(headers: &[Header]) -> Result<(usize, Colors), TextureError> {
    if let Some(found) = headers.iter().enumerate().find_map(|(number, header)| Some((number, colors(header)?))) {
        return Ok(found);
    }
    let all = headers.iter().flat_map(|header| &header.channels.list);
    let mut names: Vec<String> = all.map(|channel| format!("`{}`", channel.name)).take(LISTED).collect();
    if names.len() == LISTED {
        names.push("...".to_owned());
    }
    Err(unsupported(format!(
        "the channels {} (wanted are R, G and B, in a layer or not, or Y alone for grey)",
        names.join(", ")
    )))
}

/// Most channels that an error lists.
const LISTED: usize = 24;

/// The display window, and the data window in it.
struct Window {
    size: [i64; 2],
    display: IntegerBounds,
    data: IntegerBounds,
}

impl Window {
    fn of(header: &Header) -> Result<Self, TextureError> {
        let display = header.shared_attributes.display_window;
        let data = IntegerBounds::new(header.own_attributes.layer_position, header.layer_size);
        let size = [display.size.0, display.size.1].map(|length| i64::from(side(length)));
        let window = Self { size, display, data };
        let [x, y] = window.offset();
        let mut axes = [(x, data.size.0, size[0]), (y, data.size.1, size[1])].into_iter();
        if axes.any(|(from, length, size)| from >= size || from + i64::from(side(length)) <= 0) {
            return Err(malformed(format!(
                "its data window ({}) lies outside of its display window ({})",
                words(data),
                words(display)
            )));
        }
        Ok(window)
    }

    /// The corner of the data window in the display window.
    fn offset(&self) -> [i64; 2] {
        let (data, display) = (self.data.position, self.display.position);
        [(data.0, display.0), (data.1, display.1)].map(|(data, display)| i64::from(data) - i64::from(display))
    }

    /// Writes the visible part of a row of one channel.
    fn put(&self, image: &mut Image, at: [usize; 2], place: usize, kind: SampleType, bytes: &[u8]) {
        let [x, y] = self.offset();
        let (x, y) = (x + at[0] as i64, y + at[1] as i64);
        if !(0..self.size[1]).contains(&y) {
            return;
        }
        let first = y as usize * image.width as usize;
        let row = &mut image.data[3 * first..3 * (first + image.width as usize)];
        let skipped = (-x).max(0) as usize;
        let texels = row.as_chunks_mut::<3>().0.iter_mut().skip(x.max(0) as usize);
        match kind {
            SampleType::F16 => {
                let values = bytes.as_chunks().0.iter().skip(skipped);
                texels.zip(values).for_each(|(texel, value)| texel[place] = f16::from_ne_bytes(*value).to_f32());
            }
            SampleType::F32 => {
                let values = bytes.as_chunks().0.iter().skip(skipped);
                texels.zip(values).for_each(|(texel, value)| texel[place] = f32::from_ne_bytes(*value));
            }
            SampleType::U32 => {
                let values = bytes.as_chunks().0.iter().skip(skipped);
                texels.zip(values).for_each(|(texel, value)| texel[place] = u32::from_ne_bytes(*value) as f32);
            }
        }
    }
}

fn words(window: IntegerBounds) -> String {
    format!("{} x {} at {}, {}", window.size.0, window.size.1, window.position.0, window.position.1)
}

fn notes(header: &Header, window: &Window, colors: &Colors) -> Vec<String> {
    let mut notes = Vec::new();
    let Window { display, data, .. } = *window;
    if display != data {
        notes.push(format!(
            "the picture is the display window ({}); what the data window ({}) leaves of it is black, and what is outside of it is cut off",
            words(display),
            words(data)
        ));
    }
    if let Some(layer) = &colors.told {
        notes.push(format!("of several layers `{layer}` is read"));
    }
    let aspect = header.shared_attributes.pixel_aspect;
    if (aspect - 1.0).abs() > 0.01 && (aspect - 2.0).abs() > 0.02 {
        notes.push(format!("pixelAspectRatio {aspect} does not count: texels cover equal angles"));
    }
    notes
}

/// Brings colours of other primaries to Rec.709, and returns a note about it.
fn to_rec709(header: &Header, colors: &Colors, image: &mut Image) -> Result<Option<String>, TextureError> {
    let Some(stated) = header.shared_attributes.chromaticities.filter(|_| !colors.is_grey()) else { return Ok(None) };
    let [red, green, blue, white] =
        [stated.red, stated.green, stated.blue, stated.white].map(|at| [f64::from(at.0), f64::from(at.1)]);
    let stated = Primaries { red, green, blue, white };
    if stated.is_rec709() {
        return Ok(None);
    }
    let (matrix, from) = if stated.is_xyz() {
        (stated.to_rec709_unadapted(), "CIE XYZ, which its chromaticities state, as they are".to_owned())
    } else {
        (stated.to_rec709(), format!("its chromaticities ({}), white to white", stated.words()))
    };
    primaries::convert(image, &matrix.ok_or_else(|| malformed("its chromaticities span no colours"))?);
    Ok(Some(format!("colours are converted to Rec.709 from {from}")))
}

fn unsupported(what: String) -> TextureError {
    TextureError::unsupported(Container::Exr, what)
}

#[cfg(test)]
mod tests;
