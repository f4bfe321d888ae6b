//! Sizes of images, checked before memory is allocated.

use luthier_lut::Image;

use crate::error::TextureError;
use crate::limits::{MAX_BYTES, MAX_SIDE};

/// The bytes of an image with `texel_bytes` to a stored texel.
///
/// # Errors
/// [`TextureError::Size`] beyond the limits, or when a side is 0.
pub(crate) fn checked_bytes(width: u32, height: u32, texel_bytes: u32) -> Result<usize, TextureError> {
    let are_sides = [width, height].iter().all(|side| (1..=MAX_SIDE).contains(side));
    // Sides within the limit keep the product within 64 bits.
    let bytes = are_sides.then(|| u64::from(width) * u64::from(height) * u64::from(texel_bytes));
    let bytes = bytes.filter(|bytes| *bytes <= MAX_BYTES).ok_or(TextureError::Size { width, height })?;
    Ok(bytes as usize)
}

/// Checks that the fields of an image fit together, and are within the limits.
pub(crate) fn check_image(image: &Image) -> Result<(), TextureError> {
    if !(1..=4).contains(&image.channels) {
        return Err(TextureError::Channels(image.channels));
    }
    let expected = checked_bytes(image.width, image.height, 4 * image.channels)? / 4;
    if image.data.len() == expected { Ok(()) } else { Err(TextureError::Length { found: image.data.len(), expected }) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn limits_hold_without_overflow() {
        assert_eq!(checked_bytes(8192, 4096, 16).unwrap(), 1 << 29);
        for (width, height) in [(0, 1), (1, 0), (MAX_SIDE + 1, 1), (u32::MAX, u32::MAX), (8192, 4097)] {
            assert!(matches!(checked_bytes(width, height, 16), Err(TextureError::Size { .. })), "{width}x{height}");
        }
    }

    #[test]
    fn inconsistent_images_are_refused() {
        let image = |channels, values| Image { width: 2, height: 2, channels, data: vec![0.0; values] };
        assert!(check_image(&image(3, 12)).is_ok());
        assert!(matches!(check_image(&image(0, 0)), Err(TextureError::Channels(0))));
        assert!(matches!(check_image(&image(5, 20)), Err(TextureError::Channels(5))));
        assert!(matches!(check_image(&image(3, 11)), Err(TextureError::Length { found: 11, expected: 12 })));
    }
}
