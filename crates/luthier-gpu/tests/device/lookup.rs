//! The device's look-ups against the CPU sampler of luthier-lut, for every kind, format and mapping.

use luthier_gpu::{Gpu, GpuError};
use luthier_lut::{AtlasLayout, Mapping, TableKind, TexelFormat, WeightBits, bilinear};
use luthier_manifest::LayerRecord;
use luthier_shader::Form;

use crate::adapter::gpu;
use crate::bake_by_hand::{Table, artefacts, axis, dielectric, diffuse, row_layout, square_layout};

/// Error of a texel coordinate, in texels: filtering hardware keeps 8 fractional bits of a weight, so half a step of
/// them; the rest is f32 arithmetic and the f32 roots of the mappings.
const COORDINATE: f64 = 1.0 / 512.0 + 2e-4;

/// llvmpipe filters 8-bit texels in 8-bit arithmetic: its result may be a whole step off. Graphics hardware has more
/// bits.
fn step_of_arithmetic(gpu: &Gpu, format: TexelFormat) -> f64 {
    if gpu.is_software() && format == TexelFormat::Rgba8Unorm { 1.0 / 255.0 } else { 0.0 }
}

/// Filtered half floats may be rounded to half floats again by graphics hardware: half a step, of the value.
fn half_step(gpu: &Gpu, format: TexelFormat) -> f64 {
    let is_half = matches!(format, TexelFormat::R16Float | TexelFormat::Rg16Float | TexelFormat::Rgba16Float);
    if is_half && !gpu.is_software() { 1.0 / 2048.0 } else { 0.0 }
}

/// Material that points at every tile of a set of tables: one layer per tile, Fresnel and distribution always.
fn layers(tables: &[Table]) -> Vec<Vec<LayerRecord>> {
    let mut layers = Vec::new();
    for table in tables {
        for tile in 0..table.layout.tiles {
            let mut layer = dielectric(0.5, 1.5);
            (layer.tiles[TableKind::Fresnel], layer.tiles[TableKind::Distribution]) = (Some(0), Some(0));
            layer.tiles[table.kind] = Some(tile);
            layers.push(vec![layer, diffuse([0.5; 3], 0.0)]);
        }
    }
    layers
}

/// The two tables that every interface needs.
fn plain_tables() -> [Table; 2] {
    [
        Table::new(TableKind::Fresnel, row_layout(), TexelFormat::Rgba16Float, |_, _| [0.5; 4]),
        Table::new(TableKind::Distribution, square_layout("theta_h"), TexelFormat::R16Float, |_, _| [0.5; 4]),
    ]
}

/// Plain tables with one of them replaced or added.
fn with(table: Table) -> Vec<Table> {
    let mut tables: Vec<Table> = plain_tables().into_iter().filter(|t| t.kind != table.kind).collect();
    tables.push(table);
    tables.sort_by_key(|t| t.kind);
    tables
}

/// A smooth function with a slope everywhere, different in every channel and tile, within 0..1.
fn ramp(tile: u32, [x, y]: [f64; 2]) -> [f32; 4] {
    let t = f64::from(tile);
    let v =
        [0.2 + 0.5 * x.min(2.0) / 2.0, 0.9 - 0.1 * t - 0.3 * y, 0.1 + 0.3 * (x * x).min(1.0) + 0.2 * y, 0.5 + 0.1 * t];
    v.map(|v| v as f32)
}

/// Axis values all over a table: nodes, ends, between, and outside.
fn probes(layout: &AtlasLayout) -> Vec<[f32; 2]> {
    let along = |axis: Option<&luthier_lut::Axis>, steps: u32| -> Vec<f32> {
        let Some(axis) = axis else { return vec![0.0] };
        let outside = [axis.min - 0.1, axis.max + 0.1].map(|v| v as f32);
        let inside = (0..=steps).map(|i| axis.decode(f64::from(i) / f64::from(steps)) as f32);
        outside.into_iter().filter(|v| *v >= 0.0).chain(inside).collect()
    };
    let xs = along(Some(&layout.x), 331);
    let ys = along(layout.y.as_ref(), 37);
    ys.iter().flat_map(|&y| xs.iter().map(move |&x| [x, y])).collect()
}

