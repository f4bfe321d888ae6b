//! Radiance pictures: scanlines of RGBE or XYZE texels, flat or with runs of either kind.
//!
//! A value is the mantissa over 256 times 2^(exponent - 128). Radiance adds a half step to the mantissa; most readers
//! do not, and neither does this one. The reader of `image` knows only one order of scanlines, and no XYZE.

use luthier_lut::Image;

use super::header::{self, Header, malformed};
use super::picture::Picture;
use super::primaries;
use crate::TextureError;
use crate::size::checked_bytes;

/// Bytes of a stored texel.
const TEXEL: usize = 4;

/// Lengths of scanlines for which writers store runs plane by plane.
const PLANES: std::ops::RangeInclusive<usize> = 8..=0x7fff;

pub(super) fn decode(file: &[u8]) -> Result<Picture, TextureError> {
    let header = header::read(file)?;
    let Header { width, height, order, divisors, .. } = header;
    checked_bytes(width, height, TEXEL as u32)?;
    let (lines, length) = if order.columns { (width, height) } else { (height, width) };
    let (lines, length) = (lines as usize, length as usize);
    let bytes = &file[header.length..];
    // The shortest scanline: a texel, and one mark of a run for each eight bits of its length.
    let shortest = TEXEL
        * if length == 1 {
            1
        } else if length <= 256 {
            2
        } else {
            3
        };
    if bytes.len() / shortest < lines {
        let scanlines = if lines == 1 { "scanline" } else { "scanlines" };
        return Err(malformed(format!(
            "it is cut off: {} bytes cannot hold {lines} {scanlines} of {length} texels",
            bytes.len()
        )));
    }
    let mut image = Image::zeros(width, height, 3);
    let mut texels = vec![[0; TEXEL]; length];
    let mut stream = Stream { bytes, at: 0 };
    let is_as_stored = divisors == [1.0; 3];
    for line in 0..lines {
        scanline(&mut stream, &mut texels).map_err(|fault| {
            let what = match fault {
                Fault::End => "is cut off: the file ends in it".to_owned(),
                Fault::Width(stated) => format!("states {stated} texels, and has {length}"),
                Fault::Overrun => format!("has a run beyond its {length} texels"),
                Fault::Start => "begins with a run, which repeats nothing".to_owned(),
            };
            malformed(format!("scanline {} of {lines} {what}", line + 1))
        })?;
        for (place, &texel) in texels.iter().enumerate() {
            let (x, y) = if order.columns { (line, place) } else { (place, line) };
            let x = if order.from_right { width as usize - 1 - x } else { x };
            let y = if order.from_bottom { height as usize - 1 - y } else { y };
            let mut color = values(texel);
            if !is_as_stored {
                color = [0, 1, 2].map(|c| (f64::from(color[c]) / divisors[c]) as f32);
            }
            image.data[3 * (y * width as usize + x)..][..3].copy_from_slice(&color);
        }
    }
    let notes = converted(&header, &mut image)?;
    Ok(Picture { image, notes })
}

/// Brings colours to Rec.709, and returns notes about it.
fn converted(header: &Header, image: &mut Image) -> Result<Vec<String>, TextureError> {
    let mut notes = Vec::new();
    if let Some(primaries) = &header.primaries {
        let matrix = primaries.to_rec709().ok_or_else(|| malformed("its PRIMARIES span no colours"))?;
        primaries::convert(image, &matrix);
        notes.push(if header.is_xyz {
            "CIE XYZ (32-bit_rle_xyze) is converted to Rec.709, with the white of equal energy; luminances count as they are, not over 179"
                .to_owned()
        } else {
            format!("colours are converted to Rec.709 from the PRIMARIES of the file ({})", primaries.words())
        });
    }
    let aspect = header.pixel_aspect;
    if (aspect - 1.0).abs() > 0.01 && (aspect - 2.0).abs() > 0.02 {
        notes.push(format!("PIXASPECT {aspect} does not count: texels cover equal angles"));
    }
    Ok(notes)
}

/// The values of a texel.
fn values([r, g, b, exponent]: [u8; TEXEL]) -> [f32; 3] {
    // 2^(exponent - 128); the smallest is below the normal numbers of single precision.
    let bits = if exponent > 1 { u32::from(exponent - 1) << 23 } else { u32::from(exponent) << 22 };
    let scale = f32::from_bits(bits) / 256.0;
    [r, g, b].map(|mantissa| scale * f32::from(mantissa))
}

enum Fault {
    End,
    Width(usize),
    Overrun,
    Start,
}

struct Stream<'a> {
    bytes: &'a [u8],
    at: usize,
}

impl Stream<'_> {
    fn take(&mut self, count: usize) -> Result<&[u8], Fault> {
        let bytes = self.bytes.get(self.at..self.at + count).ok_or(Fault::End)?;
        self.at += count;
        Ok(bytes)
    }

    fn byte(&mut self) -> Result<u8, Fault> {
        Ok(self.take(1)?[0])
    }

    fn texel(&mut self) -> Result<[u8; TEXEL], Fault> {
        self.take(TEXEL)?.try_into().map_err(|_| Fault::End)
    }
}

/// Fills a scanline of at least one texel.
fn scanline(stream: &mut Stream<'_>, texels: &mut [[u8; TEXEL]]) -> Result<(), Fault> {
    let first = stream.texel()?;
    let [2, 2, high @ ..=127, low] = first else { return runs_of_texels(stream, first, texels) };
    if !PLANES.contains(&texels.len()) {
        return runs_of_texels(stream, first, texels);
    }
    let stated = usize::from(high) << 8 | usize::from(low);
    if stated != texels.len() {
        return Err(Fault::Width(stated));
    }
    (0..TEXEL).try_for_each(|plane| runs_of_bytes(stream, plane, texels))
}

/// Reads one byte of each texel, in runs: up to 128 bytes as they are, or a repeated byte.
fn runs_of_bytes(stream: &mut Stream<'_>, plane: usize, texels: &mut [[u8; TEXEL]]) -> Result<(), Fault> {
    let mut at = 0;
    while at < texels.len() {
        let code = stream.byte()?;
        let count = usize::from(if code > 128 { code - 128 } else { code });
        let run = texels.get_mut(at..at + count).ok_or(Fault::Overrun)?;
        if code > 128 {
            let value = stream.byte()?;
            run.iter_mut().for_each(|texel| texel[plane] = value);
        } else {
            let values = stream.take(count)?;
            run.iter_mut().zip(values).for_each(|(texel, value)| texel[plane] = *value);
        }
        at += count;
    }
    Ok(())
}

/// Reads whole texels. A texel with the mantissas 1, 1, 1 repeats the last one as often as its exponent says; a further
/// one counts 256 times as much.
fn runs_of_texels(stream: &mut Stream<'_>, first: [u8; TEXEL], texels: &mut [[u8; TEXEL]]) -> Result<(), Fault> {
    if first[..3] == [1; 3] {
        return Err(Fault::Start);
    }
    texels[0] = first;
    let (mut at, mut unit, mut last) = (1, 1usize, first);
    while at < texels.len() {
        let texel = stream.texel()?;
        if let [1, 1, 1, count] = texel {
            let count = usize::from(count).saturating_mul(unit);
            let end = at.checked_add(count).ok_or(Fault::Overrun)?;
            texels.get_mut(at..end).ok_or(Fault::Overrun)?.fill(last);
            (at, unit) = (end, unit.saturating_mul(256));
        } else {
            texels[at] = texel;
            (at, unit, last) = (at + 1, 1, texel);
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests;
