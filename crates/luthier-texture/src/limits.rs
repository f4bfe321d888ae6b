//! Limits on sizes.

/// Longest side of an image, in texels: what current devices take at most.
pub const MAX_SIDE: u32 = 16_384;

/// Most bytes that the texels of one image may take as they are stored before compression: 512 MiB, 8192 x 4096 of rgba32float.
pub const MAX_BYTES: u64 = 1 << 29;

/// Bytes that any file may ask for.
const PLAUSIBLE: u64 = 64 << 20;

/// Bytes that a byte of a file may ask for beyond these: deflate makes 1032 of one, and halves become twice as long.
const EXPANSION: u64 = 4096;

/// Whether a file may be as long as it is and have so many bytes of decoded texels.
pub(crate) fn is_plausible(file: &[u8], bytes: u64) -> bool {
    bytes <= PLAUSIBLE + EXPANSION * file.len() as u64
}