/// Reads a table all over on the device, and holds it against the CPU sampler: within what a coordinate error of
/// [`COORDINATE`] makes of the steepest interval of the table.
fn compare(table: &Table) {
    let Some(gpu) = gpu() else { return };
    let tables = with(table.clone());
    let scene = gpu.scene(&artefacts(Form::Baked, layers(&tables), &tables), Form::Baked).unwrap();
    let texels = table.texels();
    let channels = match table.kind {
        TableKind::Distribution => 1,
        TableKind::Fresnel | TableKind::Phase => 3,
        _ => 4,
    }
    .min(texels.channels as usize);
    let values = probes(&table.layout);
    for tile in 0..table.layout.tiles {
        let read = scene.lookup(table.kind, tile, &values).unwrap();
        assert_eq!(read.len(), values.len());
        let tolerance = 2.0 * COORDINATE * steepest(table, tile) + step_of_arithmetic(&gpu, table.format) + 1e-6;
        for (got, at) in read.iter().zip(&values) {
            let position = table.layout.position(tile, at.map(f64::from));
            let expected = bilinear(&texels, position, WeightBits::Exact);
            for c in 0..channels {
                let error = (f64::from(got[c]) - expected[c]).abs();
                let tolerance = tolerance + half_step(&gpu, table.format) * expected[c].abs();
                assert!(
                    error <= tolerance,
                    "{:?} {} {:?} tile {tile} at {at:?} channel {c}: {} against {}, tolerance {tolerance}",
                    table.kind,
                    table.format,
                    table.layout.x.mapping,
                    got[c],
                    expected[c]
                );
            }
        }
    }
}

/// Largest step between neighbours of a tile, in any channel.
fn steepest(table: &Table, tile: u32) -> f64 {
    let texels = table.texels();
    let [ox, oy] = table.layout.origin(tile);
    let [w, h] = table.layout.tile_size();
    let mut step = 0.0f32;
    for y in oy..oy + h {
        for x in ox..ox + w {
            for (nx, ny) in [(x + 1, y), (x, y + 1)] {
                if nx < ox + w && ny < oy + h {
                    let pairs = texels.texel(x, y).iter().zip(texels.texel(nx, ny));
                    step = pairs.fold(step, |s, (a, b)| s.max((a - b).abs()));
                }
            }
        }
    }
    f64::from(step)
}

const COLOR_FORMATS: [TexelFormat; 3] = [TexelFormat::Rgba8Unorm, TexelFormat::Rgba16Float, TexelFormat::Rgba32Float];

#[test]
fn fresnel_rows_in_every_format_and_mapping() {
    for format in COLOR_FORMATS {
        for (quantity, mapping, columns) in [
            ("cos_theta", Mapping::Linear, 1),
            ("cos_theta", Mapping::Power { exponent: 2.0 }, 2),
            ("cos_theta", Mapping::Power { exponent: 0.5 }, 3),
        ] {
            let x = axis(quantity, 1.0, 33, mapping);
            let layout = AtlasLayout { x, y: None, apron: 0, columns, tiles: 5, base: luthier_lut::RowBase::Zero };
            compare(&Table::new(TableKind::Fresnel, layout, format, ramp));
        }
    }
}

#[test]
fn distribution_tiles_in_every_format_and_mapping() {
    for format in [TexelFormat::R16Float, TexelFormat::R32Float] {
        for (exponent, alpha) in
            [(8.0, Mapping::Linear), (2.0, Mapping::Power { exponent: 2.0 }), (3.0, Mapping::Logarithmic)]
        {
            let layout = AtlasLayout {
                x: axis("theta_h", std::f64::consts::FRAC_PI_2, 64, Mapping::Power { exponent }),
                y: Some(axis("alpha", 1.0, 32, alpha)),
                apron: 0,
                columns: 2,
                tiles: 3,
                base: luthier_lut::RowBase::Zero,
            };
            compare(&Table::new(TableKind::Distribution, layout, format, ramp));
        }
    }
}

