//! Layouts of rows: how shaders read them.

use crate::TexelFormat;

crate::named! {
    /// Layout of rows of lobes. It decides the format of the table, its size, and the instructions of a read.
    ///
    /// ```
    /// use luthier_lut::{RowLayout, TexelFormat};
    ///
    /// let layout: RowLayout = "steps".parse().unwrap();
    /// assert_eq!(layout.format(), TexelFormat::Rgba16FloatSteps);
    /// assert_eq!(layout.format().texel_bytes(), 2 * RowLayout::Filtered.format().texel_bytes());
    /// ```
    pub enum RowLayout("layout of rows") {
        /// A texture that a sampler filters: one read of four values, with weights of 8 bits on most hardware. Between two rows it costs no more.
        Filtered = "filtered",
        /// A storage buffer of values with their steps to the next ones: one read of 16 bytes, two between two rows, with exact weights. Twice the bytes.
        Steps = "steps",
    }
}

impl RowLayout {
    /// Format of the texels.
    pub fn format(self) -> TexelFormat {
        match self {
            Self::Filtered => TexelFormat::Rgba16Float,
            Self::Steps => TexelFormat::Rgba16FloatSteps,
        }
    }
}
