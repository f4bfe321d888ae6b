//! Limits on sizes.

/// Longest side of an image, in texels: the limit of current devices.
pub const MAX_SIDE: u32 = 16_384;

/// Most bytes of the texels of one image, uncompressed: 512 MiB, which is 8192 x 4096 of rgba32float.
pub const MAX_BYTES: u64 = 1 << 29;

/// Bytes of texels that any file may have, however short it is.
const PLAUSIBLE: u64 = 64 << 20;

/// Further bytes of texels per byte of a file. Deflate makes 1032 of one, and decoded halves are twice as long; more is
/// a lie of the header.
const EXPANSION: u64 = 4096;

/// Whether a file of this length may decode to so many bytes of texels.
pub(crate) fn is_plausible(file: &[u8], bytes: u64) -> bool {
    bytes <= PLAUSIBLE + EXPANSION * file.len() as u64
}
