//! Pictures as read, with notes.

use luthier_lut::Image;

/// A picture of radiance.
///
/// ```
/// let header = b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 1\n";
/// let file = [header.as_slice(), &[128, 64, 32, 129]].concat();
/// let picture = luthier_texture::radiance::decode(&file)?;
/// assert_eq!(picture.image.data, [1.0, 0.5, 0.25]);
/// # Ok::<(), luthier_texture::TextureError>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Picture {
    /// Three channels, linear Rec.709.
    pub image: Image,
    /// A sentence for each part of the file that was converted or left out.
    pub notes: Vec<String>,
}
