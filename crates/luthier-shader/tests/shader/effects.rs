//! Flakes, patina, glitter and picks of surfaces in f32, run without a GPU, against their f64 twins in luthier-layers.

use std::collections::BTreeMap;
use std::f64::consts::TAU;

use glam::{DVec2, DVec3};
use luthier_layers::effects::flakes::Flakes;
use luthier_layers::effects::heterogeneous::{Map, Switch};
use luthier_layers::effects::patina::Patina;
use luthier_layers::frame::local;
use luthier_layers::monochrome::{Monochrome, MonochromeBelow, MonochromeLayer};
use luthier_layers::noise::perlin::Perlin;
use luthier_layers::noise::voronoi::Voronoi;
use luthier_manifest::{
    CellsRecord, FunctionGroup, LayerRecord, MapSlot, MaterialConstants, MaterialEntry, ParticlesRecord, ShadingModel,
    SurfaceEntry, SwitchBy, SwitchRecord, material_buffer,
};
use luthier_optics::stack::Surface;
use luthier_shader::{Form, MaterialSet, Target, emit};
use num_complex::Complex64;

use crate::features::with_map;
use crate::machine::{Machine, Value, vector};
use crate::scenes::{
    FLAKES, GLITTER, bumpy, conductor, dielectric, diffuse, flaked, glitter, material, patina, tables, weighted,
    weighted_film,
};

/// Sines, logarithms and square roots of f32, a few operations deep.
const NORMAL_TOLERANCE: f64 = 2e-6;

/// Tolerance of f cos_theta_i: directions in f32 are off by 6e-8, 3e-6 of the width of the narrowest lobe, plus rounding; tilted normals
/// add [`NORMAL_TOLERANCE`] over that width.
const EVAL_TOLERANCE: f64 = 3e-4;
const FLOOR: f64 = 1e-3;

/// Members of `LuthierPlace` in a set without Granier's model.
const FLAKE_NORMAL: usize = 4;
const PATINA: usize = 4;
const SLAB_FACTOR: usize = 2;

fn machine(materials: &[MaterialEntry]) -> Machine {
    let set = MaterialSet::new(materials, Vec::new());
    Machine::new(&emit(&set, Form::Full, Target::Wgsl).unwrap(), &material_buffer(materials), BTreeMap::new())
}

/// Points that fill the unit square evenly (R2 sequence), as f32 holds them.
fn points(count: u32) -> impl Iterator<Item = DVec2> {
    (0..count).map(|i| {
        let at = |a: f64| f64::from((0.5 + a * f64::from(i)).fract() as f32);
        DVec2::new(at(0.754_877_666_246_692_7), at(0.569_840_290_998_053_3))
    })
}

/// Pairs of directions as f32 holds them, half of them near mirror directions.
fn directions(count: u32) -> impl Iterator<Item = (DVec3, DVec3)> {
    points(count).zip(points(2 * count).skip(count as usize)).enumerate().map(|(i, (a, b))| {
        let wi = direction(0.05 + 0.95 * a.x, TAU * a.y);
        let near = (0.05 + 0.95 * a.x + 0.1 * (b.x - 0.5)).clamp(0.05, 1.0);
        let wo = if i % 2 == 0 { direction(0.05 + 0.95 * b.x, TAU * b.y) } else { direction(near, TAU * (a.y + 0.5)) };
        (wi, wo)
    })
}

fn direction(cos_theta: f64, phi: f64) -> DVec3 {
    let sin = (1.0 - cos_theta * cos_theta).sqrt();
    DVec3::new(sin * phi.cos(), sin * phi.sin(), cos_theta).as_vec3().as_dvec3().normalize()
}

fn single(v: DVec3) -> Value {
    vector(&v.as_vec3().to_array())
}

fn pair(v: DVec2) -> Value {
    vector(&v.as_vec2().to_array())
}

fn vec3(value: &Value) -> DVec3 {
    DVec3::from_slice(&value.floats().iter().map(|&v| f64::from(v)).collect::<Vec<_>>())
}

