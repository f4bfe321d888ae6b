//! Textures for devices: a format, a size, bytes.

use luthier_lut::{Atlas, Image, TexelFormat};

use crate::TextureError;
use crate::size::checked_bytes;

/// A texture for a device.
///
/// ```
/// use luthier_lut::TexelFormat;
/// use luthier_texture::Texture;
///
/// let texture = Texture { format: TexelFormat::R16Float, width: 1, height: 1, bytes: vec![0x00, 0x3c] };
/// assert_eq!(texture.image()?.data, [1.0]);
/// # Ok::<(), luthier_texture::TextureError>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Texture {
    /// Format of the texels.
    pub format: TexelFormat,
    /// Texels across.
    pub width: u32,
    /// Texels down.
    pub height: u32,
    /// The texels, row by row from the top, tightly packed, little-endian.
    pub bytes: Vec<u8>,
}

impl Texture {
    /// The texels of an atlas in its format.
    pub fn from_atlas(atlas: &Atlas) -> Self {
        let Image { width, height, .. } = atlas.texels;
        Self { format: atlas.format, width, height, bytes: atlas.bytes.clone() }
    }

    /// The values that a shader reads.
    ///
    /// # Errors
    /// [`TextureError::Size`] beyond the limits, [`TextureError::Lut`] if the bytes do not fit width, height and
    /// format.
    pub fn image(&self) -> Result<Image, TextureError> {
        checked_bytes(self.width, self.height, self.format.texel_bytes())?;
        Ok(self.format.decode(self.width, self.height, &self.bytes)?)
    }
}

#[cfg(test)]
mod tests {
    use luthier_lut::{AtlasLayout, Axis, Mapping, TableKind};

    use super::*;

    #[test]
    fn an_atlas_of_quantised_texels_survives() {
        let axis = Axis {
            quantity: "cos_theta".into(),
            unit: String::new(),
            min: 0.0,
            max: 1.0,
            size: 3,
            mapping: Mapping::Linear,
        };
        let layout = AtlasLayout { x: axis, y: None, apron: 0, columns: 1, tiles: 1, base: luthier_lut::RowBase::Zero };
        // Quarters and halves are exact in f16; 0 and 1 are the only exact ones in unorm.
        let values = vec![0.25, 0.5, 2.0, 1.0, 0.0, 1.0, 0.75, 1.0, 1.5, 3.0, 4.0, 1.0];
        let texels = Image { width: 3, height: 1, channels: 4, data: values };
        for format in [TexelFormat::Rgba16Float, TexelFormat::Rgba32Float] {
            let atlas = Atlas {
                kind: TableKind::Fresnel,
                layout: layout.clone(),
                format,
                tiles: Vec::new(),
                truth: texels.clone(),
                texels: texels.clone(),
                bytes: format.encode(&texels),
            };
            let texture = Texture::from_atlas(&atlas);
            assert_eq!((texture.width, texture.height), (3, 1));
            assert_eq!(texture.image().unwrap(), texels);
        }
    }

    #[test]
    fn bytes_that_do_not_fit_are_an_error() {
        let texture = Texture { format: TexelFormat::R16Float, width: 2, height: 2, bytes: vec![0; 7] };
        assert!(matches!(texture.image(), Err(TextureError::Lut(_))));
        let texture = Texture { width: u32::MAX, height: u32::MAX, ..texture };
        assert!(matches!(texture.image(), Err(TextureError::Size { .. })));
    }
}
