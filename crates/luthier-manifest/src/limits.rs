//! How much one bake holds: what devices take, and what shaders can count.

use serde::{Deserialize, Serialize};

/// Longest side of textures as long as their texels fit: GLSL ES 3.00 and every device of the last decade take it.
pub const SIDE: u32 = 2048;

/// Longest side of any texture of a bake: what core WebGPU takes.
pub const SIDE_MAX: u32 = 8192;

/// Most `vec4` words of a material buffer. Shaders count words in the 23 low bits of a float, and core WebGPU binds 128 MiB of storage: both
/// limits are this number.
pub const BUFFER_WORDS_MAX: usize = 1 << 23;

const _: () = assert!(BUFFER_WORDS_MAX * size_of::<[f32; 4]>() == 128 << 20);

/// Texels of the material buffer as a texture.
///
/// ```
/// use luthier_manifest::MaterialTexture;
///
/// assert_eq!(MaterialTexture::of(100), MaterialTexture { width: 100, height: 1 });
/// // Longer buffers fill whole rows.
/// let rows = MaterialTexture::of(3000);
/// assert_eq!((rows.width, rows.height, rows.words()), (2048, 2, 4096));
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct MaterialTexture {
    /// Texels across: the words of the buffer, but at most [`SIDE`].
    pub width: u32,
    /// Rows.
    pub height: u32,
}

impl MaterialTexture {
    /// The texture of so many words, one a texel, row by row.
    pub fn of(words: usize) -> Self {
        let height = words.div_ceil(SIDE as usize).max(1) as u32;
        let width = if height == 1 { words as u32 } else { SIDE };
        Self { width, height }
    }

    /// Words of whole rows.
    pub fn words(self) -> usize {
        self.width as usize * self.height as usize
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_fill_one_row_and_then_more() {
        for (words, width, height) in [
            (1, 1, 1),
            (22, 22, 1),
            (2047, 2047, 1),
            (2048, 2048, 1),
            (2049, 2048, 2),
            (4096, 2048, 2),
            (4097, 2048, 3),
        ] {
            let texture = MaterialTexture::of(words);
            assert_eq!(texture, MaterialTexture { width, height }, "{words}");
            assert!(texture.words() >= words && texture.words() - words < SIDE as usize);
        }
        let largest = MaterialTexture::of(BUFFER_WORDS_MAX);
        assert!(largest.height <= SIDE_MAX && largest.words() == BUFFER_WORDS_MAX);
    }
}
