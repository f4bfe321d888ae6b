//! Limits of one bake, checked before anything is computed.

use luthier_lut::{AtlasLayout, TableKind, TexelFormat};
use luthier_manifest::{BUFFER_WORDS_MAX, LAYER_WORDS, MATERIAL_WORDS, SIDE, SIDE_MAX};

use crate::BakeError;
use crate::plan::{Plan, PlannedLayers};
use crate::settings::Shape;
use crate::tile::apron;

/// Refuses more layers than the material buffer holds.
pub(crate) fn check_buffer(records: &[PlannedLayers]) -> Result<(), BakeError> {
    let layers: usize = records.iter().map(PlannedLayers::blocks).sum();
    let (materials, words) = (records.len(), records.len() * MATERIAL_WORDS + layers * LAYER_WORDS);
    if words > BUFFER_WORDS_MAX { Err(BakeError::TooManyLayers { materials, layers, words }) } else { Ok(()) }
}

/// Number of tiles across and down in a texture with sides of at most `side` texels.
fn grid(tile: [u32; 2], side: u32) -> [u32; 2] {
    tile.map(|texels| side / texels)
}

/// Number of columns of a layout's tiles: one while they fit into [`SIDE`], else as many as needed, then in longer
/// sides. None where no texture holds them.
pub(crate) fn columns(layout: &AtlasLayout) -> Option<u32> {
    let sides = std::iter::successors(Some(SIDE), |side| (*side < SIDE_MAX).then_some(side * 2));
    sides.into_iter().find_map(|side| {
        let [across, down] = grid(layout.tile_size(), side);
        let columns = layout.tiles.div_ceil(down.max(1));
        (down > 0 && columns <= across).then_some(columns)
    })
}

/// One, if a texture holds all tiles of a layout one below the other.
pub(crate) fn one_column(layout: &AtlasLayout) -> Option<u32> {
    let [across, down] = grid(layout.tile_size(), SIDE_MAX);
    (across > 0 && layout.tiles <= down).then_some(1)
}

/// The refusal of tiles that no texture holds.
pub(crate) fn too_many_tiles(kind: TableKind, layout: &AtlasLayout) -> BakeError {
    let tile = layout.tile_size();
    let [across, down] = grid(tile, SIDE_MAX);
    let setting = format!("make the tiles smaller (`size` in [bake.{}]), or ", kind.name());
    let setting = if kind.facts().has_settings { setting.as_str() } else { "" };
    let hint = format!("{setting}bake the materials into several folders");
    BakeError::TooManyTiles { kind, tiles: layout.tiles, tile, most: across * down, hint }
}

/// Kind, layout and texel format of each table of a plan, in binding order.
pub(crate) fn layouts(plan: &Plan) -> Result<Vec<(TableKind, AtlasLayout, TexelFormat)>, BakeError> {
    let layouts = plan.used().filter_map(|(kind, tiles)| {
        let Shape { x, y, base, format } = plan.settings.shape(kind)?.clone();
        let (apron, count) = (apron(std::iter::once(&x).chain(&y)), tiles.tiles.len() as u32);
        let layout = AtlasLayout { x, y, apron, columns: 1, tiles: count, base };
        let columns = if tiles.has_runs { one_column(&layout) } else { columns(&layout) };
        Some(match columns {
            Some(columns) => Ok((kind, AtlasLayout { columns, ..layout }, format)),
            None => Err(too_many_tiles(kind, &layout)),
        })
    });
    layouts.collect()
}

#[cfg(test)]
mod tests {
    use luthier_lut::{Mapping, RowBase};

    use super::*;
    use crate::settings::axis;

    fn layout([width, height]: [u32; 2], tiles: u32) -> AtlasLayout {
        let axis = |size| axis("cos_theta", "", [0.0, 1.0], size, Mapping::Linear);
        AtlasLayout { x: axis(width), y: Some(axis(height)), apron: 0, columns: 1, tiles, base: RowBase::Zero }
    }

    #[test]
    fn atlases_grow_in_columns_within_the_sides_of_webgpu() {
        // Tile, tiles, columns: within 2,048, then 4,096, then 8,192, then not at all.
        for (tile, tiles, expected) in [
            ([128, 1], 2048, Some(1)),
            ([128, 1], 2049, Some(2)),
            ([64, 64], 1024, Some(32)),
            ([64, 64], 1025, Some(17)),
            ([64, 64], 4096, Some(64)),
            ([64, 64], 4097, Some(33)),
            ([64, 64], 16_384, Some(128)),
            ([64, 64], 16_385, None),
            ([4096, 512], 16, Some(1)),
            ([4096, 512], 17, Some(2)),
            ([8192, 8192], 1, Some(1)),
            ([8193, 1], 1, None),
            ([1, 8193], 1, None),
        ] {
            assert_eq!(columns(&layout(tile, tiles)), expected, "{tiles} of {tile:?}");
        }
        for (tile, tiles, expected) in [([128, 1], 8192, Some(1)), ([128, 1], 8193, None), ([8193, 1], 1, None)] {
            assert_eq!(one_column(&layout(tile, tiles)), expected, "{tiles} of {tile:?}");
        }
    }

    /// Every tile lies inside the texture, no two overlap, and what is refused has no place in the largest.
    #[test]
    fn every_tile_has_a_place_of_its_own() {
        for tile in [[1, 1], [24, 1], [128, 1], [512, 1], [48, 64], [258, 258], [3000, 3], [600, 5000]] {
            for tiles in (0..12).map(|i| 1 + i * i * i) {
                let mut layout = layout(tile, tiles);
                let Some(columns) = columns(&layout) else {
                    assert!(tiles > (SIDE_MAX / tile[0]) * (SIDE_MAX / tile[1]));
                    continue;
                };
                layout.columns = columns;
                let [across, down] = layout.size();
                assert!(across <= SIDE_MAX && down <= SIDE_MAX, "{tiles} of {tile:?}");
                let origins: std::collections::BTreeSet<_> = (0..tiles).map(|tile| layout.origin(tile)).collect();
                assert_eq!(origins.len(), tiles as usize);
                for [x, y] in origins {
                    assert!(x + tile[0] <= across && y + tile[1] <= down && x % tile[0] == 0 && y % tile[1] == 0);
                }
            }
        }
    }
}
