//! RGBD: three channels in four bytes, as Babylon.js stores its tables.
//!
//! The texel (r, g, b, d) of bytes over 255 stands for `(r, g, b)^2.2 / d`. The divisor is 1 for channels up to 1. For
//! larger ones it is the largest byte that keeps the largest channel below 1, so that values up to 255 can be stored
//! (`toRGBD` and `fromRGBD` of Babylon.js 9.35).

use luthier_lut::Image;

/// Power by which channels are decoded.
const POWER: f64 = 2.2;

/// The bytes of a texel, for values of 0 to 255. Decoded bytes encode to themselves.
pub fn encode(color: [f64; 3]) -> [u8; 4] {
    let color = color.map(|value| value.clamp(0.0, 255.0));
    let mut bytes = with_divisor(color, divisor(color));
    // Rounded down, the largest channel may ask for the next divisor; it then rounds up to 1 and stays.
    for _ in 0..4 {
        let again = with_divisor(color, divisor(decode(bytes)));
        if again == bytes {
            break;
        }
        bytes = again;
    }
    bytes
}

/// The values that a texel stands for.
pub fn decode([r, g, b, d]: [u8; 4]) -> [f64; 3] {
    let divisor = f64::from(d.max(1)) / 255.0;
    [r, g, b].map(|byte| libm::pow(f64::from(byte) / 255.0, POWER) / divisor)
}

/// The bytes of a file that reads as an image of up to three channels, row by row.
pub fn texels(image: &Image) -> Vec<u8> {
    image.texels().flat_map(|texel| encode(color(texel))).collect()
}

/// The values of an image of bytes over 255, RGBD each.
pub fn decode_image(bytes: &Image) -> Image {
    let read = bytes.texels().flat_map(|texel| {
        decode(std::array::from_fn(|c| texel.get(c).map_or(u8::MAX, |value| libm::roundf(value * 255.0) as u8)))
    });
    Image { channels: 3, data: read.map(|value| value as f32).collect(), ..*bytes }
}

/// The values of a shader after decoding an image of up to three channels.
pub(crate) fn quantise(image: &Image) -> Image {
    let channels = image.channels as usize;
    let read = image.texels().flat_map(|texel| decode(encode(color(texel))).into_iter().take(channels));
    Image { data: read.map(|value| value as f32).collect(), ..*image }
}

fn color(texel: &[f32]) -> [f64; 3] {
    std::array::from_fn(|c| texel.get(c).map_or(0.0, |value| f64::from(*value)))
}

fn divisor(color: [f64; 3]) -> u8 {
    let largest = color.into_iter().fold(1.0, f64::max);
    // A largest channel that decodes to exactly 255 over a byte has this byte.
    libm::floor(255.0 / largest * (1.0 + 1e-6)).clamp(1.0, 255.0) as u8
}

fn with_divisor(color: [f64; 3], divisor: u8) -> [u8; 4] {
    let scale = f64::from(divisor) / 255.0;
    let [r, g, b] = color.map(|value| libm::round(libm::pow((value * scale).min(1.0), 1.0 / POWER) * 255.0) as u8);
    [r, g, b, divisor]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The first texel of the table that Babylon.js 9.35 ships.
    #[test]
    fn a_texel_of_babylon_is_decoded() {
        let [r, g, b] = decode([46, 46, 238, 6]);
        assert!((r - 0.9819).abs() < 1e-4 && (g - 0.9819).abs() < 1e-4 && (b - 36.5149).abs() < 1e-3);
        assert_eq!(encode([r, g, b]), [46, 46, 238, 6]);
    }

    #[test]
    fn bytes_are_kept_and_values_are_close() {
        for i in 0..4000 {
            let largest = libm::exp(f64::from(i) / 4000.0 * libm::log(200.0));
            for color in [[largest, 0.3, 0.9], [0.01, largest / 200.0, largest], [largest / 200.0, 0.02, 0.0]] {
                let bytes = encode(color);
                let read = decode(bytes);
                // As texels of 32 bits too.
                assert_eq!(encode(read.map(|value| f64::from(value as f32))), bytes, "{color:?}");
                // Half a byte of the power, over the divisor.
                let half = 0.0044 * 255.0 / f64::from(bytes[3]);
                for (a, b) in read.into_iter().zip(color) {
                    assert!((a - b).abs() <= half, "{color:?} {read:?}");
                }
            }
        }
    }
}
