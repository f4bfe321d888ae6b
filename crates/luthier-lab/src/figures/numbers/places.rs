//! Numbers about places of a picture: points of light, noise, edges, and maps that are seen.

use std::f64::consts::PI;

use luthier_lut::Image;
use luthier_optics::color::luminance;

use super::{across, luminances, middle_of, rgb, share, steps, texels};

/// Share of the middle half of a picture that is at least twice as bright as the median around it, within a sixteenth of the
/// side.
pub(crate) fn sparkles(image: &Image) -> f64 {
    share(points(image).into_iter())
}

/// Share of a picture's sparkles that are in the same pixels of another.
pub(crate) fn sparkles_that_stay(image: &Image, other: &Image) -> f64 {
    let (here, there) = (points(image), points(other));
    share(here.into_iter().zip(there).filter(|(is_here, _)| *is_here).map(|(_, is_there)| is_there))
}

/// True for each pixel of the middle half that sparkles. Its median is over nine by nine places around it.
fn points(image: &Image) -> Vec<bool> {
    let reach = (f64::from(image.width) / 16.0).max(4.0);
    let offsets: Vec<i64> = (-4..=4).map(|i| (f64::from(i) * reach / 4.0).round() as i64).collect();
    let mut around = Vec::with_capacity(81);
    let mut is_point = Vec::new();
    for y in middle_of(image.height, 0.5) {
        for x in middle_of(image.width, 0.5) {
            around.clear();
            for dy in &offsets {
                for dx in &offsets {
                    let [x, y] = [(x, dx, image.width), (y, dy, image.height)]
                        .map(|(at, offset, side)| (i64::from(at) + offset).clamp(0, i64::from(side) - 1) as u32);
                    around.push(value(image, x, y));
                }
            }
            let (_, median, _) = around.select_nth_unstable_by(40, f64::total_cmp);
            is_point.push(value(image, x, y) > 2.0 * median.max(1e-6));
        }
    }
    is_point
}

/// Standard deviation of a picture's noise in the middle half, against a smooth picture of the same surface and over its mean. Broad changes are no
/// noise: each pixel is compared with the mean of its eight neighbours.
pub(crate) fn noise(image: &Image, smooth: &Image) -> f64 {
    let apart = |x: u32, y: u32| value(image, x, y) - value(smooth, x, y);
    let (mut squares, mut sum, mut count) = (0.0, 0.0, 0.0);
    for y in middle_of(image.height, 0.5) {
        for x in middle_of(image.width, 0.5) {
            let rows = (y.max(1) - 1)..=(y + 1).min(image.height - 1);
            let places = rows.flat_map(|j| ((x.max(1) - 1)..=(x + 1).min(image.width - 1)).map(move |i| (i, j)));
            let (total, all) = places.fold((0.0, 0.0), |(total, all), (i, j)| (total + apart(i, j), all + 1.0));
            let here = apart(x, y);
            let around = (total - here) / f64::max(all - 1.0, 1.0);
            squares += (here - around) * (here - around);
            sum += value(smooth, x, y);
            count += 1.0;
        }
    }
    // The mean of eight adds an eighth of the variance.
    (squares / f64::max(count, 1.0) * 8.0 / 9.0).sqrt() / (sum / f64::max(count, 1.0)).max(1e-12)
}

/// Correlation of two lists of numbers, -1 to 1.
pub(crate) fn correlation(a: &[f64], b: &[f64]) -> f64 {
    let count = a.len().min(b.len()).max(1) as f64;
    let [mean_a, mean_b] = [a, b].map(|values| values.iter().sum::<f64>() / count);
    let (mut ab, mut aa, mut bb) = (0.0, 0.0, 0.0);
    for (a, b) in a.iter().zip(b) {
        ab += (a - mean_a) * (b - mean_b);
        aa += (a - mean_a) * (a - mean_a);
        bb += (b - mean_b) * (b - mean_b);
    }
    ab / (aa * bb).sqrt().max(1e-300)
}

/// The value that a share of a list lies below.
pub(crate) fn quantile(values: &[f64], share: f64) -> f64 {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    let at = (share * sorted.len().saturating_sub(1) as f64).round() as usize;
    sorted.get(at).copied().unwrap_or(0.0)
}

