//! Encodings of values in texels: plain, or a sixteenth root in two halves.

use crate::{Image, TableKind, TexelFormat};

/// How values become texels, beyond the rounding of the texel format.
///
/// ```
/// use luthier_lut::{Encoding, Image, TableKind, TexelFormat};
///
/// let encoding = Encoding::of(TableKind::Distribution, TexelFormat::Rg16Float);
/// let values = Image { width: 1, height: 1, channels: 1, data: vec![1e-12] };
/// let texels = encoding.split(&encoding.to_root(&values));
/// // Half floats end at 6e-8; their sixteenth roots keep the value.
/// let [value, ..] = encoding.decode([texels.data[0].into(), texels.data[1].into(), 0.0, 1.0]);
/// assert!((value / 1e-12 - 1.0).abs() < 1e-4);
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Encoding {
    /// Values as they are.
    Plain,
    /// One value as its sixteenth root, split in two halves: `root = r + g / 1024`.
    ///
    /// The root of a lobe varies slowly over its tail, where the lobe itself falls by orders of magnitude between texels and
    /// below what a half float can hold; two half floats together are as precise as 22 bits, and filter linearly.
    SplitSixteenthRoot,
}

/// Factor on the second half.
const SPLIT: f64 = 1024.0;

impl Encoding {
    /// The encoding of a table: slope distributions in two channels are split roots, everything else is plain.
    pub fn of(kind: TableKind, format: TexelFormat) -> Self {
        match (kind, format) {
            (TableKind::Distribution, TexelFormat::Rg16Float) => Self::SplitSixteenthRoot,
            _ => Self::Plain,
        }
    }

    /// Values in the scale in which texels interpolate, one number each.
    pub fn to_root(self, values: &Image) -> Image {
        match self {
            Self::Plain => values.clone(),
            Self::SplitSixteenthRoot => {
                let roots = values.data.iter().map(|value| {
                    let fourth_root = libm::sqrt(libm::sqrt(f64::from(*value).max(0.0)));
                    libm::sqrt(libm::sqrt(fourth_root)) as f32
                });
                Image { data: roots.collect(), ..*values }
            }
        }
    }

    /// Texels, still in f32, from the values of [`Self::to_root`].
    pub fn split(self, roots: &Image) -> Image {
        match self {
            Self::Plain => roots.clone(),
            Self::SplitSixteenthRoot => {
                let halves = roots.texels().flat_map(|texel| {
                    let root = f64::from(texel[0]);
                    let coarse = half::f16::from_f64(root);
                    [coarse.to_f32(), ((root - coarse.to_f64()) * SPLIT) as f32]
                });
                Image { channels: 2, data: halves.collect(), ..*roots }
            }
        }
    }

    /// The values of a filtered texel.
    pub fn decode(self, texel: [f64; 4]) -> [f64; 4] {
        match self {
            Self::Plain => texel,
            Self::SplitSixteenthRoot => {
                let root = texel[0] + texel[1] / SPLIT;
                let square = root * root;
                let fourth = square * square;
                let eighth = fourth * fourth;
                [eighth * eighth, 0.0, 0.0, 1.0]
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn split_roots_hold_tiny_and_large_values_to_six_digits() {
        let encoding = Encoding::of(TableKind::Distribution, TexelFormat::Rg16Float);
        for value in [0.0_f32, 1e-20, 1e-12, 3.7e-6, 0.2, 1.0, 1.4715] {
            let image = Image { width: 1, height: 1, channels: 1, data: vec![value] };
            let shipped = TexelFormat::Rg16Float.quantise(&encoding.split(&encoding.to_root(&image)));
            let texel = shipped.texel(0, 0);
            let back = encoding.decode([f64::from(texel[0]), f64::from(texel[1]), 0.0, 1.0])[0];
            assert!((back - f64::from(value)).abs() <= 8e-6 * f64::from(value), "{value}: {back}");
        }
    }

    #[test]
    fn other_tables_are_plain() {
        for kind in TableKind::ALL {
            for format in TexelFormat::ALL {
                let split = kind == TableKind::Distribution && format == TexelFormat::Rg16Float;
                assert_eq!(Encoding::of(kind, format) == Encoding::Plain, !split);
            }
        }
    }
}
