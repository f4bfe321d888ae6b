//! The shipped functions, run in f32 without a GPU, against f64 from the papers and against printed values.

use std::collections::BTreeMap;
use std::f64::consts::{FRAC_PI_2, PI, TAU};

use crate::machine::{Machine, Value, vector};
use crate::paper;
use crate::scenes::{clear, conductor, dielectric, diffuse, filmed, forms, material, sets, tables};
use luthier_lut::{Axis, Image, Mapping, TableKind, TexelFormat, WeightBits, bilinear};
use luthier_manifest::{Distribution, LayerRecord, MaterialEntry, ShadingModel, material_buffer};
use luthier_shader::{Form, MaterialSet, TableFace, Target, emit};

pub(crate) fn full(materials: &[MaterialEntry]) -> Machine {
    let set = MaterialSet::new(materials, Vec::new());
    Machine::new(&emit(&set, Form::Full, Target::Wgsl).unwrap(), &material_buffer(materials), BTreeMap::new())
}

pub(crate) fn direction(cos_theta: f64, phi: f64) -> [f64; 3] {
    // Rounded to f32 and put back to unit length in f64, so that both sides see the same direction.
    let sin = (1.0 - cos_theta * cos_theta).sqrt();
    let rounded = [sin * phi.cos(), sin * phi.sin(), cos_theta].map(|v| f64::from(v as f32));
    let length = rounded.iter().map(|v| v * v).sum::<f64>().sqrt();
    rounded.map(|v| v / length)
}

/// Pairs of directions that fill the hemisphere evenly (R3 sequence), half of them near mirror directions, where the
/// lobes are.
pub(crate) fn directions(count: u32) -> impl Iterator<Item = ([f64; 3], [f64; 3])> {
    (0..count).map(|i| {
        let r = [0.819_172_513_396_164_4, 0.671_043_606_703_789_3, 0.549_700_477_901_960_1]
            .map(|a| (0.5 + a * f64::from(i)).fract());
        let wi = direction(0.02 + 0.98 * r[0], TAU * r[1]);
        let wo = if i % 2 == 0 {
            direction(0.02 + 0.98 * r[2], TAU * (r[1] * 7.0).fract())
        } else {
            direction(
                (0.02 + 0.98 * r[0] + 0.05 * (r[2] - 0.5)).clamp(0.02, 1.0),
                TAU * (r[1] + 0.5) + 0.1 * (r[2] - 0.5),
            )
        };
        (wi, wo)
    })
}

pub(crate) fn eval(machine: &Machine, material: u32, wi: [f64; 3], wo: [f64; 3]) -> Vec<f32> {
    let [wi, wo] = [wi, wo].map(|w| vector(&w.map(|v| v as f32)));
    machine.call("luthier_eval", vec![Value::U(material), wi, wo]).floats()
}

#[test]
fn full_form_agrees_with_the_paper() {
    // Directions in f32 are off by 6e-8, 3e-6 of the width of the narrowest lobe (alpha 0.02); some rounding on top.
    const TOLERANCE: f64 = 5e-5;
    const FLOOR: f64 = 1e-3;
    for (name, materials) in sets().into_iter().filter(|(_, materials)| forms(materials).any(|f| f == Form::Full)) {
        let machine = full(&materials);
        let mut worst = 0.0f64;
        for (number, material) in materials.iter().enumerate().filter(|(_, m)| m.model == ShadingModel::Elek) {
            for (wi, wo) in directions(800) {
                let mut expected = paper::eval(&material.layers, wi, wo);
                if let Some(coat) = &material.constants.coat {
                    let missing = if material.weighs_film_of_path() { 1 } else { 2 };
                    let below = [std::slice::from_ref(&coat.bare), &material.layers[missing..]].concat();
                    let below = paper::eval(&below, wi, wo);
                    expected = [0, 1, 2].map(|c| coat.weight * expected[c] + (1.0 - coat.weight) * below[c]);
                }
                let found = eval(&machine, number as u32, wi, wo);
                for (e, f) in expected.iter().zip(&found) {
                    let error = (f64::from(*f) - e).abs() / e.abs().max(FLOOR);
                    assert!(
                        error < TOLERANCE,
                        "{name}/{}: {wi:?} {wo:?}: {found:?}, paper {expected:?}",
                        material.name
                    );
                    worst = worst.max(error);
                }
            }
        }
        eprintln!("{name}: largest relative error {worst:.1e} (floor {FLOOR})");
    }
}