fn flakes() -> Flakes {
    let luthier_manifest::FlakesRecord { seed, count, tiling, spread, scale, fade_start } = FLAKES;
    Flakes { seed, count, tiling, spread, scale, fade_start }
}

/// Whether a coordinate is far enough from the edges of the cells that f32 finds the same cell.
fn is_inside(x: f64, cells: f64) -> bool {
    let t = (x * cells).fract();
    (0.01..0.99).contains(&t)
}

fn places() -> impl Iterator<Item = DVec2> {
    let cells = FLAKES.tiling * f64::from(FLAKES.count);
    points(4000).filter(move |uv| is_inside(uv.x, cells) && is_inside(uv.y, cells))
}

#[test]
fn flakes_are_those_of_f64() {
    let machine = machine(&[flaked()]);
    let mut worst = 0.0f64;
    for uv in places() {
        let found = vec3(&machine.call("luthier_flake", vec![Value::U(0), pair(uv)]));
        worst = worst.max((found - flakes().flake(uv)).length());
        for distance in [0.0, 1.5, 3.0, 100.0f32] {
            let arguments = vec![Value::U(0), pair(uv), Value::F(distance)];
            let found = vec3(&machine.call("luthier_flake_normal", arguments));
            worst = worst.max((found - flakes().normal(uv, f64::from(distance))).length());
        }
    }
    assert!(worst < NORMAL_TOLERANCE, "{worst}");
    // Negative coordinates repeat.
    let uv = DVec2::new(-0.734_2, -2.116_7);
    let found = vec3(&machine.call("luthier_flake", vec![Value::U(0), pair(uv)]));
    assert!((found - flakes().flake(uv)).length() < NORMAL_TOLERANCE);
}

#[test]
fn materials_without_an_effect_stay_as_they_are() {
    let materials = [flaked(), patina(), glitter()];
    let machine = machine(&materials);
    for uv in points(50) {
        let arguments = vec![Value::U(1), pair(uv), Value::F(1.0)];
        assert_eq!(vec3(&machine.call("luthier_flake_normal", arguments)), DVec3::Z);
        let arguments = vec![Value::U(1), single(DVec3::X), Value::F(1.0)];
        assert_eq!(vec3(&machine.call("luthier_flake_tilt", arguments)), DVec3::Z);
        assert_eq!(vec3(&machine.call("luthier_glitter_normal", vec![Value::U(0), pair(uv)])), DVec3::Z);
    }
    let amount = machine.call("luthier_patina_amount", vec![Value::U(0), Value::F(0.0)]);
    assert_eq!(amount, Value::F(-1.0));
}

/// The numbers of a cell follow from an integer hash: they are equal, not near.
#[test]
fn cells_and_their_numbers_are_exactly_those_of_f64() {
    let machine = machine(&[glitter()]);
    let mut compared = 0;
    for seed in [0, 1, 77, u32::MAX] {
        let map = Voronoi { seed, frequency: 1.0 };
        for p in points(300).map(|p| (20.0 * p - 10.0).as_vec2().as_dvec2()) {
            let cell = map.cell(p);
            // Where two points are as near in f32, either will do.
            let near = |d: DVec2| map.cell(p + d) == cell;
            if ![DVec2::X, DVec2::NEG_X, DVec2::Y, DVec2::NEG_Y].iter().all(|&d| near(1e-4 * d)) {
                continue;
            }
            compared += 1;
            let Value::U(word) = machine.call("luthier_voronoi", vec![Value::U(seed), pair(p)]) else { panic!() };
            for index in 0..4 {
                let found = machine.call("luthier_unit", vec![Value::U(word), Value::U(index + 2)]);
                assert_eq!(found, Value::F(cell.number(index) as f32), "{seed} {p}");
                assert_eq!(f64::from(cell.number(index) as f32), cell.number(index));
            }
        }
    }
    assert!(compared > 1100, "{compared}");
}

