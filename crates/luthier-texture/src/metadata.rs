//! Metadata of EXR, KTX2 and PNG files: rules for keys and values.

use crate::TextureError;

/// Statements of a file about itself: keys and values, sorted by key in the file. Keys are distinct, and 1 to 64 ASCII
/// letters, digits, `.`, `_` and `-`. Values hold no NUL and are at most 1 MiB.
///
/// ```
/// use luthier_lut::Image;
/// use luthier_texture::exr;
///
/// let metadata = vec![("model".to_owned(), "Fresnel".to_owned())];
/// let image = Image { width: 1, height: 1, channels: 1, data: vec![0.5] };
/// assert_eq!(exr::decode(&exr::encode(&image, &["Y"], &metadata)?)?, (image, metadata));
/// # Ok::<(), luthier_texture::TextureError>(())
/// ```
pub type Metadata = Vec<(String, String)>;

const MAX_KEY_BYTES: usize = 64;
const MAX_VALUE_BYTES: usize = 1 << 20;

/// Checks the rules of [`Metadata`].
pub(crate) fn check(metadata: &[(String, String)]) -> Result<(), TextureError> {
    for (i, (key, value)) in metadata.iter().enumerate() {
        let is_plain = key.bytes().all(|b| b.is_ascii_alphanumeric() || b".-_".contains(&b));
        let reason = if key.is_empty() || key.len() > MAX_KEY_BYTES || !is_plain {
            "a key is 1 to 64 ASCII letters, digits, `.`, `_` or `-`"
        } else if metadata[..i].iter().any(|(earlier, _)| earlier == key) {
            "the key appears twice"
        } else if value.contains('\0') {
            "a value cannot hold NUL"
        } else if value.len() > MAX_VALUE_BYTES {
            "a value is at most 1 MiB"
        } else {
            continue;
        };
        return Err(TextureError::Metadata { key: key.clone(), reason });
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn entries_that_the_container_cannot_hold_are_refused() {
        let entry = |key: &str, value: &str| (key.to_owned(), value.to_owned());
        assert!(check(&[entry("model", "Smith, α = 0.5"), entry("input-hash", "")]).is_ok());
        for key in ["", "two words", "größe", &"x".repeat(65)] {
            assert!(check(&[entry(key, "v")]).is_err(), "{key}");
        }
        assert!(check(&[entry("a", "1"), entry("a", "2")]).is_err());
        assert!(check(&[entry("a", "1\0")]).is_err());
        assert!(check(&[entry("a", &"x".repeat(MAX_VALUE_BYTES + 1))]).is_err());
    }
}
