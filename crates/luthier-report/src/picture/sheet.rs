//! Contact sheets: pictures in rows, each with a name below.

use std::sync::OnceLock;

use fontdue::{Font, FontSettings};
use luthier_lut::Image;

/// Pixels between pictures.
const GAP: u32 = 8;
/// Height of a line of text and its surrounding, for each step of [`scale`].
const LABEL: u32 = 16;
/// Height of the letters over that of a line.
const LETTERS: f32 = 0.75;
/// Least height of letters in pixels. The letters of a long name shrink to it.
const LEAST_LETTERS: f32 = 9.0;
/// Place of the foot of the letters in a line, over its height.
const FOOT: f32 = 0.72;

const PAPER: f32 = 0.02;
const INK: f32 = 0.6;

/// A contact sheet: square pictures of one size in rows, each with its name below. Long names have smaller letters; a name that still is too long is cut
/// off.
pub fn sheet(pictures: &[(String, Image)], columns: u32) -> Image {
    let size = pictures.first().map_or(0, |(_, image)| image.width);
    let rows = (pictures.len() as u32).div_ceil(columns);
    let line = scale(size) * LABEL;
    let cell = [size + GAP, size + line + GAP];
    let mut sheet = Image::zeros(columns * cell[0] + GAP, rows * cell[1] + GAP, 3);
    sheet.data.fill(PAPER);
    for (i, (name, image)) in pictures.iter().enumerate() {
        let i = i as u32;
        let [left, top] = [GAP + i % columns * cell[0], GAP + i / columns * cell[1]];
        for y in 0..size {
            for x in 0..size {
                sheet.texel_mut(left + x, top + y).copy_from_slice(image.texel(x, y));
            }
        }
        write(&mut sheet, name, [left, top + size], [size, line]);
    }
    sheet
}

/// Height of a line in units of [`LABEL`], for the side of a picture.
fn scale(size: u32) -> u32 {
    match size {
        0..192 => 1,
        192..448 => 2,
        _ => 3,
    }
}

/// The font of all sheets.
fn font() -> Option<&'static Font> {
    static FONT: OnceLock<Option<Font>> = OnceLock::new();
    let bytes: &[u8] = include_bytes!("../../data/DejaVuSans-ASCII.ttf");
    FONT.get_or_init(|| Font::from_bytes(bytes, FontSettings::default()).ok()).as_ref()
}

/// Writes a line centred in a width. Long lines have smaller letters; the end of a line that still does not fit is cut off.
fn write(sheet: &mut Image, text: &str, [left, top]: [u32; 2], [width, height]: [u32; 2]) {
    let Some(font) = font() else { return };
    let most = LETTERS * height as f32;
    let whole: f32 = text.chars().map(|character| font.metrics(character, most).advance_width).sum();
    // One pixel is left over for rounding of advances.
    let px = (most * (width as f32 - 1.0) / whole.max(1.0)).clamp(LEAST_LETTERS.min(most), most);
    let mut glyphs = Vec::new();
    let mut end = 0.0_f32;
    for character in text.chars() {
        let next = end + font.metrics(character, px).advance_width;
        if next > width as f32 {
            break;
        }
        glyphs.push((end, character));
        end = next;
    }
    let start = ((width as f32 - end) / 2.0).floor();
    for (at, character) in glyphs {
        let (metrics, coverage) = font.rasterize(character, px);
        let foot = (FOOT * height as f32) as i32;
        let (x, y) = ((start + at).round() as i32 + metrics.xmin, foot - metrics.height as i32 - metrics.ymin);
        for (i, covered) in coverage.into_iter().enumerate() {
            let (x, y) = (x + (i % metrics.width) as i32, y + (i / metrics.width) as i32);
            if covered == 0 || x < 0 || x >= width as i32 || y < 0 || y >= height as i32 {
                continue;
            }
            let share = f32::from(covered) / 255.0;
            for value in sheet.texel_mut(left + x as u32, top + y as u32) {
                *value += share * (INK - *value);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pictures_and_names_have_their_places() {
        let picture = |value: f32| Image { data: vec![value; 3 * 24 * 24], ..Image::zeros(24, 24, 3) };
        let pictures: Vec<_> =
            [0, 4, 40].iter().enumerate().map(|(i, letters)| ("I".repeat(*letters), picture(i as f32))).collect();
        let sheet = sheet(&pictures, 2);
        assert_eq!((sheet.width, sheet.height), (2 * 32 + 8, 2 * 48 + 8));
        assert_eq!(sheet.texel(8, 8), [0.0; 3]);
        assert_eq!(sheet.texel(40, 8), [1.0; 3]);
        assert_eq!(sheet.texel(8, 56), [2.0; 3]);
        // The last cell is empty, and the first has no name; the third's is cut to what fits.
        let ink = |x: u32, y: u32, width: u32, height: u32| {
            let texels = (y..y + height).flat_map(|y| (x..x + width).map(move |x| (x, y)));
            texels.map(|(x, y)| (sheet.texel(x, y)[0] - PAPER) / (INK - PAPER)).sum::<f32>()
        };
        assert_eq!(ink(40, 56, 32, 40), 0.0);
        assert_eq!(ink(8, 32, 24, 16), 0.0);
        let letter = ink(40, 32, 24, 16) / 4.0;
        assert!(letter > 5.0, "{letter}");
        // Forty letters of the least size are wider than the picture: some fit, and none stands in the gap.
        let last = ink(8, 80, 24, 16) / letter;
        assert!((3.0..10.0).contains(&last), "{last}");
        assert_eq!(ink(0, 80, 8, 16) + ink(32, 80, 8, 16), 0.0);
    }

    /// A name of twice the width has letters of half the size, and all of them.
    #[test]
    fn a_long_name_has_smaller_letters() {
        let inked = |name: &str| {
            let sheet = sheet(&[(name.to_owned(), Image::zeros(256, 256, 3))], 1);
            let columns = (0..sheet.width).filter(|x| (0..32).any(|y| sheet.texel(*x, 264 + y)[0] > 1.01 * PAPER));
            let columns: Vec<u32> = columns.collect();
            (columns[0], columns[columns.len() - 1])
        };
        let long = format!("I{}I", "n".repeat(30));
        let (first, last) = inked(&long);
        assert!(first >= 8 && last < 264, "{first} to {last}");
        // Both ends are there: it fills the width.
        assert!(last - first > 240, "{first} to {last}");
    }

    /// Letters of all sizes have their feet on the line, and room for what hangs below it.
    #[test]
    fn letters_fit_their_line() {
        for size in [96, 256, 512] {
            let sheet = sheet(&[("Agjpq|".to_owned(), Image::zeros(size, size, 3))], 1);
            let line = scale(size) * LABEL;
            let row = |y: u32| (0..sheet.width).any(|x| sheet.texel(x, 8 + size + y)[0] > 1.01 * PAPER);
            let inked: Vec<u32> = (0..line).filter(|y| row(*y)).collect();
            let (Some(first), Some(last)) = (inked.first(), inked.last()) else { panic!("no ink") };
            assert!(*first > 0 && *last < line - 1 && last - first > line / 2, "{size}: {first} to {last} of {line}");
        }
    }
}
