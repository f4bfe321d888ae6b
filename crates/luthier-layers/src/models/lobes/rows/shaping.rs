//! Sources of the widths of lobes.

use super::{Lobe, OneWidth, Short};

/// Source of the widths of the lobes of rows.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Shaping {
    /// The rows alone.
    #[default]
    Rows,
    /// Rows with one width, and the view.
    OneWidth(OneWidth),
    /// The view alone.
    Short(Short),
}

impl Shaping {
    /// The lobe that a stored one is at a view with this sine.
    pub(in crate::models::lobes) fn shaped(self, stored: Lobe, sin_theta: f64) -> Lobe {
        match self {
            Self::Rows => stored,
            Self::OneWidth(one_width) => one_width.shaped(stored, sin_theta),
            Self::Short(short) => short.shaped(stored, sin_theta),
        }
    }
}