#[test]
fn glitter_is_that_of_f64() {
    let machine = machine(&[glitter()]);
    let cells = Voronoi { seed: GLITTER.seed, frequency: GLITTER.frequency };
    let map = Map::Glitter {
        cells,
        stacks: vec![1],
        filled: GLITTER.filled,
        tilt: GLITTER.tilt,
        under: Box::new(Map::Uniform(0)),
    };
    let mut tilted = 0;
    for uv in points(1500) {
        let apart = |d: DVec2| cells.cell(uv + 1e-5 * d) == cells.cell(uv);
        if ![DVec2::X, DVec2::NEG_X, DVec2::Y, DVec2::NEG_Y].iter().all(|&d| apart(d)) {
            continue;
        }
        let pick = map.pick(uv);
        tilted += pick.stack;
        let found = vec3(&machine.call("luthier_glitter_normal", vec![Value::U(0), pair(uv)]));
        assert!((found - pick.normal).length() < NORMAL_TOLERANCE, "{uv}: {found} {}", pick.normal);
    }
    assert!((300..600).contains(&tilted), "{tilted}");
}

/// Materials by number are equal, normals near. The other languages take the functions, too.
#[test]
fn picks_of_surfaces_are_those_of_f64() {
    let record = |seed, frequency, materials: &[u32]| CellsRecord { seed, frequency, materials: materials.to_vec() };
    let entry = |name: &str, cells: CellsRecord, glitter: Option<ParticlesRecord>| SurfaceEntry {
        name: name.to_owned(),
        source: String::new(),
        source_hash: String::new(),
        cells,
        switches: Vec::new(),
        glitter,
    };
    let glitter = ParticlesRecord { cells: record(u32::MAX, 25.0, &[2, 0]), filled: 0.3, tilt: 0.4 };
    let surfaces = [
        entry("flat-7", record(5, 12.0, &[0, 1, 1]), None),
        entry("granite", record(6, 9.5, &[1, 2, 0]), Some(glitter.clone())),
    ];
    let layers = [&[conductor()][..], &[dielectric(), diffuse(0.0)], &[diffuse(0.0)]];
    let materials: Vec<MaterialEntry> =
        layers.iter().enumerate().map(|(i, layers)| material(&format!("m-{i}-x"), layers)).collect();
    let set = MaterialSet { surfaces: &surfaces, ..MaterialSet::new(&materials, Vec::new()) };
    for target in Target::TEXT {
        let text = emit(&set, Form::Full, target).unwrap();
        assert!(text.contains("luthier_pick(") && text.contains("LUTHIER_SURFACE_FLAT_7_ID"), "{target}");
    }
    let wgsl = emit(&set, Form::Full, Target::Wgsl).unwrap();
    let machine = Machine::new(&wgsl, &material_buffer(&materials), BTreeMap::new());
    let voronoi = |cells: &CellsRecord| Voronoi { seed: cells.seed, frequency: cells.frequency };
    let cells = |cells: &CellsRecord| Map::Cells {
        cells: voronoi(cells),
        stacks: cells.materials.iter().map(|&i| i as usize).collect(),
    };
    let maps = [
        cells(&surfaces[0].cells),
        Map::Glitter {
            cells: voronoi(&glitter.cells),
            stacks: vec![2, 0],
            filled: glitter.filled,
            tilt: glitter.tilt,
            under: Box::new(cells(&surfaces[1].cells)),
        },
    ];
    let (mut counts, mut tilted) = ([[0; 3]; 2], 0);
    for (number, map) in maps.iter().enumerate() {
        for uv in points(1500).map(|uv| (4.0 * uv - 2.0).as_vec2().as_dvec2()) {
            let pick = map.pick(uv);
            let near = |d: DVec2| map.pick(uv + 1e-5 * d) == pick;
            if ![DVec2::X, DVec2::NEG_X, DVec2::Y, DVec2::NEG_Y].iter().all(|&d| near(d)) {
                continue;
            }
            let found = machine.call("luthier_pick", vec![Value::U(number as u32), pair(uv)]);
            let found = found.members();
            assert_eq!(found[0], Value::U(pick.stack as u32), "{number} {uv}");
            assert!((vec3(&found[1]) - pick.normal).length() < NORMAL_TOLERANCE, "{number} {uv}: {found:?}");
            counts[number][pick.stack] += 1;
            tilted += usize::from(pick.normal.z < 1.0);
        }
    }
    let [[a, b, c], granite] = counts;
    assert!(
        (350..650).contains(&a) && (850..1150).contains(&b) && c == 0 && granite.iter().all(|n| *n > 300),
        "{counts:?}"
    );
    assert!((350..550).contains(&tilted), "{tilted}");
}