fn fgd_layout() -> AtlasLayout {
    AtlasLayout {
        x: axis("cos_theta", 1.0, 32, Mapping::Power { exponent: 2.0 }),
        y: Some(axis("alpha", 1.0, 16, Mapping::Power { exponent: 2.0 })),
        apron: 0,
        columns: 3,
        tiles: 4,
        base: luthier_lut::RowBase::Zero,
    }
}

#[test]
fn fgd_tiles_in_every_format() {
    for format in COLOR_FORMATS {
        compare(&Table::new(TableKind::Fgd, fgd_layout(), format, ramp));
    }
}

/// The driver decodes blocks by itself.
#[test]
fn fgd_tiles_in_blocks() {
    let Some(gpu) = gpu() else { return };
    let table = Table::new(TableKind::Fgd, fgd_layout(), TexelFormat::Bc6hRgbUfloat, ramp);
    let tables = with(table.clone());
    match gpu.scene(&artefacts(Form::Baked, layers(&tables), &tables), Form::Baked) {
        Err(GpuError::NoSuchFormat { kind, format }) => {
            assert_eq!((kind, format), (TableKind::Fgd, TexelFormat::Bc6hRgbUfloat));
        }
        _ => compare(&table),
    }
}

#[test]
fn phase_rows_in_every_format() {
    for format in COLOR_FORMATS {
        let layout = AtlasLayout {
            x: axis("s", 1.0, 64, Mapping::Linear),
            y: None,
            apron: 0,
            columns: 1,
            tiles: 3,
            base: luthier_lut::RowBase::Zero,
        };
        compare(&Table::new(TableKind::Phase, layout, format, ramp));
    }
}

#[test]
fn thickness_tiles_repeat() {
    for format in COLOR_FORMATS {
        let layout = AtlasLayout {
            x: axis("u", 1.0, 16, Mapping::Periodic),
            y: Some(axis("v", 1.0, 16, Mapping::Periodic)),
            apron: 1,
            columns: 2,
            tiles: 3,
            base: luthier_lut::RowBase::Zero,
        };
        let wave = |tile: u32, [u, v]: [f64; 2]| {
            let (u, v) = (std::f64::consts::TAU * u, std::f64::consts::TAU * v);
            [0.5 + 0.4 * u.sin(), 0.5 + 0.3 * v.cos(), 0.5 + 0.2 * (u + v).sin(), 0.1 * f64::from(tile)]
                .map(|x| x as f32)
        };
        compare(&Table::new(TableKind::Thickness, layout, format, wave));
    }
}

/// Rows that are read from a buffer, between the values of one word: one below the other, in columns, and part by part.
#[test]
fn rows_with_steps_are_those_of_the_cpu() {
    let Some(gpu) = gpu() else { return };
    let rows = AtlasLayout { x: axis("cos_theta", 1.0, 9, Mapping::Rational { bend: 1.0 }), tiles: 5, ..row_layout() };
    let part = luthier_lut::Axis { min: -2.0, ..axis("part", 3.0, 6, Mapping::Apart) };
    let parts = AtlasLayout { y: Some(part), apron: 1, ..rows.clone() };
    let columns = AtlasLayout { columns: 2, ..rows.clone() };
    for (kind, layout) in [(TableKind::Fresnel, rows), (TableKind::Fresnel, columns), (TableKind::Lobes, parts)] {
        let mut table = Table::new(kind, layout, TexelFormat::Rgba16FloatSteps, |_, _| [0.0; 4]);
        // Numbers of every magnitude and sign, so that a read of another texel would show.
        for (i, value) in table.truth.data.iter_mut().enumerate() {
            *value = (libm::sin(i as f64) * libm::exp2((i % 13) as f64 - 6.0)) as f32;
        }
        let tables = with(table.clone());
        let scene = gpu.scene(&artefacts(Form::Baked, layers(&tables), &tables), Form::Baked).unwrap();
        let texels = table.texels();
        let channels = if kind == TableKind::Fresnel { 3 } else { 4 };
        let mut values = probes(&table.layout);
        // Parts are read at whole numbers.
        values.iter_mut().for_each(|at| at[1] = at[1].round().clamp(-2.0, 3.0));
        for tile in 0..table.layout.tiles {
            for (got, at) in scene.lookup(kind, tile, &values).unwrap().iter().zip(&values) {
                let expected = luthier_lut::read(
                    kind,
                    &table.layout,
                    table.format,
                    &texels,
                    tile,
                    at.map(f64::from),
                    WeightBits::Fixed(8),
                );
                for c in 0..channels {
                    let error = (f64::from(got[c]) - expected[c]).abs();
                    assert!(error < 2e-4, "{kind:?} tile {tile} at {at:?}: {got:?}, not {expected:?}");
                }
            }
        }
    }
}

