//! Atlases: equal tiles of one kind of table in one texture.

use serde::{Deserialize, Serialize};

use crate::{
    Axis, Encoding, ErrorStats, Image, Mapping, RowBase, SchlickBase, TableKind, TexelFormat, WeightBits, bilinear,
    sampler::stepped,
};

/// Where every texel of an atlas lies: equal tiles in a grid, filled row by row.
///
/// Rows whose axis is [`Mapping::Apart`] are side by side, each with its own apron, and the height of the texture is a power of two. Samplers
/// round positions and mix in a small part of the row beside, which shows where numbers of two rows differ by a factor of thousands. For the
/// same reason sides of many tiles are powers of two above 4096 texels: at other sizes graphics hardware takes 1/256 of the row beside for up
/// to half of the rows.
///
/// ```
/// use luthier_lut::{AtlasLayout, Axis, Mapping, RowBase};
///
/// let (quantity, unit) = ("cos_theta".to_owned(), String::new());
/// let x = Axis { quantity, unit, min: 0.0, max: 1.0, size: 64, mapping: Mapping::Linear };
/// let rows = AtlasLayout { x, y: None, apron: 0, columns: 1, tiles: 3, base: RowBase::Zero };
/// assert_eq!((rows.size(), rows.origin(2)), ([64, 3], [0, 2]));
/// // The last node of the second row: the centre of the last texel.
/// assert_eq!(rows.position(1, [1.0, 0.0]), [63.5, 1.5]);
/// ```
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct AtlasLayout {
    /// Axis across a tile.
    pub x: Axis,
    /// Axis down a tile; absent when a tile is a single row.
    pub y: Option<Axis>,
    /// Texels repeated around a tile: 1 for periodic axes and on both sides of rows that are apart, else 0.
    pub apron: u32,
    /// Tiles side by side.
    pub columns: u32,
    /// Number of tiles, at least 1.
    pub tiles: u32,
    /// Base that a look-up adds; absent from files when it is zero.
    #[serde(default, skip_serializing_if = "RowBase::is_zero")]
    pub base: RowBase,
}

/// Longest side of many tiles that need not be a power of two. No sampler that was measured reads the tile beside one up to here (NVIDIA
/// Hopper: none of 4095 rows, 62 of 417 of 5001, none of 8192).
const EXACT_SIDE: u32 = 4096;

/// Texels of a side with so many tiles on it; `None` on overflow.
fn side(tiles: u32, texels: u32, is_apart: bool) -> Option<u32> {
    let whole = tiles.checked_mul(texels)?;
    match tiles > 1 && (is_apart || whole > EXACT_SIDE) {
        true => whole.checked_next_power_of_two(),
        false => Some(whole),
    }
}

impl AtlasLayout {
    /// The y axis, if its nodes are rows side by side ([`Mapping::Apart`]).
    pub fn abreast(&self) -> Option<&Axis> {
        self.y.as_ref().filter(|y| y.mapping == Mapping::Apart)
    }

    /// Texels of one tile, apron and coefficients included.
    pub fn tile_size(&self) -> [u32; 2] {
        let width = self.row_size();
        match (&self.y, self.abreast()) {
            (_, Some(rows)) => [width * rows.size, 1],
            (Some(y), None) => [width, y.size + 2 * self.apron],
            (None, None) => [width, 1],
        }
    }

    /// Texels of one row of a tile, apron and coefficients included.
    pub fn row_size(&self) -> u32 {
        self.x.size + 2 * self.apron + self.base.header_texels()
    }

    /// Texels of the whole texture.
    pub fn size(&self) -> [u32; 2] {
        let [w, h] = self.tile_size();
        let rows = self.tiles.div_ceil(self.columns);
        // A side that overflows is longer than any limit.
        let [across, down] = [side(self.columns, w, false), side(rows, h, self.abreast().is_some())];
        [across.unwrap_or(u32::MAX), down.unwrap_or(u32::MAX)]
    }

    /// [`AtlasLayout::size`] of a layout from a file: `None` if the size overflows, if there are no tiles, and if an axis has no interval.
    pub fn checked_size(&self) -> Option<[u32; 2]> {
        let apron = self.apron.checked_mul(2)?;
        let sizes = [Some(self.x.size), self.y.as_ref().map(|y| y.size)];
        if self.columns == 0 || self.tiles == 0 || sizes.iter().flatten().any(|&size| size < 2) {
            return None;
        }
        let header = self.base.header_texels();
        let row = self.x.size.checked_add(apron)?.checked_add(header)?;
        let [width, height] = match (&self.y, self.abreast()) {
            (_, Some(rows)) => [row.checked_mul(rows.size)?, 1],
            (Some(y), None) => [row, y.size.checked_add(apron)?],
            (None, None) => [row, 1],
        };
        let rows = self.tiles.div_ceil(self.columns);
        Some([side(self.columns, width, false)?, side(rows, height, self.abreast().is_some())?])
    }

    /// First texel of a tile, apron included.
    pub fn origin(&self, tile: u32) -> [u32; 2] {
        let [w, h] = self.tile_size();
        [tile % self.columns * w, tile / self.columns * h]
    }