/// Rounding of f32 over lattice coordinates of up to 50 in the last octave: gradients of up to 5.2 a cell, and a few operations.
const NOISE_TOLERANCE: f64 = 2e-5;

/// Veins, patches and tiles, in the order of the file. Places near an edge of any of them are left out, because rounding decides there.
#[test]
fn switches_of_surfaces_are_those_of_f64() {
    let cells = |seed, frequency, materials: &[u32]| CellsRecord { seed, frequency, materials: materials.to_vec() };
    let vein = Perlin { seed: 9, frequency: 2.5, octaves: 4 };
    let patch = Perlin { seed: u32::MAX, frequency: 1.5, octaves: 2 };
    let ranges = [[-0.06, 0.06], [0.2, 1.0]];
    let tiles = Voronoi { seed: 7, frequency: 3.0 };
    let noise =
        |Perlin { seed, frequency, octaves }: Perlin, between| SwitchBy::Noise { seed, frequency, octaves, between };
    let entry = SurfaceEntry {
        name: "veined".to_owned(),
        source: String::new(),
        source_hash: String::new(),
        cells: cells(5, 12.0, &[0]),
        switches: vec![
            SwitchRecord { by: noise(vein, ranges[0]), cells: cells(6, 20.0, &[1, 2]) },
            SwitchRecord { by: noise(patch, ranges[1]), cells: cells(7, 20.0, &[2]) },
            SwitchRecord {
                by: SwitchBy::Tiles { seed: tiles.seed, frequency: tiles.frequency, share: 0.5 },
                cells: cells(8, 20.0, &[3]),
            },
        ],
        glitter: None,
    };
    let materials: Vec<MaterialEntry> = (0..4).map(|i| material(&format!("m-{i}-x"), &[conductor()])).collect();
    let set = MaterialSet { surfaces: std::slice::from_ref(&entry), ..MaterialSet::new(&materials, Vec::new()) };
    for target in Target::TEXT {
        assert!(emit(&set, Form::Full, target).unwrap().contains("luthier_perlin("), "{target}");
    }
    let wgsl = emit(&set, Form::Full, Target::Wgsl).unwrap();
    let machine = Machine::new(&wgsl, &material_buffer(&materials), BTreeMap::new());
    let map = |seed, stacks: &[usize]| {
        Box::new(Map::Cells { cells: Voronoi { seed, frequency: 20.0 }, stacks: stacks.to_vec() })
    };
    let switch = |switch, inside, outside| Box::new(Map::Switch { switch, inside, outside });
    let of_noise = |noise, between| Switch::Noise { noise, between };
    let tiled = switch(Switch::Tiles { cells: tiles, share: 0.5 }, map(8, &[3]), map(5, &[0]));
    let patched = switch(of_noise(patch, ranges[1]), map(7, &[2]), tiled);
    let map = switch(of_noise(vein, ranges[0]), map(6, &[1, 2]), patched);

    let (mut counts, mut compared, mut worst) = ([0; 4], 0, 0.0f64);
    for uv in points(1500).map(|uv| (4.0 * uv - 2.0).as_vec2().as_dvec2()) {
        let mut is_near_edge = false;
        for (noise, range) in [vein, patch].into_iter().zip(ranges) {
            let Perlin { seed, frequency, octaves } = noise;
            let place = pair(uv * frequency);
            let Value::F(found) = machine.call("luthier_perlin", vec![Value::U(seed), place, Value::U(octaves)]) else {
                panic!()
            };
            let expected = noise.at(uv);
            worst = worst.max((f64::from(found) - expected).abs());
            is_near_edge |= range.iter().any(|end| (expected - end).abs() < NOISE_TOLERANCE);
        }
        let pick = map.pick(uv);
        let near = |d: DVec2| map.pick(uv + 1e-5 * d) == pick;
        if is_near_edge || ![DVec2::X, DVec2::NEG_X, DVec2::Y, DVec2::NEG_Y].iter().all(|&d| near(d)) {
            continue;
        }
        compared += 1;
        let found = machine.call("luthier_pick", vec![Value::U(0), pair(uv)]);
        let found = found.members();
        assert_eq!(found[0], Value::U(pick.stack as u32), "{uv}");
        assert_eq!(vec3(&found[1]), DVec3::Z, "{uv}");
        counts[pick.stack] += 1;
    }
    assert!(worst < NOISE_TOLERANCE, "{worst:e}");
    assert!(compared > 1450 && counts.iter().all(|count| *count > 100), "{compared}: {counts:?}");
}

