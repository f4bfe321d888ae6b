//! Colours of pictures.

use luthier_lut::Image;
use luthier_optics::color::luminance;
use luthier_report::lightness_chroma_hue;

use super::super::figure::TONE;
use super::{average, middle, rgb, texels};

/// Chroma from which a colour has a hue: four of the differences that an eye just notices (2.3 units of CIELAB, Mahy et al.
/// 1994).
const COLORED: f64 = 10.0;

/// Sectors of 30 degrees.
const SECTORS: usize = 12;

/// Saturation of a linear colour, whatever its brightness: the chroma (CIE 1976) that it has at a luminance of 0.5, over 100.
pub(crate) fn saturation(rgb: [f64; 3]) -> f64 {
    let scale = 0.5 / luminance(rgb).max(1e-9);
    lightness_chroma_hue(rgb.map(|v| v * scale))[1] / 100.0
}

/// Hue of the mean colour in the middle of a picture, a share of its side wide, in degrees of CIELAB.
pub(crate) fn hue(image: &Image, share: f64) -> f64 {
    lightness_chroma_hue(middle(image, share))[2]
}

/// Saturation of the middle half of a picture, row by row.
pub(crate) fn saturations(image: &Image) -> Vec<f64> {
    texels(image, 0.5).map(|texel| saturation(rgb(texel))).collect()
}

/// Mean chroma of what a display shows in the middle half of a picture.
pub(crate) fn chroma(image: &Image) -> f64 {
    average(texels(image, 0.5).map(|texel| lightness_chroma_hue(shown(texel))[1]))
}

/// Share of the circle of hues that a picture's middle half shows: of twelve sectors, those that hold a hundredth of it.
pub(crate) fn hues(image: &Image) -> f64 {
    let (mut sectors, mut all) = ([0_usize; SECTORS], 0_usize);
    for texel in texels(image, 0.5) {
        let [_, chroma, hue] = lightness_chroma_hue(shown(texel));
        all += 1;
        if chroma > COLORED {
            sectors[(hue / 360.0 * SECTORS as f64) as usize % SECTORS] += 1;
        }
    }
    sectors.iter().filter(|count| **count * 100 > all).count() as f64 / SECTORS as f64
}

/// Mean difference of colour between neighbours in a row, without lightness, in the middle half of a picture.
pub(crate) fn tint_grain(image: &Image) -> f64 {
    let colours = planes(image);
    let side = colours.len().isqrt().max(1);
    let pairs = colours.chunks(side).flat_map(|row| row.windows(2));
    average(pairs.map(|pair| libm::hypot(pair[0][0] - pair[1][0], pair[0][1] - pair[1][1])))
}

/// Difference of the mean colours of two pictures in their middle half without lightness, in units of CIELAB.
pub(crate) fn tints_apart(a: &Image, b: &Image) -> f64 {
    let [a, b] = [a, b].map(|image| {
        let all = planes(image);
        [0, 1].map(|c: usize| average(all.iter().map(|colour| colour[c])))
    });
    libm::hypot(a[0] - b[0], a[1] - b[1])
}

/// Standard deviation of the colour without lightness in the middle half of a picture, in units of CIELAB.
pub(crate) fn tint_deviation(image: &Image) -> f64 {
    let all = planes(image);
    let middle = [0, 1].map(|c: usize| average(all.iter().map(|colour| colour[c])));
    let squares = all.iter().map(|[a, b]| (a - middle[0]) * (a - middle[0]) + (b - middle[1]) * (b - middle[1]));
    average(squares).sqrt()
}

/// Mean difference of lightness of what a display shows of two pictures, in their middle half.
pub(crate) fn lightness_apart(a: &Image, b: &Image) -> f64 {
    let [a, b] = [a, b].map(|image| texels(image, 0.5).map(|texel| lightness_chroma_hue(shown(texel))[0]));
    average(a.zip(b).map(|(a, b)| (a - b).abs()))
}

