//! Pictures with their stored samples, 8 or 16 bits a value, and the values that a sampler gives.

use std::sync::LazyLock;

use crate::{Image, srgb};

/// A picture in the samples of its file, row by row from the top, channels interleaved. With samples of 8 bits it takes a quarter of the bytes
/// of an [`Image`].
///
/// ```
/// use luthier_lut::{Picture, PictureSamples};
/// let grey = Picture { width: 1, height: 1, channels: 1, is_srgb: true, samples: PictureSamples::Bits8(vec![188]) };
/// assert!((grey.texel(0, 0)[0] - 0.5).abs() < 0.003);
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Picture {
    /// Texels across.
    pub width: u32,
    /// Texels down.
    pub height: u32,
    /// 1 grey, 2 grey and alpha, 3 RGB, 4 RGBA.
    pub channels: u32,
    /// Whether colours are stored by the sRGB curve; alpha never is.
    pub is_srgb: bool,
    /// `width * height * channels` values.
    pub samples: PictureSamples,
}

/// Values of a picture.
#[derive(Debug, Clone, PartialEq)]
pub enum PictureSamples {
    /// Bytes, over 255.
    Bits8(Vec<u8>),
    /// Words of 16 bits, over 65535.
    Bits16(Vec<u16>),
    /// Floats, unscaled.
    Float(Vec<f32>),
}

/// The sRGB curve at the codes of 8 bits.
static CURVE: LazyLock<[f32; 256]> = LazyLock::new(|| std::array::from_fn(|code| srgb::linear(code as f32 / 255.0)));

impl Picture {
    /// Texels across and down.
    pub fn size(&self) -> [u32; 2] {
        [self.width, self.height]
    }

    /// Number of texels.
    pub fn texel_count(&self) -> usize {
        self.width as usize * self.height as usize
    }

    /// RGBA of a texel, linear, as a sampler gives it: grey three times, alpha 1 where the picture has none.
    pub fn texel(&self, x: u32, y: u32) -> [f32; 4] {
        self.at(y as usize * self.width as usize + x as usize)
    }

    /// RGBA of all texels, linear, row by row.
    pub fn texels(&self) -> impl Iterator<Item = [f32; 4]> {
        (0..self.texel_count()).map(|i| self.at(i))
    }

    /// One channel, 0 to 3 for R, G, B and A, as an image.
    pub fn channel(&self, channel: usize) -> Image {
        let data = self.texels().map(|texel| texel[channel.min(3)]).collect();
        Image { width: self.width, height: self.height, channels: 1, data }
    }

    /// All four channels as an image.
    pub fn image(&self) -> Image {
        Image { width: self.width, height: self.height, channels: 4, data: self.texels().flatten().collect() }
    }

    /// The value of a sample as it is stored, over its maximum.
    pub fn stored(&self, index: usize) -> f32 {
        match &self.samples {
            PictureSamples::Bits8(values) => f32::from(values[index]) / 255.0,
            PictureSamples::Bits16(values) => f32::from(values[index]) / 65535.0,
            PictureSamples::Float(values) => values[index],
        }
    }

    fn at(&self, texel: usize) -> [f32; 4] {
        let channels = self.channels as usize;
        let first = texel * channels;
        let colors = if channels < 3 { [0; 3] } else { [0, 1, 2] };
        let [r, g, b] = colors.map(|channel| self.color(first + channel));
        let alpha = if channels.is_multiple_of(2) { self.stored(first + channels - 1) } else { 1.0 };
        [r, g, b, alpha]
    }

    /// The linear value of a sample of a colour.
    fn color(&self, index: usize) -> f32 {
        match &self.samples {
            PictureSamples::Bits8(values) if self.is_srgb => CURVE[usize::from(values[index])],
            _ if self.is_srgb => srgb::linear(self.stored(index)),
            _ => self.stored(index),
        }
    }
}

impl From<Image> for Picture {
    fn from(image: Image) -> Self {
        let Image { width, height, channels, data } = image;
        Self { width, height, channels, is_srgb: false, samples: PictureSamples::Float(data) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn picture(channels: u32, is_srgb: bool, samples: PictureSamples) -> Picture {
        Picture { width: 1, height: 1, channels, is_srgb, samples }
    }

    /// IEC 61966-2-1 by hand: codes 11 and 128 of 255 are .003346536 and .2158605. Alpha has no curve.
    #[test]
    fn colours_have_a_curve_and_alpha_has_none() {
        for samples in [
            PictureSamples::Bits8(vec![11, 128, 255, 128]),
            PictureSamples::Bits16([11, 128, 255, 128].map(|code| code * 257).to_vec()),
            PictureSamples::Float([11.0, 128.0, 255.0, 128.0].map(|code: f32| code / 255.0).to_vec()),
        ] {
            let texel = picture(4, true, samples.clone()).texel(0, 0);
            let expected = [0.003_346_536, 0.215_860_5, 1.0, 128.0 / 255.0];
            assert!(texel.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-6), "{samples:?}: {texel:?}");
            assert_eq!(picture(4, false, samples).texel(0, 0)[1], 128.0 / 255.0);
        }
    }

    #[test]
    fn grey_is_all_colours() {
        assert_eq!(picture(1, false, PictureSamples::Bits8(vec![51])).texel(0, 0), [0.2, 0.2, 0.2, 1.0]);
        assert_eq!(picture(2, false, PictureSamples::Bits8(vec![51, 102])).texel(0, 0), [0.2, 0.2, 0.2, 0.4]);
        assert_eq!(picture(2, false, PictureSamples::Bits8(vec![51, 102])).channel(3).data, [0.4]);
    }
}