/// The layers at one of the three wavelengths. Every coat has one index.
fn monochrome(layers: &[LayerRecord], channel: usize) -> Monochrome {
    let mut above = 1.0;
    let layers = layers
        .iter()
        .map(|record| {
            let distribution = record.distribution;
            let surface = Surface::isotropic(distribution, record.alpha);
            let ior = above * Complex64::new(record.ior_n[channel], record.ior_k[channel]);
            let below = match record.kind {
                luthier_manifest::LayerKind::Dielectric => MonochromeBelow::Dielectric {
                    ior: ior.re,
                    complex_ior: ior,
                    optical_depth: record.optical_depth[channel],
                },
                _ => MonochromeBelow::Conductor { ior },
            };
            let layer = MonochromeLayer { surface, above, films: Vec::new(), below, f0: None };
            above = ior.re;
            layer
        })
        .collect();
    Monochrome { exterior: 1.0, layers }
}

fn with(place: &Value, member: usize, value: Value) -> Value {
    let mut place = place.clone();
    place.members_mut()[member] = value;
    place
}

fn error(found: &Value, expected: [f64; 3]) -> f64 {
    let found = found.floats();
    (0..3).map(|c| (f64::from(found[c]) - expected[c]).abs() / expected[c].max(FLOOR)).fold(0.0, f64::max)
}

#[test]
fn flakes_tilt_what_is_below_as_in_f64() {
    let material = flaked();
    let machine = machine(std::slice::from_ref(&material));
    let neutral = machine.call("luthier_place", Vec::new());
    let (mut worst, mut changed) = (0.0f64, 0);
    for (uv, (wi, wo)) in places().zip(directions(3000)) {
        let normal = machine.call("luthier_flake_normal", vec![Value::U(0), pair(uv), Value::F(3.0)]);
        let place = with(&neutral, FLAKE_NORMAL, normal);
        let call =
            |place: &Value| machine.call("luthier_eval_at", vec![place.clone(), Value::U(0), single(wi), single(wo)]);
        let found = call(&place);
        let expected = [0, 1, 2].map(|c| flakes().eval(&monochrome(&material.layers, c), uv, 3.0, wi, wo));
        worst = worst.max(error(&found, expected));
        changed += usize::from(error(&call(&neutral), expected) > 0.05);
    }
    assert!(worst < EVAL_TOLERANCE, "{worst}");
    assert!(changed > 500, "{changed}");
}

