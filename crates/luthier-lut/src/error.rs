//! Faults of texels.

use thiserror::Error;

/// Why texels are not usable.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum LutError {
    /// Texel bytes that do not fit the layout.
    #[error("{found} bytes of texels where {expected} are needed")]
    TexelBytes {
        /// Given.
        found: usize,
        /// Width x height x bytes per texel.
        expected: usize,
    },
    /// Blocks that the image fills in part, or blocks of modes that this crate does not write.
    #[error("blocks of texels that were not baked here")]
    Blocks,
    /// Texels with steps that do not lead to the next texel.
    #[error("steps that do not lead from texel to texel")]
    Steps,
}