    /// First texel of the coefficients of a tile, behind its nodes.
    pub fn header(&self, tile: u32) -> [u32; 2] {
        let [x, y] = self.origin(tile);
        [x + self.x.size + 2 * self.apron, y]
    }

    /// The position in texels (centres at `i + 0.5`) that a look-up of these axis values reads; `values[1]` is
    /// ignored by a single row. A read at this position never touches another tile: the outermost nodes are texel
    /// centres.
    pub fn position(&self, tile: u32, values: [f64; 2]) -> [f64; 2] {
        let [ox, oy] = self.origin(tile).map(f64::from);
        let apron = f64::from(self.apron);
        let x = ox + apron + self.x.index(values[0]) + 0.5;
        if let Some(rows) = self.abreast() {
            return [x + rows.index(values[1]) * f64::from(self.row_size()), oy + 0.5];
        }
        let y = self.y.as_ref().map_or(oy + 0.5, |axis| oy + apron + axis.index(values[1]) + 0.5);
        [x, y]
    }
}

/// One tile: the function that it holds, and its error.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Tile {
    /// Readable name: `red-lacquer/0`, `beckmann`.
    pub name: String,
    /// Function that was tabulated, in words that name the model.
    pub model: String,
    /// SHA-256 of the inputs of the job that made it, hex.
    pub input_hash: String,
    /// Error of a sampled read against the function, as measured by the baker.
    pub error: ErrorStats,
    /// Largest error as sampled that the bake aimed at; absent if a budget, or a size or format in a material file, decided instead.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub aim: Option<f64>,
    /// Largest magnitude of the function at the nodes, in any channel; absent from earlier bakes, and where the channels are not one quantity (lobes,
    /// thickness).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub largest: Option<f64>,
}

/// Part of the largest value of a tile beyond which its error is told, whatever the bake aimed at: the function is hardly recognised then.
pub const COARSE: f64 = 0.1;

impl Tile {
    /// The error as sampled and the aim, if the error is larger.
    pub fn miss(&self) -> Option<(f64, f64)> {
        let difference = (self.error.worst.expected - self.error.worst.sampled).abs();
        self.aim.filter(|aim| difference > *aim).map(|aim| (difference, aim))
    }

    /// The error and the largest value of the tile, if the error is more than [`COARSE`] of that value.
    pub fn coarse(&self) -> Option<(f64, f64)> {
        let error = self.error.max_abs_err;
        self.largest.filter(|largest| error > COARSE * largest).map(|largest| (error, largest))
    }
}

/// A baked texture: layout, tiles, the truth in f32, and the texels that ship.
#[derive(Debug, Clone, PartialEq)]
pub struct Atlas {
    /// Kind of the table.
    pub kind: TableKind,
    /// Places of its texels.
    pub layout: AtlasLayout,
    /// Format of the texels that ship.
    pub format: TexelFormat,
    /// One entry per tile.
    pub tiles: Vec<Tile>,
    /// Unquantised values.
    pub truth: Image,
    /// Texels that ship, of `format`, as the shader reads them.
    pub texels: Image,
    /// Bytes that ship, as a device takes them.
    pub bytes: Vec<u8>,
}

impl Atlas {
    /// Reads the quantised texels as the hardware and the shader would.
    pub fn sample(&self, tile: u32, values: [f64; 2], weights: WeightBits) -> [f64; 4] {
        read(self.kind, &self.layout, self.format, &self.texels, tile, values, weights)
    }
}

