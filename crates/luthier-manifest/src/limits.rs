//! How much one bake holds: what devices take, and what shaders can count.

use serde::{Deserialize, Serialize};

/// Longest side of textures while their texels fit: the least that GLSL ES 3.00 and every device of the last decade take.
pub const SIDE: u32 = 2048;

/// Longest side of any texture of a bake: what core WebGPU takes.
pub const SIDE_MAX: u32 = 8192;

/// Most `vec4` words of a material buffer. Shaders count words in the 23 low bits of a float, and core WebGPU binds 128 MiB of storage: it
/// is one number.
pub const BUFFER_WORDS_MAX: usize = 1 << 23;

const _: () = assert!(BUFFER_WORDS_MAX * size_of::<[f32; 4]>() == 128 << 20);

/// Texels of the material buffer as a texture.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct MaterialTexture {
    /// Texels across: those of the buffer if they are at most [`SIDE`], else [`SIDE`].
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