#[test]
fn narrow_lobes_keep_their_shape() {
    // alpha = 0.001: directions are known to 6e-8, that is 1e-4 of the lobe's width after halving and squaring.
    let layer = |distribution| LayerRecord { alpha: 1e-3, distribution, ..clear() };
    for distribution in [Distribution::Beckmann, Distribution::Ggx] {
        let materials = [material("sharp", &[layer(distribution)])];
        let machine = full(&materials);
        for (wi, _) in directions(300) {
            for step in 0..6 {
                let tilt = 4e-4 * f64::from(step);
                let wo = direction((wi[2] + tilt).min(1.0), wi[1].atan2(wi[0]) + TAU / 2.0);
                let (expected, found) = (paper::eval(&materials[0].layers, wi, wo), eval(&machine, 0, wi, wo));
                let error = (f64::from(found[0]) - expected[0]).abs() / expected[0].max(1e-3);
                assert!(error < 5e-3, "{distribution:?} {wi:?} {wo:?}: {found:?}, paper {expected:?}");
            }
        }
    }
}

/// Oracle: the closed form of a mirror direction, F D / (4 cos_theta) with D = 1 / (pi alpha^2), and the range of half floats.
#[test]
fn sums_are_bounded_for_half_floats_and_values_are_not() {
    let largest = half_max();
    let materials = [material("mirror", &[LayerRecord { alpha: 1e-3, alpha_xy: [1e-3; 2], ..conductor() }])];
    let machine = full(&materials);
    let bounded = |radiance: &[f32]| machine.call("luthier_bounded", vec![vector(radiance)]).floats();
    for degrees in [0.0_f64, 60.0, 89.9, 89.999] {
        let cos_theta = degrees.to_radians().cos();
        let (wi, wo) = (direction(cos_theta, 0.0), direction(cos_theta, TAU / 2.0));
        let layer = machine.call("luthier_layer", vec![Value::U(0), Value::U(0)]);
        let fresnel = machine.call("luthier_fresnel_term", vec![layer, Value::F(cos_theta as f32)]).floats();
        let found = eval(&machine, 0, wi, wo);
        for (found, fresnel) in found.iter().zip(fresnel) {
            let expected = f64::from(fresnel) / (4.0 * PI * 1e-6 * wo[2]);
            assert!((f64::from(*found) / expected - 1.0).abs() < 1e-5, "{degrees}: {found}, not {expected}");
        }
        assert_eq!(bounded(&found), found.iter().map(|value| value.min(largest)).collect::<Vec<_>>());
    }
    assert_eq!(bounded(&[-0.31, 0.5, 4.6e9]), [0.0, 0.5, largest]);
    assert_eq!(bounded(&[f32::INFINITY, f32::NEG_INFINITY, largest]), [largest, 0.0, largest]);
}

/// The largest half float: eleven bits of ones, the first of them 2^15.
fn half_max() -> f32 {
    (0..11).map(|bit| f32::from(1_u16 << (15 - bit))).sum()
}

/// Reflectance of the first layer of a one-layer material.
fn fresnel(layer: &LayerRecord, cos_theta: f64) -> Vec<f32> {
    let machine = full(&[material("sample", std::slice::from_ref(layer))]);
    let layer = machine.call("luthier_layer", vec![Value::U(0), Value::U(0)]);
    machine.call("luthier_fresnel_term", vec![layer, Value::F(cos_theta as f32)]).floats()
}