/// Difference of two colours as a display shows them, CIELAB of 1976.
pub(crate) fn colors_apart(a: [f64; 3], b: [f64; 3]) -> f64 {
    let [a, b] = [a, b].map(|colour| colour.map(|v| f64::from(TONE.value(v as f32))));
    let ([p, q], [r, s]) = (plane(a), plane(b));
    let lightness = lightness_chroma_hue(a)[0] - lightness_chroma_hue(b)[0];
    libm::hypot(lightness, libm::hypot(p - r, q - s))
}

/// CIELAB's a* and b*.
fn planes(image: &Image) -> Vec<[f64; 2]> {
    texels(image, 0.5).map(|texel| plane(shown(texel))).collect()
}

fn plane(rgb: [f64; 3]) -> [f64; 2] {
    let [_, chroma, hue] = lightness_chroma_hue(rgb);
    let (sin, cos) = libm::sincos(hue.to_radians());
    [chroma * cos, chroma * sin]
}

fn shown(texel: &[f32]) -> [f64; 3] {
    [0, 1, 2].map(|c: usize| f64::from(TONE.value(texel[c])))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Left and right half of a picture of one colour each, of 16 pixels a side.
    fn halves(left: [f32; 3], right: [f32; 3]) -> Image {
        let mut image = Image::zeros(16, 16, 3);
        for i in 0..256 {
            image.texel_mut(i % 16, i / 16).copy_from_slice(if i % 16 < 8 { &left } else { &right });
        }
        image
    }

    #[test]
    fn red_and_its_opposite() {
        let (red, cyan) = ([0.5, 0.0, 0.0], [0.0, 0.5, 0.5]);
        let image = halves(red, cyan);
        assert!((hues(&image) - 2.0 / 12.0).abs() < 1e-12);
        assert!((hue(&halves(red, red), 0.5) - 40.0).abs() < 0.05);
        assert!(hues(&halves([0.3; 3], [0.5; 3])) < 1e-12);
        // One of seven pairs of a row of eight changes, by all that lies between the two colours.
        let apart = tints_apart(&halves(red, red), &halves(cyan, cyan));
        assert!((tint_deviation(&image) - 0.5 * apart).abs() < 1e-6 && tint_deviation(&halves(red, red)) < 1e-6);
        assert!(apart > 100.0 && (tint_grain(&image) - apart / 7.0).abs() < 1e-6);
    }

    #[test]
    fn brightness_does_not_change_saturation() {
        let colours = [[0.4, 0.2, 0.1], [0.2, 0.1, 0.05]];
        let [bright, dim] = colours.map(saturation);
        assert!((bright / dim - 1.0).abs() < 1e-9 && bright > 1.3 * saturation([0.4, 0.3, 0.25]));
        assert!(saturation([0.3; 3]) < 1e-9 && saturation([0.0; 3]) < 1e-9);
        let picture = |[r, g, b]: [f32; 3]| halves([r, g, b], [r, g, b]);
        assert!(saturations(&picture([0.4, 0.2, 0.1])).iter().all(|found| (found - bright).abs() < 1e-4));
        let [lightness, expected, _] = lightness_chroma_hue(colours[0]);
        assert!((chroma(&picture([0.4, 0.2, 0.1])) - expected).abs() < 1e-4);
        let apart = lightness_apart(&picture([0.4, 0.2, 0.1]), &picture([0.2, 0.1, 0.05]));
        // Of greys lightness alone differs: L* is 100 at 1 and 76.07 at 0.5; the tone curve keeps the latter.
        let greys = colors_apart([0.5; 3], [0.25; 3]);
        assert!((greys - 76.07 + lightness_chroma_hue([0.25; 3])[0]).abs() < 0.01, "{greys}");
        assert!((apart - lightness + lightness_chroma_hue(colours[1])[0]).abs() < 1e-4);
    }
}