/// Flakes turn the frame in which the metal has its own normal. Oracle: the metal with the normal that both give it in the frame of the place. Bumps take light
/// by its cosine to them, and flakes do not.
#[test]
fn own_normals_are_in_the_frame_of_flakes() {
    for model in [ShadingModel::Elek, ShadingModel::WeidlichWilkie] {
        let mut material = bumpy(MaterialEntry { model, ..flaked() });
        material.layers[0].optical_depth = [0.0; 3];
        let machine = machine(&[material]);
        let neutral = machine.call("luthier_place", Vec::new());
        let mut changed = 0;
        for (i, (wi, wo)) in directions(1500).enumerate() {
            let leaning = |x: f64, y: f64| DVec3::new(x, y, 1.0).normalize().as_vec3().as_dvec3().normalize();
            let t = 0.001 * i as f64;
            let (flake, own) = (leaning(0.2 - t % 0.3, 0.1), leaning(-0.1, t % 0.4 - 0.2));
            let both = local(DVec3::new(-flake.x, -flake.y, flake.z), own);
            let below = |w: DVec3| DVec3::new(w.x / 1.5, w.y / 1.5, (1.25 + w.z * w.z).sqrt() / 1.5);
            let [light, eye] = [wi, wo].map(below);
            if [light, eye].iter().any(|w| w.dot(flake) < 0.05 || w.dot(both) < 0.05) {
                continue;
            }
            let at = |flake: DVec3, metal: DVec3| {
                let mut place = with(&neutral, FLAKE_NORMAL, single(flake));
                let layers = place.members_mut().last_mut().unwrap();
                layers.members_mut()[1].members_mut()[0] = single(metal);
                let value = machine.call("luthier_eval_at", vec![place, Value::U(0), single(wi), single(wo)]);
                vec3(&value)
            };
            // A metal that turns away shows the coat alone.
            let first = at(DVec3::Z, DVec3::NEG_Z);
            let found = at(flake, own);
            let expected = first + (at(DVec3::Z, both) - first) * (light.z / light.dot(flake));
            let apart = ((found - expected).abs() / expected.max(DVec3::splat(FLOOR))).max_element();
            assert!(apart < EVAL_TOLERANCE, "{model:?} {wi} {wo} {flake} {own}: {found} {expected}");
            changed += usize::from((at(flake, DVec3::Z) - expected).length() > 0.05 * expected.length());
        }
        assert!(changed > 300, "{changed}");
    }
}

#[test]
fn patina_is_that_of_f64() {
    let material = patina();
    let machine = machine(&[material.clone(), flaked()]);
    let neutral = machine.call("luthier_place", Vec::new());
    let record = material.constants.patina.clone().unwrap();
    let twin = |c: usize| Patina {
        extent: record.extent,
        transition: record.transition,
        diffuse_albedo: record.diffuse_albedo[c],
        base_alpha: record.base_alpha,
        tarnish: record.tarnish[c],
    };
    let mut worst = 0.0f64;
    for (i, (wi, wo)) in directions(600).enumerate() {
        let map = f64::from((i % 9) as f32 / 8.0);
        let amount = machine.call("luthier_patina_amount", vec![Value::U(0), Value::F(map as f32)]);
        assert!((f64::from(amount.floats()[0]) - twin(0).amount(map)).abs() < 1e-6);
        // The set has flakes too: patina comes after their normal.
        let place = with(&neutral, PATINA + 1, amount);
        let found = machine.call("luthier_eval_at", vec![place, Value::U(0), single(wi), single(wo)]);
        let expected = [0, 1, 2].map(|c| twin(c).eval(&monochrome(&material.layers, c), map, wi, wo));
        worst = worst.max(error(&found, expected));
    }
    assert!(worst < EVAL_TOLERANCE, "{worst}");
}

/// A step at transition 0, on either side and on its edge.
#[test]
fn patina_without_transition_is_a_step() {
    let mut material = patina();
    let record = material.constants.patina.as_mut().unwrap();
    (record.extent, record.transition) = (0.5, 0.0);
    let machine = machine(&[material]);
    for (map, expected) in [(0.0, 1.0), (0.5, 1.0), (0.500_001, 0.0), (1.0, 0.0f32)] {
        assert_eq!(machine.call("luthier_patina_amount", vec![Value::U(0), Value::F(map)]), Value::F(expected));
    }
}