#[test]
fn film_reflectances_equal_published_transfer_matrix_values() {
    // index above, film, base (n, k), d nm, lambda nm, angle in degrees, R
    let cases = [
        (1.0, 1.33, (1.0, 0.0), 300.0, 550.0, 0.0, 0.07543020),
        (1.0, 1.33, (1.0, 0.0), 300.0, 550.0, 60.0, 0.5 * (0.05362888 + 0.00171259)),
        (1.0, 1.38, (1.5, 0.0), 550.0 / (4.0 * 1.38), 550.0, 0.0, 0.01411046),
        (1.0, 1.5, (1.33, 0.0), 400.0, 600.0, 45.0, 0.05199553),
        (1.0, 1.5, (0.213, 4.05), 200.0, 690.0, 0.0, 0.95536574),
        (1.0, 1.5, (0.213, 4.05), 200.0, 690.0, 70.0, 0.94118456),
        (1.0, 2.5, (1.5, 0.0), 100.0, 450.0, 80.0, 0.38974125),
        // Frustrated total reflection through a gap.
        (1.5, 1.0, (1.5, 0.0), 100.0, 550.0, 60.0, 0.63127563),
    ];
    for (above, film, (n, k), thickness, wavelength, angle, expected) in cases {
        let layer = LayerRecord {
            ior_n: [n / above; 3],
            ior_k: [k / above; 3],
            film_ior_n: [film / above; 3],
            film_ior_k: [0.0; 3],
            film_thickness_waves: [thickness * above / wavelength; 3],
            ..filmed()
        };
        let cos_theta = f64::to_radians(angle).cos();
        let found = f64::from(fresnel(&layer, cos_theta)[0]);
        assert!((found - expected).abs() < 5e-6, "{film} on {n} + {k}i at {angle}: {found}, expected {expected}");
    }
}

#[test]
fn fresnel_agrees_with_complex_amplitudes() {
    let indices = [
        (1.0, 0.0),
        (1.01, 0.0),
        (1.5, 0.0),
        (2.4, 0.0),
        (1.0 / 1.5, 0.0),
        (0.9, 1e-4),
        (1.5, 1e-3),
        (3.18, 4.41),
        (0.16, 3.9),
        (0.05, 0.01),
    ];
    for triple in indices.windows(3) {
        let layer = LayerRecord {
            ior_n: [triple[0].0, triple[1].0, triple[2].0],
            ior_k: [triple[0].1, triple[1].1, triple[2].1],
            ..clear()
        };
        for i in 0..=200 {
            let cos_theta = f64::from((1e-3 + f64::from(i) / 200.0 * (1.0 - 1e-3)) as f32);
            let found = fresnel(&layer, cos_theta);
            for (channel, &f) in found.iter().enumerate() {
                let (f, e) = (f64::from(f), paper::fresnel(&layer, channel, cos_theta));
                // At the critical angle the slope is infinite: half a bit of the index moves R by its square root.
                let n = layer.ior_n[channel];
                let is_critical = (cos_theta * cos_theta - (1.0 - n * n)).abs() < 1e-3;
                let tolerance = if is_critical { 2e-3 } else { 5e-6 };
                assert!(
                    (f - e).abs() < tolerance,
                    "{} + {}i at {cos_theta}: {f}, expected {e}",
                    n,
                    layer.ior_k[channel]
                );
            }
        }
    }
}

