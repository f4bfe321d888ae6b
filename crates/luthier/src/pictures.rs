//! Pictures that materials name: read, and made into the maps that ship.

use luthier_lut::{Image, Picture, PictureSamples, srgb};
use luthier_material::{Channel, LayerExtras, Material, PictureRef, TexelRanges, TexelUse};
use luthier_texture::picture::{Decoded, decode};
use luthier_texture::{Container, png};

use luthier_export::input;

use crate::paths;

/// A picture that was read: the texels that a material asks for, and its file.
pub(crate) struct Read {
    /// Texels as they ship.
    pub(crate) picture: Picture,
    /// The file.
    pub(crate) bytes: Vec<u8>,
    /// Content of the file.
    pub(crate) decoded: Decoded,
}

/// Reads the texels that ship of a picture that a material names, relative to the material's file.
///
/// ```
/// use luthier_lut::Image;
/// use luthier_material::{PictureRef, TexelUse};
/// use luthier_texture::png;
///
/// let folder = tempfile::tempdir()?;
/// let grain = Image { width: 2, height: 1, channels: 1, data: vec![0.0, 1.0] };
/// std::fs::write(folder.path().join("grain.png"), png::encode_gray(&grain)?)?;
///
/// let oak = folder.path().join("oak.toml").display().to_string();
/// let picture = luthier::read_picture(&oak, &PictureRef::plain("grain.png"), TexelUse::Number)?;
/// assert_eq!((picture.size(), picture.channels), ([2, 1], 1));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// Why it cannot be used, in words.
pub fn read_picture(material: &str, picture: &PictureRef, texels: TexelUse) -> Result<Picture, String> {
    read(material, picture, texels).map(|read| read.picture)
}

/// Reads a picture of one number that a material names, relative to the material's file.
///
/// ```
/// use luthier_lut::Image;
/// use luthier_material::PictureRef;
/// use luthier_texture::png;
///
/// let folder = tempfile::tempdir()?;
/// let grain = Image { width: 2, height: 1, channels: 1, data: vec![0.0, 1.0] };
/// std::fs::write(folder.path().join("grain.png"), png::encode_gray(&grain)?)?;
///
/// let oak = folder.path().join("oak.toml").display().to_string();
/// let image = luthier::read_image(&oak, &PictureRef::plain("grain.png"))?;
/// assert_eq!(image.data, [0.0, 1.0]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// Why it cannot be used, in words.
pub fn read_image(material: &str, picture: &PictureRef) -> Result<Image, String> {
    Ok(read_picture(material, picture, TexelUse::Number)?.channel(0))
}

pub(crate) fn read(material: &str, picture: &PictureRef, texels: TexelUse) -> Result<Read, String> {
    let bytes = input::image(&paths::beside(material, &picture.path)).map_err(|source| source.to_string())?;
    let decoded = decode(&bytes).map_err(|source| source.to_string())?;
    let made = shipped(&decoded.picture, picture, texels)?;
    Ok(Read { picture: made, bytes, decoded })
}

/// The file of a map that ships. A PNG whose texels do not change ships as it is.
pub(crate) fn file(read: Read, picture: &PictureRef) -> Result<(Picture, Vec<u8>), String> {
    if picture.keeps_texels() && read.decoded.container == Container::Png {
        return Ok((read.picture, read.bytes));
    }
    let bytes = png::encode_picture(&read.picture).map_err(|source| source.to_string())?;
    Ok((read.picture, bytes))
}

/// Finds the smallest and the largest texel of the maps that make rows of lobes span slope parameters. A picture that cannot be read keeps the whole range: its
/// error is told where it ships.
pub(crate) fn measure_texels(material: &mut Material) {
    if material.family().is_none() {
        return;
    }
    let (source, [low, high]) = (material.source.clone(), TexelRanges::default().alpha);
    for LayerExtras { maps, texels, .. } in &mut material.layers {
        for (picture, range) in [
            (&maps.alpha, &mut texels.alpha),
            (&maps.alpha_x, &mut texels.alpha_x),
            (&maps.alpha_y, &mut texels.alpha_y),
            (&maps.roughness, &mut texels.roughness),
        ] {
            let Some(Ok(image)) = picture.as_ref().map(|picture| read_image(&source, picture)) else { continue };
            let values = image.data.iter().map(|value| f64::from(*value).clamp(low, high));
            *range = values.fold([high, low], |[least, most], value| [least.min(value), most.max(value)]);
        }
    }
}

/// The texels of a picture as a material asks for them.
fn shipped(stored: &Picture, asked: &PictureRef, texels: TexelUse) -> Result<Picture, String> {
    let mut picture = match asked.channel {
        Some(channel) => one_channel(stored, channel)?,
        None => stored.clone(),
    };
    picture.is_srgb = asked.srgb == Some(true) && asked.channel != Some(Channel::A);
    if asked.scale == 1.0 {
        return Ok(picture);
    }
    Ok(replaced(&picture, |texel| scaled(texel, texels, asked.scale as f32)))
}

