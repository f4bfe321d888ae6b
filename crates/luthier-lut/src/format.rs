//! Texel formats: sizes, quantisation, bytes.

use half::f16;
use serde::{Deserialize, Serialize};

use crate::{Image, LutError, bc6h, steps};

crate::named! {
    /// Texel formats, named as WebGPU names them.
    ///
    /// ```
    /// use luthier_lut::{Image, TexelFormat};
    ///
    /// let format: TexelFormat = "rgba8unorm".parse().unwrap();
    /// let grey = Image { width: 1, height: 1, channels: 1, data: vec![0.5] };
    /// // Missing channels are 0, and alpha is 1.
    /// assert_eq!(format.encode(&grey), [128, 0, 0, 255]);
    /// assert_eq!(format.quantise(&grey).data[0], 128.0 / 255.0);
    /// ```
    #[derive(Serialize, Deserialize)]
    #[serde(into = "&'static str", try_from = "String")]
    pub enum TexelFormat("texel format") {
        /// One half float.
        R16Float = "r16float",
        /// Two half floats.
        Rg16Float = "rg16float",
        /// One float. Not filterable in core WebGPU.
        R32Float = "r32float",
        /// Four unsigned normalised bytes, linear.
        Rgba8Unorm = "rgba8unorm",
        /// Three unsigned normalised values of ten bits and one of two, in 32 bits.
        Rgb10a2Unorm = "rgb10a2unorm",
        /// Floats without sign in 32 bits: two of eleven bits and one of ten, six and five bits of them mantissa.
        Rg11b10Ufloat = "rg11b10ufloat",
        /// Four unsigned normalised values of 16 bits. Not in core WebGPU: the feature `TEXTURE_FORMAT_16BIT_NORM` of wgpu.
        Rgba16Unorm = "rgba16unorm",
        /// Three half floats without sign in blocks of 4 x 4 texels, 16 bytes each (BC6H). Not in core WebGPU: the feature `TEXTURE_COMPRESSION_BC`.
        Bc6hRgbUfloat = "bc6h-rgb-ufloat",
        /// Four half floats.
        Rgba16Float = "rgba16float",
        /// Four floats. Not filterable in core WebGPU.
        Rgba32Float = "rgba32float",
        /// Four half floats, and the four steps to those of the texel on the right as half floats; the steps of the last texel of a row are 0. Shaders read such
        /// texels from a storage buffer, one word of 16 bytes for both ends of an interval, or fetch them as `rgba32uint`. No format of WebGPU.
        Rgba16FloatSteps = "rgba16float-steps",
    }
}

impl TexelFormat {
    /// Channels per texel.
    pub fn channels(self) -> u32 {
        match self {
            Self::R16Float | Self::R32Float => 1,
            Self::Rg16Float => 2,
            Self::Rg11b10Ufloat | Self::Bc6hRgbUfloat => 3,
            Self::Rgba8Unorm
            | Self::Rgb10a2Unorm
            | Self::Rgba16Unorm
            | Self::Rgba16Float
            | Self::Rgba32Float
            | Self::Rgba16FloatSteps => 4,
        }
    }

    /// Texels along a side of a block; 1 where every texel is by itself. Sides of images, and of the tiles of an atlas, are multiples of it.
    pub fn block_side(self) -> u32 {
        if self == Self::Bc6hRgbUfloat { bc6h::SIDE } else { 1 }
    }

    /// Bytes of a row of texels or blocks.
    pub fn row_bytes(self, width: u32) -> u32 {
        width * self.block_side() * self.texel_bytes()
    }

    /// Whether core WebGPU has it.
    pub const fn is_core(self) -> bool {
        !matches!(self, Self::Rgba16Unorm | Self::Bc6hRgbUfloat)
    }

    /// Bytes per channel. Formats whose channels share a word have the bytes of the word; blocks have 1.
    pub fn channel_bytes(self) -> u32 {
        match self {
            Self::Rgba8Unorm | Self::Bc6hRgbUfloat => 1,
            Self::R16Float | Self::Rg16Float | Self::Rgba16Unorm | Self::Rgba16Float | Self::Rgba16FloatSteps => 2,
            Self::R32Float | Self::Rgb10a2Unorm | Self::Rg11b10Ufloat | Self::Rgba32Float => 4,
        }
    }

