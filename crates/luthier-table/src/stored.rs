//! Number types of texels.

use luthier_lut::{Image, TexelFormat};

use crate::rgbd;

/// Number type of texels.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Stored {
    /// A byte over 255.
    Unorm8,
    /// Ten bits over 1023.
    Unorm10,
    /// Two bytes over 65535.
    Unorm16,
    /// Half float.
    Half,
    /// 32-bit float.
    Float,
    /// Three channels in four bytes, with a common divisor: see [`rgbd`].
    Rgbd,
}

impl Stored {
    /// Its name in reports.
    pub fn name(self) -> &'static str {
        match self {
            Self::Unorm8 => "unorm8",
            Self::Unorm10 => "unorm10",
            Self::Unorm16 => "unorm16",
            Self::Half => "half",
            Self::Float => "float",
            Self::Rgbd => "rgbd",
        }
    }

    /// Bytes of a texel with this many values.
    pub fn texel_bytes(self, channels: usize) -> usize {
        match self {
            Self::Unorm8 => channels,
            Self::Unorm10 | Self::Rgbd => 4,
            Self::Unorm16 | Self::Half => 2 * channels,
            Self::Float => 4 * channels,
        }
    }

    /// The values that a shader reads, for an image of up to four channels.
    pub fn quantise(self, image: &Image) -> Image {
        let format = match self {
            Self::Unorm8 => TexelFormat::Rgba8Unorm,
            Self::Unorm10 => TexelFormat::Rgb10a2Unorm,
            Self::Unorm16 => TexelFormat::Rgba16Unorm,
            Self::Half => TexelFormat::Rgba16Float,
            Self::Float => return image.clone(),
            Self::Rgbd => return rgbd::quantise(image),
        };
        let read = format.quantise(image);
        let channels = image.channels as usize;
        let data = read.texels().flat_map(|texel| texel[..channels].iter().copied()).collect();
        Image { channels: image.channels, data, ..read }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn texels_are_rounded_as_stored() {
        let image = Image { width: 1, height: 1, channels: 2, data: vec![0.3, 0.700_1] };
        for stored in [Stored::Unorm8, Stored::Unorm10, Stored::Unorm16, Stored::Half, Stored::Float] {
            let read = stored.quantise(&image);
            assert_eq!(read.channels, 2);
            let step = match stored {
                Stored::Unorm8 => 1.0 / 255.0,
                Stored::Unorm10 => 1.0 / 1023.0,
                Stored::Unorm16 => 1.0 / 65535.0,
                Stored::Half => 1.0 / 2048.0,
                Stored::Float | Stored::Rgbd => 0.0,
            };
            assert!((read.data[1] - 0.700_1).abs() <= 0.5 * step + 1e-7, "{stored:?}");
        }
    }
}