/// The values that a look-up gives for axis values. The shader itself filters formats that core WebGPU does not: their weights are exact, and
/// `weights` is ignored.
pub fn read(
    kind: TableKind,
    layout: &AtlasLayout,
    format: TexelFormat,
    texels: &Image,
    tile: u32,
    values: [f64; 2],
    weights: WeightBits,
) -> [f64; 4] {
    let weights = if format.is_filterable() { weights } else { WeightBits::Exact };
    let position = layout.position(tile, values);
    let texel = if format.has_steps() { stepped(texels, position) } else { bilinear(texels, position, weights) };
    match layout.base {
        RowBase::Zero => Encoding::of(kind, format).decode(texel),
        RowBase::Schlick => {
            let base = SchlickBase::read(texels, layout.header(tile));
            let closed_form = base.closed_form(values[0].clamp(0.0, 1.0));
            let span = SchlickBase::span(format);
            let [r, g, b] = [0, 1, 2].map(|c: usize| closed_form[c] + base.scale[c] * (span * texel[c] - 1.0));
            [r, g, b, 1.0]
        }
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn axis(size: u32, mapping: Mapping) -> Axis {
        Axis { quantity: "x".into(), unit: String::new(), min: 0.5, max: 2.0, size, mapping }
    }

    fn any_layout() -> impl Strategy<Value = AtlasLayout> {
        let mapping =
            prop_oneof![Just(Mapping::Linear), Just(Mapping::Power { exponent: 8.0 }), Just(Mapping::Logarithmic),];
        let sizes = (2..40u32, prop::option::of(2..40u32));
        let base = prop_oneof![Just(RowBase::Zero), Just(RowBase::Schlick)];
        (sizes, mapping, any::<bool>(), 1..5u32, 1..12u32, base).prop_map(
            |((w, h), mapping, periodic, columns, tiles, base)| {
                let mapping = if periodic { Mapping::Periodic } else { mapping };
                AtlasLayout {
                    x: axis(w, mapping),
                    y: h.map(|h| axis(h, mapping)),
                    apron: u32::from(periodic),
                    columns,
                    tiles,
                    base: if h.is_none() && !periodic { base } else { RowBase::Zero },
                }
            },
        )
    }

    /// Long sides of many tiles are powers of two; a long tile alone is as long as it is.
    #[test]
    fn long_sides_of_many_tiles_are_powers_of_two() {
        let row = |nodes, columns, tiles| {
            let x = axis(nodes, Mapping::Linear);
            let layout = AtlasLayout { x, y: None, apron: 0, columns, tiles, base: RowBase::Zero };
            assert_eq!(layout.checked_size(), Some(layout.size()));
            layout.size()
        };
        assert_eq!(row(32, 2, 8192), [64, 4096]);
        assert_eq!(row(32, 2, 8193), [64, 8192]);
        assert_eq!(row(32, 129, 258), [8192, 2]);
        assert_eq!(row(5000, 1, 3), [5000, 3]);
    }

    proptest! {
        /// A read touches no other tile: these hold a value that would show however little it weighed.
        #[test]
        fn reads_never_touch_another_tile(layout in any_layout(), tile: u32, values in [-5.0..5.0f64, -5.0..5.0f64], ends: [bool; 2]) {
            let tile = tile % layout.tiles;
            let values = [0, 1].map(|i| if ends[i] { layout.x.max } else { values[i] });
            let [width, height] = layout.size();
            let mut image = Image { data: vec![1e30; (width * height) as usize], ..Image::zeros(width, height, 1) };
            let [x0, y0] = layout.origin(tile);
            let [w, h] = layout.tile_size();
            prop_assert!(x0 + w <= width && y0 + h <= height);
            for y in y0..y0 + h {
                for x in x0..x0 + w {
                    image.texel_mut(x, y)[0] = 1.0;
                }
            }
            for weights in [WeightBits::Exact, WeightBits::Fixed(8)] {
                prop_assert_eq!(bilinear(&image, layout.position(tile, values), weights)[0], 1.0);
            }
        }
    }

    proptest! {
        /// A position that is off by a rounding of a sampler reads its row alone.
        #[test]
        fn rows_that_are_apart_do_not_bleed(size in 2..40u32, rows in 2..8u32, columns in 1..4u32, tiles in 1..9u32, at: u32, x in 0.5..2.0f64, ends: bool) {
            let y = Axis { min: 0.0, max: f64::from(rows - 1), ..axis(rows, Mapping::Apart) };
            let x_axis = axis(size, Mapping::Linear);
            let layout = AtlasLayout { x: x_axis, y: Some(y), apron: 1, columns, tiles, base: RowBase::Zero };
            let ([width, height], across) = (layout.size(), layout.row_size());
            prop_assert!(height.is_power_of_two() && layout.checked_size() == Some([width, height]));
            let mut image = Image::zeros(width, height, 1);
            for j in 0..height {
                for i in 0..width {
                    image.texel_mut(i, j)[0] = (j * width + i / across) as f32;
                }
            }
            let (tile, row) = (at % tiles, at / tiles % rows);
            let [left, top] = layout.origin(tile);
            let expected = f64::from(top * width + left / across + row);
            let x = if ends { if x < 1.0 { 0.5 } else { 2.0 } } else { x };
            let [x, y] = layout.position(tile, [x, f64::from(row)]);
            for off in [-1.0 / 256.0, 0.0, 1.0 / 256.0] {
                prop_assert_eq!(bilinear(&image, [x + off, y], WeightBits::Fixed(8))[0], expected);
            }
        }
    }

    #[test]
    fn tiles_fill_rows_without_overlap() {
        let layout = AtlasLayout {
            x: axis(8, Mapping::Periodic),
            y: Some(axis(4, Mapping::Periodic)),
            apron: 1,
            columns: 3,
            tiles: 7,
            base: RowBase::Zero,
        };
        assert_eq!(layout.tile_size(), [10, 6]);
        assert_eq!(layout.size(), [30, 18]);
        assert_eq!([0, 2, 3, 6].map(|tile| layout.origin(tile)), [[0, 0], [20, 0], [0, 6], [0, 12]]);
    }

    #[test]
    fn the_outermost_nodes_are_texel_centres() {
        let layout =
            AtlasLayout { x: axis(128, Mapping::Linear), y: None, apron: 0, columns: 2, tiles: 3, base: RowBase::Zero };
        assert_eq!(layout.position(1, [0.5, f64::NAN]), [128.5, 0.5]);
        assert_eq!(layout.position(2, [2.0, 0.0]), [127.5, 1.5]);
    }
}