/// The value at a weight is the mean of those of two sets, one with the layers and one with those below the first. Other materials of a set change nothing.
#[test]
fn a_weight_is_the_share_of_the_first_layer() {
    for model in [ShadingModel::Elek, ShadingModel::WeidlichWilkie] {
        let of = |material: MaterialEntry| MaterialEntry { model, ..material };
        let coated = of(weighted());
        let bare = coated.constants.bare().unwrap().clone();
        let whole = MaterialEntry { constants: MaterialConstants::default(), ..coated.clone() };
        let [whole, bare] = [whole, of(material("bare", &[bare]))].map(|material| machine(&[material]));
        for (materials, number) in [(vec![coated.clone()], 0), (vec![flaked(), of(patina()), coated.clone()], 2)] {
            let machine = machine(&materials);
            let neutral = machine.call("luthier_place", Vec::new());
            for (i, (wi, wo)) in directions(300).enumerate() {
                // Products beyond 1 count as 1.
                let factor = [0.0, 0.5, 1.0, 1.25, 3.0_f64][i % 5];
                let mut place = neutral.clone();
                *place.members_mut().last_mut().unwrap() = Value::F(factor as f32);
                let found = machine.call("luthier_eval_at", vec![place, Value::U(number), single(wi), single(wo)]);
                let arguments = |number| vec![Value::U(number), single(wi), single(wo)];
                let [all, below] = [&whole, &bare].map(|machine| machine.call("luthier_eval", arguments(0)).floats());
                let mean =
                    |weight: f64| [0, 1, 2].map(|c| weight * f64::from(all[c]) + (1.0 - weight) * f64::from(below[c]));
                assert!(error(&found, mean((0.6 * factor).min(1.0))) < 1e-5, "{model:?} {factor} {wi} {wo}");
                let plain = machine.call("luthier_eval", arguments(number));
                assert!(error(&plain, mean(0.6)) < 1e-5, "{model:?} {wi} {wo}");
            }
        }
    }
}

/// The value at the weight of a film is the mean of those of two sets, one with the film and one without it. Other materials of a set change nothing.
#[test]
fn a_weight_of_a_film_is_the_share_of_the_film() {
    for model in [ShadingModel::Elek, ShadingModel::WeidlichWilkie] {
        let mut coated = MaterialEntry { model, ..weighted_film() };
        coated.layers[0].optical_depth = [0.1, 0.3, 0.6];
        coated.constants.bare_mut().unwrap().optical_depth = [0.1, 0.3, 0.6];
        let whole = MaterialEntry { constants: MaterialConstants::default(), ..coated.clone() };
        let mut bare = whole.clone();
        bare.layers[0] = coated.constants.bare().unwrap().clone();
        let of = |material: MaterialEntry| MaterialEntry { model, ..material };
        // A map, so that both have places.
        let [whole, bare] = [whole, bare].map(|material| machine(&[with_map(material, MapSlot::Thickness, 0)]));
        for (materials, number) in
            [(vec![coated.clone()], 0), (vec![of(flaked()), of(weighted()), of(patina()), coated.clone()], 3)]
        {
            let machine = machine(&materials);
            let neutral = machine.call("luthier_place", Vec::new());
            for (i, (wi, wo)) in directions(300).enumerate() {
                let factor = [0.0, 0.5, 1.0, 1.25, 3.0_f64][i % 5];
                let slab = 0.1 * (i % 7) as f32;
                let mut place = with(&neutral, SLAB_FACTOR, Value::F(slab));
                *place.members_mut().last_mut().unwrap() = Value::F(factor as f32);
                let at = |machine: &Machine, place: &Value, number| {
                    machine.call("luthier_eval_at", vec![place.clone(), Value::U(number), single(wi), single(wo)])
                };
                let [all, without] = [&whole, &bare].map(|machine| {
                    let place = with(&machine.call("luthier_place", Vec::new()), SLAB_FACTOR, Value::F(slab));
                    at(machine, &place, 0).floats()
                });
                let weight = (0.6 * factor).min(1.0);
                let mean = [0, 1, 2].map(|c| weight * f64::from(all[c]) + (1.0 - weight) * f64::from(without[c]));
                assert!(error(&at(&machine, &place, number), mean) < 1e-5, "{model:?} {factor} {wi} {wo}");
            }
        }
    }
}

