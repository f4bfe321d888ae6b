//! The sRGB transfer function, and 8-bit pixels.

use luthier_lut::Image;

/// The sRGB transfer function of IEC 61966-2-1 as 8 bits, clipped to 0..=1; not a number is 0.
pub(crate) fn encode(linear: f32) -> u8 {
    let v = f64::from(linear).clamp(0.0, 1.0);
    let encoded = if v <= 0.003_130_8 { 12.92 * v } else { 1.055 * libm::pow(v, 1.0 / 2.4) - 0.055 };
    (encoded * 255.0).round() as u8
}

/// The inverse transfer function of a value in 0..=1.
pub(crate) fn decode(encoded: f32) -> f32 {
    let v = f64::from(encoded);
    (if v <= 0.040_45 { v / 12.92 } else { libm::pow((v + 0.055) / 1.055, 2.4) }) as f32
}

/// Pixels to look at, three bytes each: one and two channels as grey, alpha left out.
pub(crate) fn rgb8(image: &Image) -> Vec<u8> {
    let place = |channel| if image.channels < 3 { 0 } else { channel };
    image.texels().flat_map(|texel| [0, 1, 2].map(|channel| encode(texel[place(channel)]))).collect()
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
