//! Pictures of radiance made by others: OpenEXR of any compression, 16 or 32 bits, and Radiance HDR (RGBE). To read only.

use std::io::Cursor;

use ::exr::prelude::{ReadChannels, ReadLayers, read};
use ::image::codecs::hdr::HdrDecoder;
use ::image::{ImageDecoder, Limits};
use luthier_lut::Image;

use crate::TextureError;
use crate::error::Container;
use crate::exr::dwa;
use crate::limits::checked_bytes;

const EXR_MAGIC: [u8; 4] = [0x76, 0x2f, 0x31, 0x01];

/// Reads the first RGB layer of an EXR file, its largest resolution, or a Radiance HDR file: three channels, linear.
/// Values are taken as they are, in whatever primaries the file has; alpha is left out.
///
/// # Errors
/// [`TextureError::Malformed`], [`TextureError::ExrDecode`] and [`TextureError::HdrDecode`] for damaged and other files,
/// [`TextureError::Unsupported`] for EXR files of deep data, [`TextureError::Size`].
pub fn decode(file: &[u8]) -> Result<Image, TextureError> {
    if file.starts_with(&EXR_MAGIC) {
        return decode_exr(file);
    }
    if file.starts_with(b"#?") {
        return decode_hdr(file);
    }
    Err(TextureError::malformed(Container::Exr, "it is neither OpenEXR nor Radiance HDR"))
}

fn decode_exr(file: &[u8]) -> Result<Image, TextureError> {
    // All sizes are checked before anything is allocated for them.
    let meta = ::exr::meta::MetaData::read_from_buffered(Cursor::new(file), true).map_err(read_error)?;
    for header in &meta.headers {
        let side = |length: usize| u32::try_from(length).unwrap_or(u32::MAX);
        checked_bytes(side(header.layer_size.0), side(header.layer_size.1), 12)?;
    }
    dwa::check(file)?;
    let image = read()
        .no_deep_data()
        .largest_resolution_level()
        .rgb_channels(
            |size, _| Image::zeros(size.0 as u32, size.1 as u32, 3),
            |image: &mut Image, place, (r, g, b): (f32, f32, f32)| {
                image.texel_mut(place.0 as u32, place.1 as u32).copy_from_slice(&[r, g, b]);
            },
        )
        .first_valid_layer()
        .all_attributes()
        .non_parallel()
        .from_buffered(Cursor::new(file))
        .map_err(read_error)?;
    Ok(image.layer_data.channel_data.pixels)
}

fn decode_hdr(file: &[u8]) -> Result<Image, TextureError> {
    let mut decoder = HdrDecoder::new(Cursor::new(file)).map_err(TextureError::HdrDecode)?;
    decoder.set_limits(Limits::default()).map_err(TextureError::HdrDecode)?;
    let (width, height) = decoder.dimensions();
    let size = checked_bytes(width, height, 12)?;
    // Run lengths go up to 127 in two bytes for each of four planes.
    if size as u64 / 12 > 64 * file.len() as u64 {
        return Err(TextureError::malformed(Container::Hdr, "it is too short for the size that it states"));
    }
    let mut bytes = vec![0; size];
    decoder.read_image(&mut bytes).map_err(TextureError::HdrDecode)?;
    let data = bytes.as_chunks().0.iter().map(|b| f32::from_ne_bytes(*b)).collect();
    Ok(Image { width, height, channels: 3, data })
}

pub(crate) fn read_error(error: ::exr::error::Error) -> TextureError {
    match error {
        ::exr::error::Error::NotSupported(what) => TextureError::unsupported(Container::Exr, what),
        error => TextureError::ExrDecode(error),
    }
}

#[cfg(test)]
mod tests {
    use ::exr::prelude::{Encoding, Image as ExrImage, Layer, LayerAttributes, SpecificChannels, WritableImage, f16};

    use super::*;

    #[test]
    fn our_own_exr() {
        let image = Image { width: 3, height: 2, channels: 3, data: (0..18).map(|i| i as f32 * 0.5).collect() };
        let file = crate::exr::encode(&image, &crate::exr::RGB, &crate::Metadata::new()).unwrap();
        assert_eq!(decode(&file).unwrap(), image);
    }

    /// Half floats and wavelet compression, which cameras and renderers write.
    #[test]
    fn half_floats_and_piz() {
        let value = |x: usize, y: usize| (x * 7 + y * 3) as f32 * 0.25;
        let pixels = |place: ::exr::math::Vec2<usize>| {
            let v = value(place.0, place.1);
            (f16::from_f32(v), f16::from_f32(2.0 * v), f16::from_f32(4.0 * v))
        };
        let encoding = Encoding { compression: ::exr::prelude::Compression::PIZ, ..Encoding::FAST_LOSSLESS };
        let layer = Layer::new((40, 20), LayerAttributes::default(), encoding, SpecificChannels::rgb(pixels));
        let mut file = Cursor::new(Vec::new());
        ExrImage::from_layer(layer).write().non_parallel().to_buffered(&mut file).unwrap();
        let image = decode(&file.into_inner()).unwrap();
        assert_eq!((image.width, image.height, image.channels), (40, 20, 3));
        for (x, y) in [(0, 0), (39, 0), (5, 19)] {
            let v = value(x, y);
            assert_eq!(image.texel(x as u32, y as u32), [v, 2.0 * v, 4.0 * v], "{x} {y}");
        }
    }

    /// RGBE by hand: mantissa over 256 times 2^(exponent - 128).
    #[test]
    fn radiance_pixels() {
        let mut file = b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 2\n".to_vec();
        file.extend([128, 64, 32, 129, 128, 128, 128, 136]);
        let image = decode(&file).unwrap();
        assert_eq!((image.width, image.height), (2, 1));
        let expected = [1.0, 0.5, 0.25, 128.0, 128.0, 128.0];
        // Some readers add half a step of the mantissa.
        for (found, expected) in image.data.iter().zip(expected) {
            assert!((found / expected - 1.0).abs() < 0.5 / 32.0, "{:?}", image.data);
        }
    }

    #[test]
    fn other_files_are_refused() {
        for file in [
            &b""[..],
            b"GIF89a",
            b"#?RADIANCE\n\n",
            &EXR_MAGIC,
            b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 9999 +X 9999\n\0\0\0\0",
        ] {
            assert!(decode(file).is_err(), "{file:?}");
        }
    }
}
