//! Numbers of pictures that claims are about.

pub(crate) mod light;
pub(crate) mod places;
pub(crate) mod spot;
pub(crate) mod tint;

use std::ops::Range;

use luthier_lut::Image;
use luthier_optics::color::luminance;

use super::figure::TONE;

/// Value of a display from which a colour counts as blown out: 249 of 255.
const BLOWN: f32 = 0.95;

/// Mean over the middle of a picture, a share of its side wide.
pub(crate) fn middle(image: &Image, share: f64) -> [f64; 3] {
    let count = texels(image, share).count().max(1) as f64;
    [0, 1, 2].map(|c: usize| texels(image, share).map(|texel| f64::from(texel[c])).sum::<f64>() / count)
}

/// Mean luminance of a picture.
pub(crate) fn brightness(image: &Image) -> f64 {
    luminance(middle(image, 1.0))
}

/// Mean of a channel over the mean of red, in the middle half of a picture.
pub(crate) fn over_red(image: &Image, channel: usize) -> f64 {
    let mean = middle(image, 0.5);
    mean[channel] / mean[0].max(1e-9)
}

/// Largest luminance of a picture.
pub(crate) fn brightest(image: &Image) -> f64 {
    luminances(image, 1.0).fold(0.0, f64::max)
}

/// Standard deviation of luminance over its mean, in the middle half of a picture.
pub(crate) fn variation(image: &Image) -> f64 {
    let mean = luminance(middle(image, 0.5));
    let squares = luminances(image, 0.5).map(|value| (value - mean) * (value - mean));
    average(squares).sqrt() / mean.max(1e-9)
}

/// Mean difference of luminance between neighbours in a row, over the mean, in the middle half of a picture.
pub(crate) fn grain(image: &Image) -> f64 {
    let values: Vec<f64> = luminances(image, 0.5).collect();
    let side = values.len().isqrt().max(1);
    let count = (side * (side - 1)).max(1) as f64;
    steps(&values).sum::<f64>() / count / luminance(middle(image, 0.5)).max(1e-9)
}

/// Largest luminance in the middle half of a picture over the median there.
pub(crate) fn highlight(image: &Image) -> f64 {
    let (largest, median) = (luminances(image, 0.5).fold(0.0, f64::max), median(image));
    largest / median.max(1e-9)
}

/// Share of the middle half of a picture that is at least twice as bright as the median there.
pub(crate) fn glitter(image: &Image) -> f64 {
    let limit = 2.0 * median(image);
    share(luminances(image, 0.5).map(|value| value > limit))
}

/// Share of the middle of a picture, 0.8 of its side wide, that a display shows as white.
pub(crate) fn blown_out(image: &Image) -> f64 {
    share(texels(image, 0.8).map(|texel| texel.iter().all(|value| TONE.value(*value) >= BLOWN)))
}

/// Share of the middle half of a picture where another differs, by more than rounding.
pub(crate) fn middle_differs(a: &Image, b: &Image) -> f64 {
    share(texels(a, 0.5).zip(texels(b, 0.5)).map(|(a, b)| a.iter().zip(b).any(|(a, b)| (a - b).abs() > 1e-3)))
}

fn median(image: &Image) -> f64 {
    let mut values: Vec<f64> = luminances(image, 0.5).collect();
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied().unwrap_or(0.0)
}

fn luminances(image: &Image, share: f64) -> impl Iterator<Item = f64> {
    texels(image, share).map(|texel| luminance(rgb(texel)))
}

/// Texels of the middle of a picture.
fn texels(image: &Image, share: f64) -> impl Iterator<Item = &[f32]> {
    middle_of(image.height, share).flat_map(move |y| middle_of(image.width, share).map(move |x| image.texel(x, y)))
}

/// The middle of a side, a share of it long.
fn middle_of(side: u32, share: f64) -> Range<u32> {
    let margin = (f64::from(side) * (1.0 - share) / 2.0).round() as u32;
    margin..(side - margin).max(margin + 1)
}

pub(crate) fn share(values: impl Iterator<Item = bool>) -> f64 {
    average(values.map(|value| f64::from(u8::from(value))))
}

/// The mean, or 0 of nothing.
pub(crate) fn average(values: impl Iterator<Item = f64>) -> f64 {
    let (sum, count) = values.fold((0.0, 0.0), |(sum, count), value| (sum + value, count + 1.0));
    sum / f64::max(count, 1.0)
}

/// Differences between neighbours in the rows of a square.
fn steps(values: &[f64]) -> impl Iterator<Item = f64> {
    let side = values.len().isqrt().max(1);
    values.chunks(side).flat_map(|row| row.windows(2)).map(|pair| (pair[0] - pair[1]).abs())
}

/// The middle of a pixel, from -1 to 1 over the side of a picture.
pub(crate) fn across(i: u32, side: u32) -> f64 {
    2.0 * (f64::from(i) + 0.5) / f64::from(side) - 1.0
}

/// The pixels of a picture, row by row.
pub(crate) fn pixels(image: &Image) -> impl Iterator<Item = (u32, u32)> + use<> {
    let [width, height] = image.size();
    (0..height).flat_map(move |y| (0..width).map(move |x| (x, y)))
}

/// The linear colour of a texel.
pub(crate) fn rgb(texel: &[f32]) -> [f64; 3] {
    [0, 1, 2].map(|c: usize| f64::from(texel[c]))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_of_a_picture_with_one_light() {
        // A dim picture of 16 pixels a side, whose middle half has 64; one of them is bright and one is blown out.
        let mut image = Image { data: [0.4, 0.2, 0.1].repeat(256), ..Image::zeros(16, 16, 3) };
        image.texel_mut(5, 5).fill(1.0);
        image.texel_mut(8, 8).fill(100.0);
        let dim = luminance([0.4, 0.2, 0.1]);
        assert!((brightest(&image) - 100.0 * luminance([1.0; 3])).abs() < 1e-3);
        assert!((highlight(&image) - 100.0 * luminance([1.0; 3]) / dim).abs() < 1e-3);
        assert!((glitter(&image) - 2.0 / 64.0).abs() < 1e-12);
        // 0.8 of 16 pixels are 12 (a margin of 2 on each side).
        assert!((blown_out(&image) - 1.0 / 144.0).abs() < 1e-12, "{}", blown_out(&image));
        let even = Image { data: [0.4, 0.2, 0.1].repeat(256), ..Image::zeros(16, 16, 3) };
        assert!((middle_differs(&even, &image) - 2.0 / 64.0).abs() < 1e-12);
        assert!(variation(&even) < 1e-6 && variation(&image) > 1.0);
        // Each bright pixel has two neighbours in its row of 8.
        let mean = (62.0 * dim + 101.0 * luminance([1.0; 3])) / 64.0;
        let steps = 2.0 * (101.0 * luminance([1.0; 3]) - 2.0 * dim) / 56.0;
        assert!(grain(&even) < 1e-6 && (grain(&image) - steps / mean).abs() < 1e-4, "{}", grain(&image));
        assert!((over_red(&even, 1) - 0.5).abs() < 1e-6 && (over_red(&even, 2) - 0.25).abs() < 1e-6);
        assert!((brightness(&even) - dim).abs() < 1e-6);
    }
}
