//! Contact sheets: pictures in rows, each with a name below.

use font8x8::legacy::BASIC_LEGACY;
use luthier_lut::Image;

/// Side of a picture from which names are twice as large.
const LARGE: u32 = 192;
/// Pixels between pictures.
const GAP: u32 = 8;
/// Height of a line of text and its surrounding, in small letters.
const LABEL: u32 = 16;
/// Side of a character.
const GLYPH: u32 = 8;

const PAPER: f32 = 0.02;
const INK: f32 = 0.6;

/// A picture of square pictures of one size, in rows, each with its name below; a name that is too long is cut off.
pub fn sheet(pictures: &[(String, Image)], columns: u32) -> Image {
    let size = pictures.first().map_or(0, |(_, image)| image.width);
    let rows = (pictures.len() as u32).div_ceil(columns);
    let scale = if size < LARGE { 1 } else { 2 };
    let cell = [size + GAP, size + scale * LABEL + GAP];
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
        write(&mut sheet, name, [left, top + size + scale * (LABEL - GLYPH) / 2], size, scale);
    }
    sheet
}

/// Writes a line in the middle of a width; what does not fit is cut off.
fn write(sheet: &mut Image, text: &str, [left, top]: [u32; 2], width: u32, scale: u32) {
    let side = scale * GLYPH;
    let fitting = (width / side) as usize;
    let text: Vec<char> = text.chars().take(fitting).collect();
    let start = left + (width - text.len() as u32 * side) / 2;
    for (i, character) in text.into_iter().enumerate() {
        let Some(rows) = BASIC_LEGACY.get(character as usize) else { continue };
        for (y, row) in rows.iter().enumerate() {
            for (x, dy) in
                (0..side).filter(|x| row & 1 << (x / scale) != 0).flat_map(|x| (0..scale).map(move |dy| (x, dy)))
            {
                sheet.texel_mut(start + i as u32 * side + x, top + scale * y as u32 + dy).fill(INK);
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
        let pictures: Vec<_> = (0..3).map(|i| ("I".repeat(i * 2), picture(i as f32))).collect();
        let sheet = sheet(&pictures, 2);
        assert_eq!((sheet.width, sheet.height), (2 * 32 + 8, 2 * 48 + 8));
        assert_eq!(sheet.texel(8, 8), [0.0; 3]);
        assert_eq!(sheet.texel(40, 8), [1.0; 3]);
        assert_eq!(sheet.texel(8, 56), [2.0; 3]);
        // The last cell is empty, and the first has no name; the third's is cut to what fits.
        let ink = |x: u32, y: u32, width: u32, height: u32| {
            (y..y + height)
                .flat_map(|y| (x..x + width).map(move |x| (x, y)))
                .filter(|&(x, y)| sheet.texel(x, y)[0] == INK)
                .count()
        };
        assert_eq!(ink(40, 56, 32, 40), 0);
        assert_eq!(ink(8, 32, 24, 16), 0);
        let letter = ink(40, 32, 24, 16) / 2;
        assert!(letter > 10, "{letter}");
        assert_eq!(ink(8, 80, 24, 16), 3 * letter);
    }
}
