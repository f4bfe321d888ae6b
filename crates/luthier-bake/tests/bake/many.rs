//! A large library: its materials share what is equal, and find what is theirs.

use std::collections::BTreeSet;

use luthier_bake::{Baked, MemoryStore, Options, Silent, bake_with};
use luthier_lut::{Atlas, TableKind};
use luthier_manifest::SIDE_MAX;
use luthier_material::{Material, parse};

use crate::library::Library;
use crate::materials::{atlas, unfitted};

const COUNT: u32 = 1000;

fn materials(numbers: impl Iterator<Item = u32>) -> Vec<Material> {
    let library = Library { seed: 7, variety: 50 };
    let material = |number: u32| {
        let text = library.material(number);
        let parsed = parse(&format!("{number}.toml"), &text, &|_| Err(std::io::ErrorKind::NotFound.into()));
        unfitted(parsed.unwrap().material)
    };
    numbers.map(material).collect()
}

fn bake(materials: &[Material]) -> Baked {
    let options = Options { search: false, ..Options::default() };
    bake_with(materials, &options, &|_, _| Err("no images here".to_owned()), &Silent, &MemoryStore::default()).unwrap()
}

/// The texels of a tile.
fn texels(atlas: &Atlas, tile: u32) -> Vec<&[f32]> {
    let ([x, y], [width, height]) = (atlas.layout.origin(tile), atlas.layout.tile_size());
    (0..height).flat_map(|j| (0..width).map(move |i| atlas.texels.texel(x + i, y + j))).collect()
}

#[test]
fn a_thousand_materials_find_their_rows() {
    let baked = bake(&materials(0..COUNT));
    let rows = atlas(&baked, TableKind::Fresnel);
    assert_eq!(baked.materials.len(), COUNT as usize);
    assert!(baked.atlases.iter().flat_map(|atlas| atlas.layout.size()).all(|side| side <= SIDE_MAX));
    let hashes: BTreeSet<&str> = rows.tiles.iter().map(|tile| tile.input_hash.as_str()).collect();
    assert_eq!(hashes.len(), rows.tiles.len(), "no row is there twice");
    let used: BTreeSet<u32> = baked
        .materials
        .iter()
        .flat_map(|material| &material.records)
        .filter_map(|record| record.tiles[TableKind::Fresnel])
        .collect();
    assert!(used.into_iter().eq(0..rows.layout.tiles), "every row is somebody's");
    for number in [0, 1, 499, 742, COUNT - 1] {
        let alone = bake(&materials(std::iter::once(number)));
        let (found, expected) = (&baked.materials[number as usize], &alone.materials[0]);
        assert_eq!(found.records.len(), expected.records.len());
        for (found, expected) in found.records.iter().zip(&expected.records) {
            assert_eq!((found.alpha, found.ior_n, found.eta), (expected.alpha, expected.ior_n, expected.eta));
            let Some((found, expected)) = found.tiles[TableKind::Fresnel].zip(expected.tiles[TableKind::Fresnel])
            else {
                assert_eq!(found.tiles[TableKind::Fresnel], expected.tiles[TableKind::Fresnel]);
                continue;
            };
            assert_eq!(texels(rows, found), texels(atlas(&alone, TableKind::Fresnel), expected), "material {number}");
        }
    }
}
