//! Colour spaces of FLIP. Linear RGB has Rec.709 primaries and D65 white.

use luthier_optics::color::multiply;

/// Rows of the matrix to XYZ, as exact fractions that follow from the Rec.709 primaries.
const TO_XYZ: [[f64; 3]; 3] = [
    [10_135_552.0 / 24_577_794.0, 8_788_810.0 / 24_577_794.0, 4_435_075.0 / 24_577_794.0],
    [2_613_072.0 / 12_288_897.0, 8_788_810.0 / 12_288_897.0, 887_015.0 / 12_288_897.0],
    [1_425_312.0 / 73_733_382.0, 8_788_810.0 / 73_733_382.0, 70_074_185.0 / 73_733_382.0],
];

/// Matrix from XYZ, the inverse of [`TO_XYZ`].
const FROM_XYZ: [[f64; 3]; 3] = [
    [3.241_003_232_976_358_5, -1.537_398_969_488_785_6, -0.498_615_881_996_363_36],
    [-0.969_224_252_202_516_5, 1.875_929_983_695_176, 0.041_554_226_340_084_73],
    [0.055_639_419_851_975_45, -0.204_011_206_123_909_1, 1.057_148_977_187_533_4],
];

/// XYZ over that of white.
fn relative_xyz(rgb: [f64; 3]) -> [f64; 3] {
    let (xyz, white) = (multiply(&TO_XYZ, rgb), multiply(&TO_XYZ, [1.0; 3]));
    [0, 1, 2].map(|c| xyz[c] / white[c])
}

/// YCxCz of linear RGB: the linear opponent space in which pictures are filtered (sec. 4.1).
pub(super) fn opponent(rgb: [f64; 3]) -> [f64; 3] {
    let [x, y, z] = relative_xyz(rgb);
    [116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)]
}

/// Linear RGB of YCxCz, clipped to the range of a display.
pub(super) fn clipped_rgb([luma, cx, cz]: [f64; 3]) -> [f64; 3] {
    let y = (luma + 16.0) / 116.0;
    let white = multiply(&TO_XYZ, [1.0; 3]);
    let xyz = [(y + cx / 500.0) * white[0], y * white[1], (y - cz / 200.0) * white[2]];
    multiply(&FROM_XYZ, xyz).map(|v| v.clamp(0.0, 1.0))
}

/// CIE 1976 L*a*b* of linear RGB, white (1, 1, 1).
fn lab(rgb: [f64; 3]) -> [f64; 3] {
    const DELTA: f64 = 6.0 / 29.0;
    let [x, y, z] = relative_xyz(rgb)
        .map(|t: f64| if t > DELTA * DELTA * DELTA { libm::cbrt(t) } else { t / (3.0 * DELTA * DELTA) + 4.0 / 29.0 });
    [116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)]
}

/// L*a*b* with the chroma scaled by lightness, after Hunt: colours fade in the dark (sec. 4.1).
pub(super) fn hunt_lab(rgb: [f64; 3]) -> [f64; 3] {
    let [lightness, a, b] = lab(rgb);
    [lightness, 0.01 * lightness * a, 0.01 * lightness * b]
}

/// Lightness L*, chroma C*ab and hue hab in degrees, 0 to 360, of a linear Rec.709 colour (CIE 1976, D65 white). Without chroma the hue is
/// meaningless.
pub fn lightness_chroma_hue(rgb: [f64; 3]) -> [f64; 3] {
    let [lightness, a, b] = lab(rgb);
    let hue = libm::atan2(b, a).to_degrees();
    [lightness, libm::hypot(a, b), if hue < 0.0 { hue + 360.0 } else { hue }]
}

/// HyAB distance: absolute in lightness plus Euclidean in chroma (Abasi et al. 2020).
pub(super) fn hyab(a: [f64; 3], b: [f64; 3]) -> f64 {
    let [l, x, y] = [0, 1, 2].map(|c| a[c] - b[c]);
    l.abs() + (x * x + y * y).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Red of Rec.709, as every table of it has: L* 53.24, C* 104.55, h 40.0.
    #[test]
    fn red_has_its_place_in_lab() {
        let found = lightness_chroma_hue([1.0, 0.0, 0.0]);
        for (value, expected) in found.iter().zip([53.24, 104.55, 40.0]) {
            assert!((value - expected).abs() < 0.05, "{found:?}");
        }
        assert!(lightness_chroma_hue([0.5; 3])[1] < 1e-9);
    }

    #[test]
    fn opponent_colours_come_back() {
        for rgb in [[0.0, 0.0, 0.0], [1.0, 1.0, 1.0], [0.2, 0.5, 0.9], [1.0, 0.0, 0.3]] {
            let back = clipped_rgb(opponent(rgb));
            (0..3).for_each(|c| assert!((back[c] - rgb[c]).abs() < 1e-9, "{rgb:?} {back:?}"));
        }
    }

    #[test]
    fn white_is_100_and_colourless() {
        let [l, a, b] = hunt_lab([1.0; 3]);
        assert!((l - 100.0).abs() < 1e-9 && a.abs() < 1e-9 && b.abs() < 1e-9);
    }
}