/// How green the pixels of the middle half of a picture are against red, row by row: -1 is red, 1 is green.
pub(crate) fn greenness(image: &Image) -> Vec<f64> {
    texels(image, 0.5)
        .map(|texel| {
            let [red, green] = [texel[0], texel[1]].map(f64::from);
            (green - red) / (green + red).max(1e-9)
        })
        .collect()
}

/// The steepest change between neighbours in the rows of a square, as a share of the range of values: at most one pair in a
/// hundred changes more.
pub(crate) fn steepness(values: &[f64]) -> f64 {
    quantile(&steps(values).collect::<Vec<f64>>(), 0.99)
}

/// Share of the neighbours in rows, in the middle half of a picture, whose luminance differs by more than a hundredth of its
/// mean: the least contrast that an eye sees.
pub(crate) fn edges(image: &Image) -> f64 {
    let values = middle_values(image);
    let limit = values.iter().sum::<f64>() / values.len().max(1) as f64 / 100.0;
    share(steps(&values).map(|step| step > limit))
}

/// Luminance of the middle half of a picture, row by row.
pub(crate) fn middle_values(image: &Image) -> Vec<f64> {
    luminances(image, 0.5).collect()
}

/// Colour at a place from -1 to 1, +x right and +y up.
pub(crate) fn color_at(image: &Image, [x, y]: [f64; 2]) -> [f64; 3] {
    let [column, row] = [(x, image.width), (-y, image.height)]
        .map(|(v, side)| (((0.5 + 0.5 * v) * f64::from(side)) as u32).min(side - 1));
    rgb(image.texel(column, row))
}

/// Texture coordinates of the middle half of a picture of a level square that fills it, row by row. The square ends at 0.97
/// of the picture's half side, and is seen from so far that its places lie evenly.
pub(crate) fn places_of_square(image: &Image) -> impl Iterator<Item = [f64; 2]> + use<> {
    let (width, height) = (image.width, image.height);
    let texels =
        middle_of(height, 0.5).flat_map(move |y| middle_of(width, 0.5).map(move |x| [(x, width), (y, height)]));
    texels.map(|texel| texel.map(|(i, side)| 0.5 + 0.97 * ((f64::from(i) + 0.5) / f64::from(side) - 0.5)))
}

/// Places of the pixels of a ball that face the eye, and their texture coordinates. The camera is that of all balls.
pub(crate) fn places_of_ball(image: &Image) -> impl Iterator<Item = ([f64; 2], [f64; 2])> + use<> {
    let (width, height) = (image.width, image.height);
    let places = (0..width * height).map(move |i| [across(i % width, width), -across(i / width, height)]);
    places.filter_map(|place| {
        let [x, y, z] = ball_normal(place)?;
        let uv = [0.5 + libm::atan2(x, z) / (2.0 * PI), libm::acos(y.clamp(-1.0, 1.0)) / PI];
        (z > 0.5).then_some((place, uv))
    })
}

/// Distance of the eye from the middle of a ball of radius 1.
pub(crate) const BALL_DISTANCE: f64 = 7.0;

/// Normal of a ball of radius 1 at a place of its picture, by the camera of all balls: 7 away, half of its picture 1.22.
pub(crate) fn ball_normal([x, y]: [f64; 2]) -> Option<[f64; 3]> {
    const DISTANCE: f64 = BALL_DISTANCE;
    const HALF_EXTENT: f64 = 1.22;
    let across = libm::hypot(x, y) * HALF_EXTENT;
    let ray = libm::atan(across / DISTANCE);
    // By the law of sines in the triangle of eye, middle and place.
    let sin = DISTANCE * libm::sin(ray);
    if sin >= 1.0 {
        return None;
    }
    let (sin, cos) = libm::sincos(libm::asin(sin) - ray);
    let scale = if across > 0.0 { sin * HALF_EXTENT / across } else { 0.0 };
    Some([x * scale, y * scale, cos])
}

/// Texel of a map at texture coordinates.
pub(crate) fn nearest(map: &Image, [u, v]: [f64; 2]) -> &[f32] {
    let [column, row] = [(u, map.width), (v, map.height)]
        .map(|(at, side)| ((at.rem_euclid(1.0) * f64::from(side)) as u32).min(side - 1));
    map.texel(column, row)
}