    /// Bytes per texel; of a block, its share.
    pub fn texel_bytes(self) -> u32 {
        match self {
            Self::Rgb10a2Unorm | Self::Rg11b10Ufloat => 4,
            Self::Bc6hRgbUfloat => 1,
            Self::Rgba16FloatSteps => 16,
            _ => self.channels() * self.channel_bytes(),
        }
    }

    /// Whether a filtering sampler may read it in core WebGPU.
    pub fn is_filterable(self) -> bool {
        !matches!(self, Self::R32Float | Self::Rgba32Float | Self::Rgba16FloatSteps)
    }

    /// Whether its texels have the steps to the next ones. Such a table is a storage buffer where the language has these.
    pub fn has_steps(self) -> bool {
        self == Self::Rgba16FloatSteps
    }

    /// The largest code of its first three channels, if they are unsigned and normalised.
    pub fn unorm_max(self) -> Option<f64> {
        match self {
            Self::Rgba8Unorm => Some(255.0),
            Self::Rgb10a2Unorm => Some(1023.0),
            Self::Rgba16Unorm => Some(65535.0),
            _ => None,
        }
    }

    /// The texels of an image as little-endian bytes, rounded to nearest. Channels the image lacks are 0, and 1 for
    /// alpha; surplus channels are dropped. Unorm clamps to 0..1; floats of less than 32 bits clamp to their finite range. Blocks are
    /// fitted to their texels; texels that were decoded from blocks may encode to other bytes.
    ///
    /// # Panics
    /// Where a side is no multiple of [`Self::block_side`].
    pub fn encode(self, image: &Image) -> Vec<u8> {
        match self {
            Self::Bc6hRgbUfloat => return bc6h::encode(image),
            Self::Rgba16FloatSteps => return steps::encode(image),
            _ => {}
        }
        let mut bytes = Vec::with_capacity(image.texel_count() * self.texel_bytes() as usize);
        for texel in image.texels() {
            // Alpha is 1 where the image has none.
            let texel: [f32; 4] = std::array::from_fn(|c| texel.get(c).copied().unwrap_or(f32::from(c == 3)));
            match self {
                Self::Rgba8Unorm => bytes.extend(texel.map(|value| unorm(value, 255.0) as u8)),
                Self::Rgb10a2Unorm => {
                    let [r, g, b, _] = texel.map(|value| unorm(value, 1023.0));
                    bytes.extend_from_slice(&(r | g << 10 | b << 20 | unorm(texel[3], 3.0) << 30).to_le_bytes());
                }
                Self::Rgba16Unorm => {
                    bytes.extend(texel.into_iter().flat_map(|value| (unorm(value, 65535.0) as u16).to_le_bytes()));
                }
                Self::Rg11b10Ufloat => {
                    let [r, g, b] =
                        [(0, 6), (1, 6), (2, 5)].map(|(c, mantissa): (usize, _)| ufloat(texel[c], mantissa));
                    bytes.extend_from_slice(&(r | g << 11 | b << 22).to_le_bytes());
                }
                Self::Bc6hRgbUfloat | Self::Rgba16FloatSteps => {}
                Self::R16Float | Self::Rg16Float | Self::Rgba16Float => {
                    for value in &texel[..self.channels() as usize] {
                        let finite = value.clamp(-f16::MAX.to_f32(), f16::MAX.to_f32());
                        bytes.extend_from_slice(&f16::from_f32(finite).to_le_bytes());
                    }
                }
                Self::R32Float | Self::Rgba32Float => {
                    bytes.extend(texel[..self.channels() as usize].iter().flat_map(|value| value.to_le_bytes()));
                }
            }
        }
        bytes
    }

    /// The image that a shader reads once these texels have been encoded.
    pub fn quantise(self, image: &Image) -> Image {
        self.texels(image).1
    }

    /// The bytes of an image's texels, and the image that a shader reads from them.
    pub fn texels(self, image: &Image) -> (Vec<u8>, Image) {
        let (bytes, [width, height]) = (self.encode(image), [image.width, image.height]);
        let data = self.values(width, height, &bytes);
        (bytes, Image { width, height, channels: self.channels(), data })
    }

