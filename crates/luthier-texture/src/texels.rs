//! Layouts of texels in files of other programs: number type, channels, order.

use std::fmt;

use half::f16;
use luthier_lut::Image;

/// How one value is stored.
///
/// ```
/// use luthier_texture::Samples;
///
/// assert_eq!(Samples::Unorm8.step(), 1.0 / 255.0);
/// assert!(Samples::Half.step() > Samples::Unorm16.step());
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Samples {
    /// A byte over 255.
    Unorm8,
    /// Ten bits over 1023; the fourth channel has two.
    Unorm10,
    /// Two bytes over 65535.
    Unorm16,
    /// Half float.
    Half,
    /// 32-bit float.
    Float,
}

impl Samples {
    /// Distance of neighbouring values next to 1. Rounding errs by at most half of it.
    pub fn step(self) -> f64 {
        match self {
            Self::Unorm8 => 1.0 / 255.0,
            Self::Unorm10 => 1.0 / 1023.0,
            Self::Unorm16 => 1.0 / 65535.0,
            Self::Half => 1.0 / 2048.0,
            Self::Float => f64::from(f32::EPSILON),
        }
    }

    fn bytes(self) -> u32 {
        match self {
            Self::Unorm8 | Self::Unorm10 => 1,
            Self::Unorm16 | Self::Half => 2,
            Self::Float => 4,
        }
    }
}

/// How a texel is stored.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct TexelLayout {
    pub(crate) samples: Samples,
    pub(crate) channels: u32,
    /// Blue first.
    pub(crate) bgr: bool,
    /// sRGB-encoded, except alpha.
    pub(crate) srgb: bool,
}

impl TexelLayout {
    pub(crate) const fn of(samples: Samples, channels: u32) -> Self {
        Self { samples, channels, bgr: false, srgb: false }
    }

    /// Bytes of a texel. Three channels of ten bits and one of two take four bytes, as four of eight do.
    pub(crate) fn texel_bytes(self) -> u32 {
        self.channels * self.samples.bytes()
    }

    /// The values of some bytes, little-endian. A last texel that is cut off does not count.
    pub(crate) fn image(self, width: u32, height: u32, bytes: &[u8]) -> Image {
        let mut data: Vec<f32> = match self.samples {
            Samples::Unorm8 => bytes.iter().map(|&b| f32::from(b) / 255.0).collect(),
            Samples::Unorm10 => bytes.as_chunks().0.iter().flat_map(|b| ten_bits(u32::from_le_bytes(*b))).collect(),
            Samples::Unorm16 => {
                bytes.as_chunks().0.iter().map(|b| f32::from(u16::from_le_bytes(*b)) / 65535.0).collect()
            }
            Samples::Half => bytes.as_chunks().0.iter().map(|b| f16::from_le_bytes(*b).to_f32()).collect(),
            Samples::Float => bytes.as_chunks().0.iter().map(|b| f32::from_le_bytes(*b)).collect(),
        };
        let channels = self.channels as usize;
        for texel in data.chunks_exact_mut(channels) {
            if self.bgr && channels >= 3 {
                texel.swap(0, 2);
            }
            if self.srgb {
                texel.iter_mut().take(3).for_each(|v| *v = luthier_lut::srgb::linear(*v));
            }
        }
        Image { width, height, channels: self.channels, data }
    }
}

fn ten_bits(texel: u32) -> [f32; 4] {
    let [r, g, b] = [0, 10, 20].map(|shift| (texel >> shift & 1023) as f32 / 1023.0);
    [r, g, b, (texel >> 30) as f32 / 3.0]
}

impl fmt::Display for TexelLayout {
    /// `rg16unorm`, `bgra8unorm-srgb`: as WebGPU would name them.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let channels = match (self.channels, self.bgr) {
            (1, _) => "r",
            (2, _) => "rg",
            (3, true) => "bgr",
            (3, false) => "rgb",
            (_, true) => "bgra",
            (_, false) => "rgba",
        };
        let samples = match self.samples {
            Samples::Unorm8 => "8unorm",
            Samples::Unorm10 => "10-2unorm",
            Samples::Unorm16 => "16unorm",
            Samples::Half => "16float",
            Samples::Float => "32float",
        };
        write!(f, "{channels}{samples}{}", if self.srgb { "-srgb" } else { "" })
    }
}
