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

/// Nodes of a row.
const NODES: u32 = 32;

/// Reflectance at a cosine of the row of a tile, which has nothing in common with those beside it.
fn reflectance(tile: u32, cos_theta: f64) -> f64 {
    let scattered = tile.wrapping_mul(0x9e37_79b9) >> 8;
    let f0 = f64::from(scattered) / f64::from(1 << 24);
    f0 + (1.0 - f0) * (1.0 - cos_theta).powi(5)
}

/// How far a filter may be off at a node: by a share of the difference to the node beside it, and by roundings of the value.
#[derive(Clone, Copy)]
struct Filter {
    share: f64,
    rounding: f64,
}

impl Filter {
    /// Positions in a large atlas are f32: in texels up to 8192 they are rounded to 2^-11, twice. Graphics hardware has weights of 8 bits besides, so that two
    /// positions that are rounded apart differ by a step of them; and it rounds what it filtered to half floats, one up and the other down. Software filters in f32.
    fn of(gpu: &luthier_gpu::Gpu) -> Self {
        let position = 1.0 / 1024.0;
        if gpu.is_software() {
            Self { share: position, rounding: 1.0 / 16384.0 }
        } else {
            Self { share: position + 1.0 / 256.0, rounding: 1.0 / 1024.0 }
        }
    }

    fn error(self, tile: u32, cos_theta: f64) -> f64 {
        let node = 1.0 / f64::from(NODES - 1);
        let apart = reflectance(tile, (cos_theta - node).max(0.0)) - reflectance(tile, (cos_theta + node).min(1.0));
        self.share * apart.abs() + self.rounding * reflectance(tile, cos_theta)
    }
}

/// Rows of reflectance, and what is added to them.
fn rows(tiles: u32, columns: u32, first: u32, added: impl Fn(u32, f64) -> f64) -> Table {
    let layout = AtlasLayout { x: axis("cos_theta", 1.0, NODES, Mapping::Linear), columns, tiles, ..row_layout() };
    Table::new(TableKind::Fresnel, layout, TexelFormat::Rgba16Float, |tile, [cos_theta, _]| {
        let value = (reflectance(first + tile, cos_theta) + added(tile, cos_theta)) as f32;
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

/// So many times the error of a filter is added to rows: half floats hold it.
const MAGNIFIED: f64 = 64.0;

/// Values of a material alone, and how far those of another place in an atlas may be from them: as far as values move where a row, that of the coat or that of
/// the metal, is read as wrongly as the filter may read it; and a hundred roundings of f32.
fn alone(gpu: &luthier_gpu::Gpu, number: u32) -> Vec<(f32, f32)> {
    let filter = Filter::of(gpu);
    let values = |added: &dyn Fn(u32, f64) -> f64| {
        let table = rows(2, 1, 2 * number, added);
        let scene = gpu.scene(&artefacts(Form::Baked, vec![layers(number, 0)], &[table]), Form::Baked).unwrap();
        scene.evaluate(0, &pairs()).unwrap().into_iter().flatten().collect::<Vec<f32>>()
    };
    let off = |row: u32, sign: f64| {
        values(&|tile, cos| if tile == row { sign * MAGNIFIED * filter.error(2 * number + tile, cos) } else { 0.0 })
    };
    let expected = values(&|_, _| 0.0);
    let moved = [off(0, 1.0), off(0, -1.0), off(1, 1.0), off(1, -1.0)];
    let tolerance = |(i, value): (usize, &f32)| {
        let by = |row: usize| moved[2 * row..2 * row + 2].iter().map(|m| (m[i] - value).abs()).fold(0.0, f32::max);
        (*value, (by(0) + by(1)) / MAGNIFIED as f32 + 6e-6 * value)
    };
    expected.iter().enumerate().map(tolerance).collect()
}

#[test]
fn a_large_number_finds_its_own_rows() {
    let Some(gpu) = gpu() else { return };
    let expected = NUMBERS.map(|number| alone(&gpu, number));
    // A row of another material is farther off than that, nearly everywhere.
    let differ = |(a, b): (&(f32, f32), &(f32, f32))| (a.0 - b.0).abs() > a.1;
    let far = expected[0].iter().zip(&expected[1]).filter(|pair| differ(*pair)).count();
    assert!(far > expected[0].len() * 9 / 10, "{far} of {}", expected[0].len());
    // 256 columns of 32 texels are the widest atlas; two rows a material fill 47 texels of its height. And the tallest.
    for columns in [SIDE_MAX / NODES, 2 * COUNT / SIDE_MAX + 1] {
        let table = rows(2 * COUNT, columns, 0, |_, _| 0.0);
        assert!(table.layout.size().iter().all(|side| *side <= SIDE_MAX));
        let many = artefacts(Form::Baked, (0..COUNT).map(|number| layers(number, 2 * number)).collect(), &[table]);
        let scene = gpu.scene(&many, Form::Baked).unwrap();
        for (number, expected) in NUMBERS.into_iter().zip(&expected) {
            let found = scene.evaluate(number, &pairs()).unwrap();
            for (found, (expected, tolerance)) in found.iter().flatten().zip(expected) {
                let apart = (found - expected).abs();
                assert!(
                    apart <= *tolerance,
                    "material {number}, {columns} columns: {found} alone {expected} ± {tolerance}"
                );
            }
        }
    }
}

/// A row of a tall atlas holds nothing of the one beside it, beyond what f32 positions cost: 1/4096 of the difference. A step of an 8-bit weight would be 1/256.
#[test]
fn rows_of_tall_atlases_do_not_bleed() {
    let Some(gpu) = gpu() else { return };
    let columns = 2;
    let pair = [([0.3f32, 0.0, 0.953_939_2], [-0.3f32, 0.0, 0.953_939_2])];
    for rows in [1500, 3001, 5001] {
        let tiles = rows * columns;
        let layout = AtlasLayout { x: axis("cos_theta", 1.0, NODES, Mapping::Linear), columns, tiles, ..row_layout() };
        // Dark and bright rows by turns.
        let table = Table::new(TableKind::Fresnel, layout, TexelFormat::Rgba16Float, |tile, _| {
            let value = if (tile / columns).is_multiple_of(2) { 0.125 } else { 0.875 };
            [value, value, value, 1.0]
        });
        let metal = |tile: u32| {
            let metal = conductor(0.2, [0.2, 0.5, 1.1], [3.0, 2.4, 1.9]);
            vec![LayerRecord { tiles: metal.tiles.with([(TableKind::Fresnel, Some(tile))]), ..metal }]
        };
        let many = artefacts(Form::Baked, (0..tiles).map(metal).collect(), &[table]);
        let scene = gpu.scene(&many, Form::Baked).unwrap();
        let value = |row: u32| scene.evaluate(row * columns, &pair).unwrap()[0][0];
        let expected = [value(0), value(1)];
        for row in (0..rows).step_by(rows as usize / 100) {
            let (found, expected) = (value(row), expected[row as usize % 2]);
            let tolerance = (0.875 - 0.125) / 0.125 * expected / 4096.0;
            assert!((found - expected).abs() <= tolerance, "row {row} of {rows}: {found} for {expected}");
        }
    }
}
