//! Materials of a large set against each of them alone.

use luthier_lut::{AtlasLayout, Mapping, TableKind, TexelFormat};
use luthier_manifest::{LayerRecord, SIDE, SIDE_MAX};
use luthier_shader::Form;

use crate::adapter::gpu;
use crate::bake_by_hand::{Table, artefacts, axis, conductor, dielectric, row_layout};

/// Materials of two layers: their 198,000 words of the buffer are three megabytes, and their rows fill columns of an atlas.
const COUNT: u32 = 6000;

/// First, last, at and beside the end of a column of the atlas, and one in between.
const NUMBERS: [u32; 6] = [0, SIDE / 2 - 1, SIDE / 2, 3001, 4711, COUNT - 1];

/// A coat and a metal that no other material has; `tile` is that of the coat's row.
fn layers(number: u32, tile: u32) -> Vec<LayerRecord> {
    let share = f64::from(number) / f64::from(COUNT);
    let coat = dielectric(0.05 + 0.1 * share, 1.3 + 0.4 * share);
    let metal = conductor(0.2 + 0.3 * share, [0.2, 0.5 + share, 1.1], [3.0 - share, 2.4, 1.9]);
    [coat, metal]
        .into_iter()
        .zip([tile, tile + 1])
        .map(|(layer, tile)| LayerRecord { tiles: layer.tiles.with([(TableKind::Fresnel, Some(tile))]), ..layer })
        .collect()
}

/// Rows of reflectance; the row of a tile has nothing in common with the rows beside it.
fn rows(tiles: u32, columns: u32, first: u32) -> Table {
    let layout = AtlasLayout { x: axis("cos_theta", 1.0, 32, Mapping::Linear), columns, tiles, ..row_layout() };
    Table::new(TableKind::Fresnel, layout, TexelFormat::Rgba16Float, |tile, [cos_theta, _]| {
        let scattered = (first + tile).wrapping_mul(0x9e37_79b9) >> 8;
        let f0 = scattered as f32 / (1 << 24) as f32;
        let value = f0 + (1.0 - f0) * (1.0 - cos_theta as f32).powi(5);
        [value, 0.5 * value, 0.25 * value, 1.0]
    })
}

fn pairs() -> Vec<([f32; 3], [f32; 3])> {
    let direction = |cos_theta: f32, phi: f32| {
        let sin_theta = (1.0 - cos_theta * cos_theta).sqrt();
        [sin_theta * phi.cos(), sin_theta * phi.sin(), cos_theta]
    };
    let cosines = (1..40).map(|i| i as f32 / 40.0);
    cosines.map(|c| (direction(c, 0.3), direction(1.02 - c, 3.3))).collect()
}

/// A material among many has the bits that it has alone: without tables, only the buffer is read.
#[test]
fn a_large_number_finds_its_own_layers() {
    let Some(gpu) = gpu() else { return };
    let many = artefacts(Form::Full, (0..COUNT).map(|number| layers(number, 0)).collect(), &[]);
    let scene = gpu.scene(&many, Form::Full).unwrap();
    for number in NUMBERS {
        let alone = gpu.scene(&artefacts(Form::Full, vec![layers(number, 0)], &[]), Form::Full).unwrap();
        let (found, expected) = (scene.evaluate(number, &pairs()).unwrap(), alone.evaluate(0, &pairs()).unwrap());
        assert!(expected.iter().flatten().all(|value| *value > 0.0));
        assert_eq!(found, expected, "material {number}");
    }
}

/// A position in a large atlas is rounded to a two-thousandth of a texel at most, of which neighbours of the row differ by a tenth. Graphics hardware
/// weighs them in steps of 1/256, and rounds to half floats.
fn tolerance(gpu: &luthier_gpu::Gpu) -> f32 {
    if gpu.is_software() { 1e-4 } else { 1e-3 }
}

#[test]
fn a_large_number_finds_its_own_rows() {
    let Some(gpu) = gpu() else { return };
    // 256 columns of 32 texels are the widest atlas; two rows a material fill 47 texels of its height. And the tallest.
    for columns in [SIDE_MAX / 32, 2 * COUNT / SIDE_MAX + 1] {
        let tiles = 2 * COUNT;
        let table = rows(tiles, columns, 0);
        assert!(table.layout.size().iter().all(|side| *side <= SIDE_MAX));
        let many = artefacts(Form::Baked, (0..COUNT).map(|number| layers(number, 2 * number)).collect(), &[table]);
        let scene = gpu.scene(&many, Form::Baked).unwrap();
        for number in NUMBERS {
            let table = rows(2, 1, 2 * number);
            let alone = gpu.scene(&artefacts(Form::Baked, vec![layers(number, 0)], &[table]), Form::Baked).unwrap();
            let (found, expected) = (scene.evaluate(number, &pairs()).unwrap(), alone.evaluate(0, &pairs()).unwrap());
            for (found, expected) in found.iter().flatten().zip(expected.iter().flatten()) {
                let error = (found - expected).abs() / expected.max(1e-3);
                assert!(error < tolerance(&gpu), "material {number}, {columns} columns: {found} alone {expected}");
            }
        }
    }
}