/// A texel times a factor; of a normal, its lean.
fn scaled(texel: [f32; 4], texels: TexelUse, scale: f32) -> [f32; 3] {
    match texels {
        TexelUse::Normal => {
            let [x, y, z] = [0, 1, 2].map(|c| 2.0 * texel[c] - 1.0);
            let (x, y) = (scale * x, scale * y);
            let length = (x * x + y * y + z * z).sqrt().max(f32::MIN_POSITIVE);
            [x, y, z].map(|v| 0.5 + 0.5 * v / length)
        }
        _ => [0, 1, 2].map(|c| scale * texel[c]),
    }
}

/// One channel of a picture, as grey. In a grey picture, red, green and blue are equal.
fn one_channel(picture: &Picture, channel: Channel) -> Result<Picture, String> {
    let place = match (channel, picture.channels) {
        (Channel::A, 1 | 3) => return Err("its channel `a` is asked for, and it has no alpha".to_owned()),
        (Channel::A, count) => count as usize - 1,
        (_, 1 | 2) => 0,
        _ => channel.index(),
    };
    let samples = match &picture.samples {
        PictureSamples::Bits8(values) => PictureSamples::Bits8(every(values, picture.channels, place)),
        PictureSamples::Bits16(values) => PictureSamples::Bits16(every(values, picture.channels, place)),
        PictureSamples::Float(values) => PictureSamples::Float(every(values, picture.channels, place)),
    };
    Ok(Picture { channels: 1, samples, ..*picture })
}

fn every<T: Copy>(values: &[T], channels: u32, place: usize) -> Vec<T> {
    values.iter().skip(place).step_by(channels as usize).copied().collect()
}

/// A picture with other texels, but with the bit depth and curve of `picture`. It is grey if `picture` is grey without alpha, else RGB.
fn replaced(picture: &Picture, texel: impl Fn([f32; 4]) -> [f32; 3]) -> Picture {
    let channels = if picture.channels == 1 { 1 } else { 3 };
    let values = picture.texels().flat_map(|t| texel(t).into_iter().take(channels));
    let codes = values.map(|v| if picture.is_srgb { srgb::code(v) } else { f64::from(v).clamp(0.0, 1.0) });
    let samples = match picture.samples {
        PictureSamples::Bits8(_) => PictureSamples::Bits8(codes.map(|code| (255.0 * code).round() as u8).collect()),
        _ => PictureSamples::Bits16(codes.map(|code| (65535.0 * code).round() as u16).collect()),
    };
    Picture { channels: channels as u32, samples, ..*picture }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rgb(values: Vec<u8>) -> Picture {
        let width = values.len() as u32 / 3;
        Picture { width, height: 1, channels: 3, is_srgb: false, samples: PictureSamples::Bits8(values) }
    }

    fn asked() -> PictureRef {
        PictureRef::plain("p.png")
    }

    #[test]
    fn a_channel_is_taken_alone() {
        let packed = rgb(vec![10, 20, 30, 40, 50, 60]);
        let green = shipped(&packed, &PictureRef { channel: Some(Channel::G), ..asked() }, TexelUse::Number).unwrap();
        assert_eq!((green.channels, green.samples), (1, PictureSamples::Bits8(vec![20, 50])));
        let alpha = PictureRef { channel: Some(Channel::A), ..asked() };
        assert!(shipped(&packed, &alpha, TexelUse::Number).unwrap_err().contains("no alpha"));
        let grey = Picture { channels: 2, width: 3, ..packed };
        assert_eq!(shipped(&grey, &alpha, TexelUse::Number).unwrap().samples, PictureSamples::Bits8(vec![20, 40, 60]));
    }

    /// Half of the light of a code: by the sRGB curve 188 is .5029, half of it is code 137.
    #[test]
    fn colours_are_scaled_as_light() {
        let scaled = PictureRef { srgb: Some(true), scale: 0.5, ..asked() };
        let half = shipped(&rgb(vec![188, 0, 255]), &scaled, TexelUse::Color).unwrap();
        assert!(half.is_srgb);
        assert_eq!(half.samples, PictureSamples::Bits8(vec![137, 0, 188]));
        let linear = PictureRef { scale: 0.5, ..asked() };
        let half = shipped(&rgb(vec![188, 0, 255]), &linear, TexelUse::Color).unwrap();
        assert_eq!(half.samples, PictureSamples::Bits8(vec![94, 0, 128]));
    }

    /// A slope of 3/4 becomes one of 3/2: (3, 0, 2) / sqrt 13.
    #[test]
    fn normals_are_scaled_in_their_slope() {
        let leaning = rgb(vec![204, 128, 230]);
        let scaled = PictureRef { scale: 2.0, ..asked() };
        let PictureSamples::Bits8(codes) = shipped(&leaning, &scaled, TexelUse::Normal).unwrap().samples else {
            panic!("bits are kept")
        };
        let expected = [3.0 / 13.0f64.sqrt(), 0.0, 2.0 / 13.0f64.sqrt()].map(|c| (127.5 + 127.5 * c).round() as i32);
        for (code, expected) in codes.iter().zip(expected) {
            assert!((i32::from(*code) - expected).abs() <= 1, "{codes:?}");
        }
    }
}
