//! Bytes and images as text for a page: shuffled, deflated, in base64.

use base64::Engine;
use base64::prelude::BASE64_STANDARD as STANDARD;
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
    STANDARD.encode(miniz_oxide::deflate::compress_to_vec(data, EFFORT))
}

#[cfg(test)]
mod tests {
    use super::*;

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
