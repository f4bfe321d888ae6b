//! Bytes and images as text for a page: shuffled, deflated, in base64.

use half::f16;
use luthier_lut::Image;

/// Effort of the compressor, of 10.
const EFFORT: u8 = 9;

/// Bits of a half float that are rounded away: eight of its eleven remain, a step of 0.4%.
const ROUNDED: u32 = 3;

/// Bytes of elements of a size: first bytes of all elements, then second bytes, and so on, which compress better.
pub(crate) fn bytes(data: &[u8], element: usize) -> String {
    let planes: Vec<u8> = (0..element).flat_map(|k| data.iter().skip(k).step_by(element)).copied().collect();
    packed(&planes)
}

/// Text, UTF-8.
pub(crate) fn text(text: &str) -> String {
    packed(text.as_bytes())
}

/// RGB images one after the other, as half floats: the differences along the rows of each channel of each image, modulo 2^16; first the high bytes of
/// all, then the low bytes. Exact images keep all bits.
pub(crate) fn images<'a>(images: impl IntoIterator<Item = &'a Image>, exact: bool) -> String {
    let (mut high, mut low) = (Vec::new(), Vec::new());
    for image in images {
        let channels = image.channels as usize;
        for channel in 0..3 {
            let mut before = 0_u16;
            for texel in image.data.chunks_exact(channels) {
                let value = half(texel[channel.min(channels - 1)], exact);
                let [upper, lower] = value.wrapping_sub(before).to_be_bytes();
                before = value;
                high.push(upper);
                low.push(lower);
            }
        }
    }
    high.append(&mut low);
    packed(&high)
}

fn half(value: f32, exact: bool) -> u16 {
    let bits = f16::from_f32(value.clamp(-65504.0, 65504.0)).to_bits();
    if exact || bits & 0x7fff >= 0x7bf8 { bits } else { (bits + (1 << (ROUNDED - 1))) & !((1 << ROUNDED) - 1) }
}

fn packed(data: &[u8]) -> String {
    base64(&miniz_oxide::deflate::compress_to_vec(data, EFFORT))
}

/// RFC 4648, with padding.
fn base64(bytes: &[u8]) -> String {
    const DIGITS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut out = String::with_capacity(bytes.len().div_ceil(3) * 4);
    for chunk in bytes.chunks(3) {
        let at = |i: usize| u32::from(chunk.get(i).copied().unwrap_or(0));
        let bits = at(0) << 16 | at(1) << 8 | at(2);
        for digit in 0..4 {
            let index = (bits >> (18 - 6 * digit)) & 63;
            out.push(if digit <= chunk.len() { char::from(DIGITS[index as usize]) } else { '=' });
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The test vectors of RFC 4648, section 10.
    #[test]
    fn base64_is_that_of_the_rfc() {
        for (text, encoded) in
            [("", ""), ("f", "Zg=="), ("fo", "Zm8="), ("foo", "Zm9v"), ("foob", "Zm9vYg=="), ("foobar", "Zm9vYmFy")]
        {
            assert_eq!(base64(text.as_bytes()), encoded);
        }
    }

    #[test]
    fn rounded_halves_are_near() {
        for value in [0.0_f32, 1e-3, 0.3, 1.0, 3.6, 1000.0, 65504.0] {
            let exact = f16::from_bits(half(value, true)).to_f32();
            let rounded = f16::from_bits(half(value, false)).to_f32();
            assert!((exact - value).abs() <= value * 5e-4, "{value}");
            assert!((rounded - value).abs() <= value * 5e-3, "{value}: {rounded}");
        }
    }
}