#[test]
fn distributions_are_normalised() {
    let [ggx, beckmann] =
        [("luthier_ggx", conductor(), 1.0), ("luthier_beckmann", dielectric(), std::f64::consts::LOG2_E)];
    for (name, layer, unit) in [ggx, beckmann] {
        let machine = full(&[material("sample", &[layer])]);
        for alpha in [1e-3, 0.02, 0.3, 1.0f64] {
            // The integral of D cos over the hemisphere, with tan^2 = alpha^2 s / (1 - s) as variable.
            const STEPS: u32 = 4000;
            let mut sum = 0.0;
            for i in 0..STEPS {
                let s = (f64::from(i) + 0.5) / f64::from(STEPS);
                let tan_sq = alpha * alpha * s / (1.0 - s);
                // Squares of a half vector of length 2.
                let [z_sq, across_sq] = [4.0, 4.0 * tan_sq].map(|square| square / (1.0 + tan_sq));
                let arguments = [unit / (alpha * alpha), z_sq, across_sq].map(|v| Value::F(v as f32)).to_vec();
                let value = f64::from(machine.call(name, arguments).floats()[0]);
                sum += value / ((1.0 + tan_sq) * (1.0 - s)).powi(2) / f64::from(STEPS);
            }
            assert!((sum - 1.0).abs() < 1e-4, "{name} alpha {alpha}: {sum}");
        }
    }
}

#[test]
fn every_unit_direction_gives_a_finite_value() {
    let mut materials = Vec::new();
    for alpha in [1e-3, 0.05, 1.0] {
        for eta in [0.5, 0.999, 1.0, 1.5, 2.4] {
            let n = [eta; 3];
            let top = LayerRecord { alpha, eta, ior_n: n, ..dielectric() };
            let middle = LayerRecord { alpha, eta: 1.0 / eta, ior_n: n.map(|n| 1.0 / n), ..filmed() };
            let base = LayerRecord { alpha, ..conductor() };
            let number = materials.len();
            materials.push(material(&format!("metal-{number}-a"), &[top.clone(), middle.clone(), base]));
            materials.push(material(&format!("paint-{number}-a"), &[middle, top, diffuse(0.7)]));
        }
    }
    let machine = full(&materials);
    let cosines = [1.0, 0.5, 1e-2, 1e-4, 1e-7, 1e-12, 1e-20, 1e-30, 1e-38, 1e-44, 0.0, -0.3];
    let turns = [0.0, 1e-7, 0.25, 0.5, 0.5 + 1e-7];
    for (number, material) in materials.iter().enumerate() {
        for ci in cosines {
            for co in cosines {
                for turn in turns {
                    let at = |cos: f64, turn: f64| {
                        let sin = (1.0 - cos * cos).sqrt();
                        // Half a turn is exactly opposite: the half vector vanishes at the horizon.
                        let y = if turn == 0.5 { 0.0 } else { sin * (TAU * turn).sin() };
                        [sin * (TAU * turn).cos(), y, cos]
                    };
                    let found = eval(&machine, number as u32, at(ci, 0.0), at(co, turn));
                    let is_lit = ci > 0.0 && co > 0.0;
                    let holds = found.iter().all(|v| v.is_finite() && *v >= 0.0 && (is_lit || *v == 0.0));
                    assert!(holds, "{} {ci} {co} {turn}: {found:?}", material.layers.len());
                }
            }
        }
    }
}

/// A texture whose channels are its own texel coordinates: what a look-up gives is the position that it read.
fn rulers(table: &TableFace) -> Image {
    let [width, height] = table.layout.size();
    let mut image = Image::zeros(width, height, 4);
    for y in 0..height {
        for x in 0..width {
            image.texel_mut(x, y).copy_from_slice(&[x as f32, y as f32, 0.0, 1.0]);
        }
    }
    image
}

#[test]
fn look_ups_read_where_the_layout_says() {
    let exponents = [0.125, 0.5, 1.7, 2.0, 4.0, 8.0];
    let mut mappings: Vec<Mapping> = exponents.iter().map(|&exponent| Mapping::Power { exponent }).collect();
    mappings.extend([0.025, 0.8].map(|bend| Mapping::Rational { bend }));
    mappings.extend([Mapping::Linear, Mapping::Logarithmic, Mapping::Periodic]);
    for mapping in mappings {
        for (columns, format) in [(1, TexelFormat::Rgba16Float), (3, TexelFormat::Rgba32Float)] {
            let mut tables = tables();
            for table in &mut tables {
                (table.layout.columns, table.layout.tiles, table.layout.apron) = (columns, 7, 1);
                table.format = format;
                for axis in std::iter::once(&mut table.layout.x).chain(&mut table.layout.y) {
                    *axis = remapped(axis, mapping);
                }
            }
            check_positions(&tables);
        }
    }
}

