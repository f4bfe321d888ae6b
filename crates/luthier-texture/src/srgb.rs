//! 8-bit pixels to look at.

use luthier_lut::Image;

/// The 8-bit code of a linear value, clipped to 0..=1; NaN is 0.
pub(crate) fn encode(linear: f32) -> u8 {
    (luthier_lut::srgb::code(linear) * 255.0).round() as u8
}

/// Pixels to look at, three bytes each: one and two channels as grey, alpha left out.
pub(crate) fn rgb8(image: &Image) -> Vec<u8> {
    let places = if image.channels < 3 { [0; 3] } else { [0, 1, 2] };
    image.texels().flat_map(|texel| places.map(|channel| encode(texel[channel]))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// IEC 61966-2-1 inverted by hand at code values 1, 11, 64, 128 and 200, a step below and above the threshold; 0.5
    /// is 187.52.
    #[test]
    fn known_codes() {
        for (linear, code) in [
            (0.0, 0),
            (0.000_303_527, 1),
            (0.003_346_536, 11),
            (0.051_269_46, 64),
            (0.215_860_5, 128),
            (0.5, 188),
            (0.577_580_4, 200),
            (1.0, 255),
            (-3.0, 0),
            (7.0, 255),
            (f32::INFINITY, 255),
            (f32::NAN, 0),
        ] {
            assert_eq!(encode(linear), code, "{linear}");
        }
    }
}