/// Every model of the group `surface` that reads a diffuse base shows another colour of it as the material of that albedo.
#[test]
fn a_base_color_is_the_albedo_of_the_base() {
    let color = [0.1, 0.5, 0.9];
    for model in [ShadingModel::Elek, ShadingModel::WeidlichWilkie, ShadingModel::Belcour, ShadingModel::Microfacet] {
        let coats = if model == ShadingModel::Microfacet { vec![] } else { vec![dielectric()] };
        let over = |base: LayerRecord| {
            let layers = [&coats[..], &[base]].concat();
            MaterialEntry { model, ..material("painted", &layers) }
        };
        let painted = LayerRecord { albedo: color, ..diffuse(0.4) };
        let [machine, expected] = [diffuse(0.4), painted].map(|base| {
            let materials = [over(base)];
            let functions = [FunctionGroup::Surface].into_iter().collect();
            let set = MaterialSet { functions, ..MaterialSet::new(&materials, Vec::new()) };
            Machine::new(&emit(&set, Form::Full, Target::Wgsl).unwrap(), &material_buffer(&materials), BTreeMap::new())
        });
        let neutral = machine.call("luthier_place", Vec::new());
        let mut moved = 0.0f64;
        for (wi, wo) in directions(100) {
            // After the normal, three factors and the variance.
            let place = with(&neutral, 5, vector(&color.map(|x| x as f32)));
            let found = machine.call("luthier_eval_at", vec![place, Value::U(0), single(wi), single(wo)]);
            let arguments = || vec![Value::U(0), single(wi), single(wo)];
            let own = expected.call("luthier_eval", arguments()).floats();
            assert!(error(&found, [0, 1, 2].map(|c: usize| f64::from(own[c]))) < 1e-5, "{model:?} {wi} {wo}");
            let plain = machine.call("luthier_eval", arguments()).floats();
            moved = moved.max((0..3).map(|c| f64::from(plain[c] - own[c]).abs()).fold(0.0, f64::max));
        }
        assert!(moved > 0.01, "{model:?}: {moved}");
    }
}

/// A material with effects is its layers at a place without textures.
#[test]
fn without_textures_only_the_layers_are_left() {
    for material in [flaked(), patina(), glitter()] {
        let plain = MaterialEntry { constants: luthier_manifest::MaterialConstants::default(), ..material.clone() };
        let [machine, plain] = [[material], [plain]].map(|m| machine(&m));
        for (wi, wo) in directions(200) {
            let eval = |machine: &Machine| machine.call("luthier_eval", vec![Value::U(0), single(wi), single(wo)]);
            let expected = eval(&plain).floats();
            let expected = [0, 1, 2].map(|c| f64::from(expected[c]));
            // Sums in another order: a few roundings.
            assert!(error(&eval(&machine), expected) < 1e-6, "{expected:?}");
        }
    }
}

#[test]
fn sets_without_effects_carry_no_word_of_them() {
    let words =
        ["flake", "patina", "glitter", "voronoi", "luthier_mix", "tarnish", "is_bare", "normal_below", "weight_factor"];
    let text =
        |materials: &[MaterialEntry], form| emit(&MaterialSet::new(materials, tables()), form, Target::Wgsl).unwrap();
    for form in Form::ALL {
        let plain = text(&[material("coated", &[dielectric(), conductor()])], form);
        let [flakes, patina, glitter] = [flaked(), patina(), glitter()].map(|m| text(&[m], form));
        let weight = text(&[weighted()], form);
        for word in
            ["flake_", "glitter_", "patina_amount", "patina_diffuse", "place.patina", "mix(vec3<f32>(1.0), tarnish"]
        {
            assert!(!weight.contains(word), "{word} in\n{weight}");
        }
        for word in words {
            assert!(!plain.contains(word), "{word}");
        }
        for (one, others) in [(&flakes, ["patina(", "glitter_"]), (&patina, ["flake_", "glitter_"])] {
            for word in others {
                assert!(!one.contains(word), "{word} in\n{one}");
            }
        }
        assert!(!glitter.contains("flake_") && !glitter.contains("luthier_patina"));
    }
}