fn remapped(axis: &Axis, mapping: Mapping) -> Axis {
    let min = if mapping == Mapping::Logarithmic { axis.min.max(1e-3) } else { axis.min };
    Axis { mapping, min, ..axis.clone() }
}

fn check_positions(tables: &[TableFace]) {
    let mut materials = sets().pop().unwrap().1;
    materials[0].layers[0].tiles[TableKind::Escape] = Some(0);
    materials[0].layers[0].tiles[TableKind::Lobes] = Some(0);
    let set = MaterialSet::new(&materials, tables.to_vec());
    let textures: BTreeMap<_, _> = tables.iter().map(|t| (format!("luthier_{}", t.kind.name()), rulers(t))).collect();
    let text = emit(&set, Form::Baked, Target::Wgsl).unwrap();
    let machine = Machine::new(&text, &material_buffer(&materials), textures.clone());
    for table in tables {
        let is_periodic = table.layout.x.mapping == Mapping::Periodic;
        // Periodic axes are asked off the seam, where a rounding error is not a whole turn.
        let across = (0..=40).map(|i| if is_periodic { (f64::from(i) + 0.5) / 41.0 } else { f64::from(i) / 40.0 });
        for (i, x) in across.enumerate() {
            let (x, y) = (f64::from(x as f32), f64::from((0.01 + i as f32 * 0.618).fract()));
            for tile in [0, 2, 3, 6] {
                check_position(&machine, table, &textures, tile, [x, y]);
            }
        }
    }
}

/// One look-up against the layout of its table, read in f64.
fn check_position(machine: &Machine, table: &TableFace, textures: &BTreeMap<String, Image>, tile: u32, at: [f64; 2]) {
    let (name, [x, y]) = (table.kind.name(), at);
    let is_periodic = table.layout.x.mapping == Mapping::Periodic;
    let float = |v: f64| Value::F(v as f32);
    let (arguments, values) = match table.kind {
        TableKind::Distribution => {
            let (sin, cos) = (x * FRAC_PI_2).sin_cos();
            (vec![float(cos), float(sin * sin), float(y)], [x * FRAC_PI_2, y])
        }
        // A periodic axis repeats.
        TableKind::Thickness if is_periodic => (vec![vector(&[x as f32 - 1.0, y as f32 + 2.0])], at),
        TableKind::Thickness => (vec![vector(&[x as f32, y as f32])], at),
        TableKind::Fgd | TableKind::Film | TableKind::Escape => (vec![float(x), float(y)], at),
        // Nothing lies between its rows.
        TableKind::Lobes => {
            let rows = table.layout.y.as_ref().unwrap();
            let row = rows.node((y * f64::from(rows.intervals())).round() as u32);
            (vec![float(x), float(row)], [x, row])
        }
        TableKind::Fresnel | TableKind::Phase => (vec![float(x)], at),
    };
    let call = std::iter::once(Value::F(tile as f32)).chain(arguments).collect();
    let found = machine.call(&format!("luthier_lookup_{name}"), call).floats();
    let position = table.layout.position(tile, values);
    let expected = bilinear(&textures[&format!("luthier_{name}")], position, WeightBits::Exact);
    // The distribution gives one channel: of its ruler, the one across.
    let channels = if matches!(table.kind, TableKind::Distribution | TableKind::Escape) { 1 } else { 2 };
    for (f, e) in found.iter().zip(expected).take(channels) {
        assert!((f64::from(*f) - e).abs() < 4e-3, "tile {tile} at {at:?}: {found:?}, not {expected:?}: {table:?}");
    }
}