/// Rows and tiles next to each other hold 0 and 1000. A read of 0 anywhere in its tile may show no more of the
/// neighbour than rounding of an f32 texel coordinate lets through.
#[test]
fn tiles_do_not_bleed() {
    let Some(gpu) = gpu() else { return };
    let loud = |tile: u32, _: [f64; 2]| [if tile.is_multiple_of(2) { 0.0 } else { 1000.0 }; 4];
    for format in [TexelFormat::Rgba16Float, TexelFormat::Rgba32Float] {
        let rows = AtlasLayout {
            x: axis("cos_theta", 1.0, 128, Mapping::Linear),
            y: None,
            apron: 0,
            columns: 1,
            tiles: 33,
            base: luthier_lut::RowBase::Zero,
        };
        let squares =
            AtlasLayout { y: Some(axis("alpha", 1.0, 32, Mapping::Linear)), columns: 3, tiles: 5, ..rows.clone() };
        let tables = with(Table::new(TableKind::Fresnel, rows, format, loud));
        let mut tables: Vec<Table> = tables;
        tables.push(Table::new(TableKind::Fgd, squares, format, loud));
        let scene = gpu.scene(&artefacts(Form::Baked, layers(&tables), &tables), Form::Baked).unwrap();
        for table in tables.iter().filter(|t| t.kind != TableKind::Distribution) {
            let values = probes(&table.layout);
            for tile in 0..table.layout.tiles {
                let expected = loud(tile, [0.0; 2])[0];
                for (got, at) in scene.lookup(table.kind, tile, &values).unwrap().iter().zip(&values) {
                    // 33 rows: a coordinate is good to 33 * 2^-24 rows, times 1000.
                    assert!(
                        (got[0] - expected).abs() < 5e-3,
                        "{:?} {format} tile {tile} at {at:?}: {}",
                        table.kind,
                        got[0]
                    );
                }
            }
        }
    }
}

#[test]
fn absent_tables_and_tiles_are_errors() {
    let Some(gpu) = gpu() else { return };
    let tables = plain_tables();
    let scene = gpu.scene(&artefacts(Form::Baked, layers(&tables), &tables), Form::Baked).unwrap();
    let missing = scene.lookup(TableKind::Phase, 0, &[[0.5, 0.0]]).unwrap_err();
    assert!(matches!(missing, GpuError::NoTable { kind: TableKind::Phase, .. }), "{missing}");
    let beyond = scene.lookup(TableKind::Fresnel, 1, &[[0.5, 0.0]]).unwrap_err();
    assert!(matches!(beyond, GpuError::NoTile { tile: 1, count: 1, .. }), "{beyond}");
    assert!(scene.lookup(TableKind::Fresnel, 0, &[]).unwrap().is_empty());
    // More than one submission.
    let many = vec![[0.5, 0.0]; (1 << 18) + 3];
    let read = scene.lookup(TableKind::Fresnel, 0, &many).unwrap();
    assert!(read.len() == many.len() && read.iter().all(|v| v[..3] == [0.5; 3]));
}