    /// The image that a shader reads from these bytes.
    ///
    /// # Errors
    /// [`LutError::TexelBytes`] when the length does not fit, [`LutError::Blocks`] for parts of blocks and for modes of BC6H that
    /// [`Self::encode`] does not write, [`LutError::Steps`] for steps that do not lead to the next texel.
    pub fn decode(self, width: u32, height: u32, bytes: &[u8]) -> Result<Image, LutError> {
        let expected = (width as usize).saturating_mul(height as usize).saturating_mul(self.texel_bytes() as usize);
        if bytes.len() != expected {
            return Err(LutError::TexelBytes { found: bytes.len(), expected });
        }
        let side = self.block_side();
        if !width.is_multiple_of(side) || !height.is_multiple_of(side) || side > 1 && !bc6h::is_known(bytes) {
            return Err(LutError::Blocks);
        }
        if self.has_steps() && !steps::is_whole(width, bytes) {
            return Err(LutError::Steps);
        }
        Ok(Image { width, height, channels: self.channels(), data: self.values(width, height, bytes) })
    }

    fn values(self, width: u32, height: u32, bytes: &[u8]) -> Vec<f32> {
        let words = bytes.chunks_exact(4).map(|b| u32::from_le_bytes([b[0], b[1], b[2], b[3]]));
        match self {
            Self::Rgba8Unorm => bytes.iter().map(|&b| f32::from(b) / 255.0).collect(),
            Self::Bc6hRgbUfloat => bc6h::decode(width, height, bytes),
            Self::Rgb10a2Unorm => words
                .flat_map(|w| {
                    let [r, g, b] = [0, 10, 20].map(|shift| (w >> shift & 1023) as f32 / 1023.0);
                    [r, g, b, (w >> 30) as f32 / 3.0]
                })
                .collect(),
            Self::Rgba16Unorm => {
                bytes.chunks_exact(2).map(|b| f32::from(u16::from_le_bytes([b[0], b[1]])) / 65535.0).collect()
            }
            Self::Rg11b10Ufloat => words
                .flat_map(|w| {
                    // A half float without its sign, the last bits of its mantissa 0.
                    [(w & 2047) << 4, (w >> 11 & 2047) << 4, w >> 22 << 5]
                        .map(|bits| f16::from_bits(bits as u16).to_f32())
                })
                .collect(),
            Self::R16Float | Self::Rg16Float | Self::Rgba16Float => {
                bytes.chunks_exact(2).map(|b| f16::from_le_bytes([b[0], b[1]]).to_f32()).collect()
            }
            Self::R32Float | Self::Rgba32Float => words.map(f32::from_bits).collect(),
            Self::Rgba16FloatSteps => steps::values(bytes),
        }
    }
}

/// A set of texel formats.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct FormatSet(u16);

impl FormatSet {
    /// The formats of core WebGPU.
    pub const CORE: Self = {
        let (mut set, mut i) = (0, 0);
        while i < TexelFormat::ALL.len() {
            set |= (TexelFormat::ALL[i].is_core() as u16) << TexelFormat::ALL[i] as u16;
            i += 1;
        }
        Self(set)
    };

    /// Whether it has a format.
    pub fn has(self, format: TexelFormat) -> bool {
        self.0 >> format as u16 & 1 == 1
    }
}

impl FromIterator<TexelFormat> for FormatSet {
    fn from_iter<I: IntoIterator<Item = TexelFormat>>(formats: I) -> Self {
        Self(formats.into_iter().fold(0, |set, format| set | 1 << format as u16))
    }
}

/// The code of an unsigned normalised value. In f64 the product is exact: it is rounded once.
fn unorm(value: f32, max: f64) -> u32 {
    (f64::from(value.clamp(0.0, 1.0)) * max).round() as u32
}

