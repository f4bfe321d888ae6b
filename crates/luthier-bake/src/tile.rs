//! Tiles: values, and texels that spread the error of linear filtering evenly.

use luthier_lut::{
    Atlas, AtlasLayout, Axis, Encoding, ErrorStats, Image, Mapping, RowBase, TableKind, TexelFormat, Values, balance,
};
use luthier_optics::color::Color;
use serde::{Deserialize, Serialize};

/// One tile, apron included: its values, its texels, and its error as sampled.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub(crate) struct TileData {
    pub(crate) model: String,
    pub(crate) truth: Image,
    /// Texels across and down, those of a base included.
    pub(crate) size: [u32; 2],
    pub(crate) bytes: Vec<u8>,
    pub(crate) error: ErrorStats,
}

/// A single tile as an atlas of its own, to be sampled and measured.
pub(crate) fn lone_tile(kind: TableKind, axes: &[&Axis], format: TexelFormat, truth: &Image) -> Atlas {
    let layout = AtlasLayout {
        x: axes[0].clone(),
        y: axes.get(1).map(|&y| y.clone()),
        apron: apron(axes.iter().copied()),
        columns: 1,
        tiles: 1,
        base: RowBase::Zero,
    };
    let (bytes, texels) = texels(kind, format, truth);
    Atlas { kind, layout, format, tiles: Vec::new(), truth: truth.clone(), texels, bytes }
}

/// Width of the border of repeated texels around a tile with such axes. Filtering at the rim reads it, where the tile
/// repeats or where a foreign tile lies beside it.
pub(crate) fn apron<'a>(axes: impl IntoIterator<Item = &'a Axis>) -> u32 {
    u32::from(axes.into_iter().any(|axis| matches!(axis.mapping, Mapping::Periodic | Mapping::Apart)))
}

/// Description of the colour mode of a tile.
pub(crate) fn color_in_words(color: &Color) -> String {
    match color {
        Color::Spectral => "spectral, CIE 1931 under D65, linear Rec.709".to_owned(),
        Color::ThreeWavelengths([r, g, b]) => format!("RGB taken at {r}, {g} and {b} nm"),
    }
}

/// The texels that ship for the values of one tile: encoded, balanced, quantised. Returned as bytes, and as a shader
/// reads them.
///
/// Balancing keeps nonnegative values nonnegative.
pub(crate) fn texels(kind: TableKind, format: TexelFormat, truth: &Image) -> (Vec<u8>, Image) {
    let roots = Encoding::of(kind, format).to_root(truth);
    let balanced = match kind.facts().values {
        Values::Picture | Values::Apart => roots,
        Values::Signed => balance(&roots, f64::NEG_INFINITY),
        Values::Positive => balance(&roots, 0.0),
    };
    format.texels(&Encoding::of(kind, format).split(&balanced))
}