fn value(image: &Image, x: u32, y: u32) -> f64 {
    luminance(rgb(image.texel(x, y)))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn even(size: u32, value: f32) -> Image {
        Image { data: vec![value; 3 * (size * size) as usize], ..Image::zeros(size, size, 3) }
    }

    #[test]
    fn single_bright_pixels_sparkle_and_a_broad_light_does_not() {
        let mut points = even(64, 0.1);
        points.texel_mut(20, 20).fill(1.0);
        points.texel_mut(40, 24).fill(1.0);
        assert!((sparkles(&points) - 2.0 / 1024.0).abs() < 1e-12);
        let mut one = even(64, 0.1);
        one.texel_mut(20, 20).fill(1.0);
        assert!((sparkles_that_stay(&points, &one) - 0.5).abs() < 1e-12);
        // A light whose brightness doubles over 16 pixels.
        let mut broad = even(64, 0.0);
        for i in 0..4096 {
            let distance = libm::hypot(f64::from(i % 64) - 32.0, f64::from(i / 64) - 32.0);
            broad.texel_mut(i % 64, i / 64).fill(libm::exp2(-distance / 16.0) as f32);
        }
        assert!(sparkles(&broad) < 1e-12);
    }

    /// A chess board of the same mean: each pixel differs by all of its deviation from the mean of its neighbours.
    #[test]
    fn noise_of_a_chess_board() {
        let smooth = even(32, 0.5);
        let mut chess = even(32, 0.5);
        for i in 0..1024 {
            let sign = if (i % 32 + i / 32) % 2 == 0 { 1.0 } else { -1.0 };
            chess.texel_mut(i % 32, i / 32).fill(0.5 + 0.1 * sign);
        }
        assert!((noise(&chess, &smooth) - 0.2 * (8.0_f64 / 9.0).sqrt()).abs() < 1e-6);
        // Brighter all over is no noise.
        assert!(noise(&even(32, 0.7), &smooth) < 1e-6);
        assert!((edges(&chess) - 1.0).abs() < 1e-12 && edges(&smooth) < 1e-12);
        assert!((color_at(&chess, [-1.0, 1.0])[0] - 0.6).abs() < 1e-6);
        assert!(
            (nearest(&chess, [0.0, 1.01])[0] - 0.6).abs() < 1e-6
                && (nearest(&chess, [-0.01, 0.0])[0] - 0.4).abs() < 1e-6
        );
        let places: Vec<[f64; 2]> = places_of_square(&chess).collect();
        assert!(
            places.len() == 256 && places.iter().all(|[u, v]| (0.25..0.75).contains(u) && (0.25..0.75).contains(v))
        );
    }

    /// A ray from the eye to a place of the ball passes through the place of the picture.
    #[test]
    fn normals_of_a_ball_are_places_that_the_eye_sees() {
        for place in [[0.0, 0.0], [0.3, -0.2], [-0.7, 0.4]] {
            let [x, y, z] = ball_normal(place).unwrap_or_default();
            assert!((x * x + y * y + z * z - 1.0).abs() < 1e-12);
            let scale = 7.0 / (7.0 - z) / 1.22;
            assert!((x * scale - place[0]).abs() < 1e-12 && (y * scale - place[1]).abs() < 1e-12, "{place:?}");
        }
        assert!(ball_normal([0.9, 0.0]).is_none());
        let middle = places_of_ball(&Image::zeros(3, 3, 3)).find(|(place, _)| *place == [0.0, 0.0]);
        assert_eq!(middle.map(|(_, uv)| uv), Some([0.5, 0.5]));
    }

    #[test]
    fn lists() {
        assert!((correlation(&[1.0, 2.0, 3.0], &[5.0, 7.0, 9.0]) - 1.0).abs() < 1e-12);
        assert!((correlation(&[1.0, 2.0, 3.0], &[2.0, 0.0, -2.0]) + 1.0).abs() < 1e-12);
        assert!((quantile(&[4.0, 0.0, 1.0, 3.0, 2.0], 0.75) - 3.0).abs() < 1e-12);
        assert!((steepness(&[0.0, 0.0, 1.0, 0.0, 0.0, 1.0, 0.0, 0.0, 1.0]) - 1.0).abs() < 1e-12);
        let mut half = even(16, 0.5);
        half.texel_mut(4, 4).copy_from_slice(&[0.0, 1.0, 0.0]);
        assert!((greenness(&half).iter().sum::<f64>() - 1.0).abs() < 1e-9);
    }
}