/// The bits of a float without sign, of five bits of exponent as a half float has, rounded to nearest even.
fn ufloat(value: f32, mantissa: u32) -> u32 {
    let dropped = 10 - mantissa;
    let max = f16::from_bits(0x7bff >> dropped << dropped).to_f32();
    // Not a number is 0.
    let finite = if value > 0.0 { value.min(max) } else { 0.0 };
    // The exponent of the value, that of subnormal numbers at least.
    let exponent = ((finite.to_bits() >> 23) as i32 - 127).max(-14);
    let step = f32::from_bits(((exponent - mantissa as i32 + 127) as u32) << 23);
    let rounded = (finite / step).round_ties_even() * step;
    u32::from(f16::from_f32(rounded).to_bits()) >> dropped
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn row(channels: u32, data: &[f32]) -> Image {
        Image { width: data.len() as u32 / channels, height: 1, channels, data: data.to_vec() }
    }

    /// Bit patterns of IEEE 754 binary16, worked out by hand.
    #[test]
    fn half_floats_round_to_nearest_even() {
        for (value, bits) in [
            (0.0, 0x0000),
            (-0.0, 0x8000),
            (1.0, 0x3c00),
            (-2.0, 0xc000),
            (1.0 / 3.0, 0x3555),
            (65504.0, 0x7bff),
            // Halfway between 1 and the next half, 1 + 2^-10: to the even one; a little more: up.
            (1.0 + 1.0 / 2048.0, 0x3c00),
            (1.0 + 1.0 / 2048.0 + 1e-6, 0x3c01),
            // Halfway between 1 + 2^-10 and 1 + 2^-9: the even one is above.
            (1.0 + 3.0 / 2048.0, 0x3c02),
            // Smallest normal, smallest subnormal, and half of that.
            (6.103_515_6e-5, 0x0400),
            (5.960_464_5e-8, 0x0001),
            (2.980_232_2e-8, 0x0000),
            // Beyond the range: clamped rather than infinite.
            (1e6, 0x7bff),
            (f32::NEG_INFINITY, 0xfbff),
        ] {
            let bytes = TexelFormat::R16Float.encode(&row(1, &[value]));
            assert_eq!(u16::from_le_bytes([bytes[0], bytes[1]]), bits, "{value}");
        }
    }

    #[test]
    fn unorm_rounds_and_clamps() {
        let values =
            [0.0, 1.0, 0.5, 127.0 / 255.0, 0.499 / 255.0, 0.501 / 255.0, -1.0, 3.0, f32::NAN, 254.4 / 255.0, 0.2, 0.8];
        let bytes = TexelFormat::Rgba8Unorm.encode(&row(4, &values));
        assert_eq!(bytes, [0, 255, 128, 127, 0, 1, 0, 255, 0, 254, 51, 204]);
        // 65535, 32768 (a half up), 0, and the opaque fourth channel; low bytes first.
        let wide = TexelFormat::Rgba16Unorm.encode(&row(3, &[1.0, 0.5, 0.0]));
        assert_eq!(wide, [0xff, 0xff, 0x00, 0x80, 0, 0, 0xff, 0xff]);
    }

    /// Bit patterns worked out by hand: exponents are biased by 15, mantissas have six and five bits.
    #[test]
    fn packed_formats_lay_red_in_the_lowest_bits() {
        let word =
            |format: TexelFormat, rgb: [f32; 3]| u32::from_le_bytes(format.encode(&row(3, &rgb)).try_into().unwrap());
        assert_eq!(word(TexelFormat::Rgb10a2Unorm, [1.0, 0.0, 0.5]), 3 << 30 | 512 << 20 | 1023);
        assert_eq!(word(TexelFormat::Rg11b10Ufloat, [1.0, 0.0, 0.0]), 15 << 6);
        assert_eq!(word(TexelFormat::Rg11b10Ufloat, [0.0, 1.5, 0.0]), (15 << 6 | 32) << 11);
        assert_eq!(word(TexelFormat::Rg11b10Ufloat, [-1.0, f32::NAN, 2.0]), 16 << 5 << 22);
        // Halfway between 1 and 1 + 2^-6: to even; beyond the range: the largest there is.
        assert_eq!(word(TexelFormat::Rg11b10Ufloat, [1.0 + 1.0 / 128.0, 1e9, 0.0]), (30 << 6 | 63) << 11 | 15 << 6);
    }

    #[test]
    fn missing_channels_are_black_and_opaque_surplus_ones_go() {
        let image = row(1, &[0.25]);
        assert_eq!(TexelFormat::Rgba16FloatSteps.encode(&image)[6..], [0x00, 0x3c, 0, 0, 0, 0, 0, 0, 0, 0]);
        assert_eq!(TexelFormat::Rgba8Unorm.encode(&image), [64, 0, 0, 255]);
        let decoded = TexelFormat::Rgba32Float.decode(1, 1, &TexelFormat::Rgba32Float.encode(&image)).unwrap();
        assert_eq!(decoded.data, [0.25, 0.0, 0.0, 1.0]);
        let image = row(4, &[0.25, 0.5, 0.75, 1.0]);
        assert_eq!(TexelFormat::R32Float.encode(&image), 0.25f32.to_le_bytes());
    }

    #[test]
    fn names_parse_and_serialise_alike() {
        for format in TexelFormat::ALL {
            assert_eq!(format.to_string().parse::<TexelFormat>().unwrap(), format);
            assert_eq!(serde_json::to_string(&format).unwrap(), format!("\"{format}\""));
        }
        assert!("rgba8unorm-srgb".parse::<TexelFormat>().is_err());
    }

    #[test]
    fn sizes_are_those_of_webgpu() {
        let sizes = TexelFormat::ALL.map(|format| (format.texel_bytes(), format.is_filterable()));
        let expected = [
            (2, true),
            (4, true),
            (4, false),
            (4, true),
            (4, true),
            (4, true),
            (8, true),
            (1, true),
            (8, true),
            (16, false),
            (16, false),
        ];
        assert_eq!(sizes, expected);
        // A row of blocks is four rows of texels.
        let rows = [TexelFormat::Rgba8Unorm, TexelFormat::Bc6hRgbUfloat].map(|format| format.row_bytes(64));
        assert_eq!(rows, [256, 256]);
    }

    #[test]
    fn sets_hold_what_they_were_made_of() {
        for format in TexelFormat::ALL {
            assert_eq!(FormatSet::CORE.has(format), format.is_core(), "{format}");
            let one: FormatSet = [format].into_iter().collect();
            assert_eq!(TexelFormat::ALL.into_iter().filter(|f| one.has(*f)).collect::<Vec<_>>(), [format]);
        }
    }

    #[test]
    fn blocks_are_whole_and_of_known_modes() {
        let format = TexelFormat::Bc6hRgbUfloat;
        let (bytes, read) = format.texels(&Image { data: vec![0.25; 8 * 4 * 3], ..Image::zeros(8, 4, 3) });
        assert_eq!((bytes.len(), read.channels), (32, 3));
        assert!(read.data.iter().all(|v| *v == 0.25));
        assert_eq!(format.decode(8, 4, &bytes).unwrap(), read);
        assert!(matches!(format.decode(16, 2, &bytes), Err(LutError::Blocks)));
        assert!(matches!(format.decode(8, 4, &[2; 32]), Err(LutError::Blocks)));
    }

    #[test]
    fn wrong_lengths_are_errors_even_when_sizes_overflow() {
        for format in TexelFormat::ALL {
            assert!(matches!(format.decode(2, 2, &[0; 3]), Err(LutError::TexelBytes { found: 3, .. })));
            assert!(format.decode(u32::MAX, u32::MAX, &[]).is_err());
            assert!(format.decode(1 << 31, 2, &[]).is_err());
        }
    }

    proptest! {
        #[test]
        fn what_was_decoded_encodes_to_the_same_bytes(bytes in prop::collection::vec(any::<u8>(), 48)) {
            for format in TexelFormat::ALL.into_iter().filter(|format| format.block_side() == 1 && !format.has_steps()) {
                let width = 48 / format.texel_bytes();
                let image = format.decode(width, 1, &bytes).unwrap();
                // Half floats that are not finite are clamped, by contract; floats that are not numbers keep their bits.
                if format != TexelFormat::R32Float && format != TexelFormat::Rgba32Float && image.data.iter().any(|v| !v.is_finite()) {
                    continue;
                }
                prop_assert_eq!(&format.encode(&image), &bytes);
            }
        }

        #[test]
        fn rounding_is_within_half_a_step(values in prop::collection::vec(0.0..1.0f32, 8)) {
            // What is read is an f32: half its step below 1.
            let read = 1.0 / f64::from(1 << 25);
            // Half steps below 1: 2^-12 for half floats, half a code for unorm.
            for (format, half_steps) in [
                (TexelFormat::Rgba16Float, [1.0 / 4096.0; 4]),
                (TexelFormat::Rgba8Unorm, [0.5 / 255.0; 4]),
                (TexelFormat::Rgba16Unorm, [0.5 / 65535.0; 4]),
                (TexelFormat::Rgb10a2Unorm, [0.5 / 1023.0, 0.5 / 1023.0, 0.5 / 1023.0, 0.5 / 3.0]),
                (TexelFormat::Rg11b10Ufloat, [1.0 / 256.0, 1.0 / 256.0, 1.0 / 128.0, 0.0]),
            ] {
                let channels = format.channels() as usize;
                let image = format.decode(2, 1, &format.encode(&row(4, &values))).unwrap();
                for (found, texel) in image.texels().zip(values.chunks(4)) {
                    for c in 0..channels {
                        let (a, b) = (found[c], texel[c]);
                        prop_assert!((f64::from(a) - f64::from(b)).abs() <= half_steps[c] + read, "{format}: {b} became {a}");
                    }
                }
            }
        }
    }
}
