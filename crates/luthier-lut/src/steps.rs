//! Texels with the steps to the next ones: [`crate::TexelFormat::Rgba16FloatSteps`].
//!
//! A read is `value + t step`, one multiplication and one sum, where both ends would take two of each. The step is rounded to a half float of
//! its own, so that the end of an interval may lie beside the next texel by half a unit of the step's last place.

use half::f16;

use crate::Image;

/// Half floats of one texel: four values, four steps.
const HALVES: usize = 8;

/// Bytes of the texels of an image, row by row. Missing channels are 0, and 1 for alpha.
pub(crate) fn encode(image: &Image) -> Vec<u8> {
    let halves: Vec<[f16; 4]> = image
        .texels()
        .map(|texel| std::array::from_fn(|c| half(texel.get(c).copied().unwrap_or(f32::from(c == 3)))))
        .collect();
    let width = image.width.max(1) as usize;
    let pairs = halves.iter().enumerate().flat_map(|(i, here)| {
        let next = if (i + 1) % width == 0 { here } else { &halves[i + 1] };
        let steps = [0, 1, 2, 3].map(|c: usize| step(here[c].to_f32(), next[c].to_f32()));
        here.iter().copied().chain(steps).collect::<Vec<f16>>()
    });
    pairs.flat_map(f16::to_le_bytes).collect()
}

/// The values, four a texel, without the steps.
pub(crate) fn values(bytes: &[u8]) -> Vec<f32> {
    let texels = bytes.chunks_exact(2 * HALVES);
    texels
        .flat_map(|texel| texel[..HALVES].chunks_exact(2).map(|b| f16::from_le_bytes([b[0], b[1]]).to_f32()))
        .collect()
}

/// Whether every step leads to the next texel, as [`encode`] writes them.
pub(crate) fn is_whole(width: u32, bytes: &[u8]) -> bool {
    let data = values(bytes);
    let height = (data.len() / 4).checked_div(width as usize).unwrap_or(0) as u32;
    data.iter().all(|value| value.is_finite()) && encode(&Image { width, height, channels: 4, data }) == bytes
}

/// The step from a value to another, as a shader reads it.
pub(crate) fn step(from: f32, to: f32) -> f16 {
    half(to - from)
}

/// The nearest finite half float.
fn half(value: f32) -> f16 {
    f16::from_f32(value.clamp(-f16::MAX.to_f32(), f16::MAX.to_f32()))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// By hand: 1 is 0x3c00, 0.75 is 0x3a00, 0.5 is 0x3800, 0.25 is 0x3400, -0.5 is 0xb800.
    #[test]
    fn a_texel_is_followed_by_the_step_to_the_next() {
        let image = Image { width: 2, height: 2, channels: 1, data: vec![0.5, 1.0, 0.75, 0.25] };
        let words: Vec<u16> = encode(&image).chunks_exact(2).map(|b| u16::from_le_bytes([b[0], b[1]])).collect();
        let red: Vec<[u16; 2]> = words.chunks_exact(HALVES).map(|texel| [texel[0], texel[4]]).collect();
        assert_eq!(red, [[0x3800, 0x3800], [0x3c00, 0], [0x3a00, 0xb800], [0x3400, 0]]);
        assert!(is_whole(2, &encode(&image)));
        assert!(!is_whole(4, &encode(&image)), "the second row begins anew");
        let mut spoilt = encode(&image);
        spoilt[8] ^= 1;
        assert!(!is_whole(2, &spoilt));
    }
}
