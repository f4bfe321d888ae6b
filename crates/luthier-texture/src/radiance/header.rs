//! Headers of Radiance pictures (Ward, "The RADIANCE picture file format"): lines of text, an empty line, and the line of the size.

use super::primaries::Primaries;
use crate::TextureError;
use crate::error::Container;

/// The statements of a header about the texels behind it.
#[derive(Debug)]
pub(super) struct Header {
    pub(super) width: u32,
    pub(super) height: u32,
    pub(super) order: Order,
    /// Divisors of the stored values, by channel: exposure and colour correction.
    pub(super) divisors: [f64; 3],
    /// Primaries, if they differ from those of Rec.709.
    pub(super) primaries: Option<Primaries>,
    /// The format is `32-bit_rle_xyze`.
    pub(super) is_xyz: bool,
    pub(super) pixel_aspect: f64,
    /// Bytes before the first scanline.
    pub(super) length: usize,
}

/// Order of scanlines and their texels.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Order {
    /// Scanlines are columns.
    pub(super) columns: bool,
    /// Rows count from the bottom.
    pub(super) from_bottom: bool,
    /// Columns count from the right.
    pub(super) from_right: bool,
}

/// Longest header that is looked through.
const LENGTH_MAX: usize = 1 << 20;

pub(super) fn malformed(reason: impl Into<String>) -> TextureError {
    TextureError::malformed(Container::Hdr, reason.into())
}

/// Reads a header. Lines that begin with a blank tell of the sources of a picture, and are skipped; so are lines of
/// unknown names.
pub(super) fn read(file: &[u8]) -> Result<Header, TextureError> {
    let mut lines = Lines { file: &file[..file.len().min(LENGTH_MAX)], at: 0 };
    // The first line names the program: `#?RADIANCE` or another.
    lines.next().ok_or_else(|| malformed("it ends in its header"))?;
    let (mut divisors, mut primaries, mut is_xyz, mut pixel_aspect) = ([1.0; 3], None, false, 1.0);
    loop {
        let line = lines.next().ok_or_else(|| malformed("its header has no end: an empty line is missing"))?;
        if line.is_empty() {
            break;
        }
        let line = String::from_utf8_lossy(line);
        let Some((name, value)) = line.split_once('=') else { continue };
        match name {
            "FORMAT" => {
                is_xyz = match value.trim() {
                    "32-bit_rle_rgbe" => false,
                    "32-bit_rle_xyze" => true,
                    other => {
                        let name: String = other.chars().take(32).collect();
                        return Err(TextureError::unsupported(Container::Hdr, format!("the format `{name}`")));
                    }
                };
            }
            "EXPOSURE" => {
                let [exposure] = numbers(name, value, |v| v > 0.0)?;
                divisors = divisors.map(|v| v * exposure);
            }
            "COLORCORR" => {
                let correction: [f64; 3] = numbers(name, value, |v| v > 0.0)?;
                divisors = [0, 1, 2].map(|c| divisors[c] * correction[c]);
            }
            "PIXASPECT" => pixel_aspect *= numbers::<1>(name, value, |v| v > 0.0)?[0],
            "PRIMARIES" => {
                let [a, b, c, d, e, f, g, h] = numbers(name, value, |_| true)?;
                primaries = Some(Primaries { red: [a, b], green: [c, d], blue: [e, f], white: [g, h] });
            }
            _ => {}
        }
    }
    if divisors.iter().any(|v| !v.is_normal()) {
        return Err(malformed("its exposures are out of the range of numbers"));
    }
    let line = lines.next().ok_or_else(|| malformed("it ends before the line of its size"))?;
    let (order, width, height) = size(&String::from_utf8_lossy(line))?;
    let primaries = if is_xyz { Some(Primaries::XYZ) } else { primaries.filter(|primaries| !primaries.is_rec709()) };
    Ok(Header { width, height, order, divisors, primaries, is_xyz, pixel_aspect, length: lines.at })
}

/// Lines that end in LF or in CR LF, without their ends.
struct Lines<'a> {
    file: &'a [u8],
    at: usize,
}

impl<'a> Iterator for Lines<'a> {
    type Item = &'a [u8];

    fn next(&mut self) -> Option<Self::Item> {
        let rest = &self.file[self.at..];
        let length = rest.iter().position(|&byte| byte == b'\n')?;
        self.at += length + 1;
        let line = &rest[..length];
        Some(line.strip_suffix(b"\r").unwrap_or(line))
    }
}

fn numbers<const N: usize>(name: &str, value: &str, allowed: fn(f64) -> bool) -> Result<[f64; N], TextureError> {
    let parsed: Option<Vec<f64>> = value.split_whitespace().map(|word| word.parse().ok()).collect();
    let parsed = parsed.filter(|all| all.iter().all(|v: &f64| v.is_finite() && allowed(*v)));
    parsed.and_then(|all| all.try_into().ok()).ok_or_else(|| {
        let value: String = value.chars().take(64).collect();
        malformed(format!("its line `{name}={value}` should have numbers, as many as {N}"))
    })
}

/// Parses a line such as `-Y 32 +X 64`: scanlines from the top, each from the left. The sign is the direction of a
/// coordinate, the first axis is the one of the scanlines.
fn size(line: &str) -> Result<(Order, u32, u32), TextureError> {
    ordered(line).ok_or_else(|| {
        let line: String = line.chars().take(64).collect();
        malformed(format!("the line of its size is `{line}`, where one such as `-Y 512 +X 1024` belongs"))
    })
}

fn ordered(line: &str) -> Option<(Order, u32, u32)> {
    let words: Vec<&str> = line.split_whitespace().collect();
    let [first, lines, second, texels] = words[..] else { return None };
    let (lines, texels): (u32, u32) = (lines.parse().ok()?, texels.parse().ok()?);
    let columns = matches!(first, "+X" | "-X");
    let (vertical, horizontal) = if columns { (second, first) } else { (first, second) };
    let from_bottom = match vertical {
        "-Y" => false,
        "+Y" => true,
        _ => return None,
    };
    let from_right = match horizontal {
        "+X" => false,
        "-X" => true,
        _ => return None,
    };
    let (width, height) = if columns { (lines, texels) } else { (texels, lines) };
    Some((Order { columns, from_bottom, from_right }, width, height))
}
