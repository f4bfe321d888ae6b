//! Belcour's and Yamaguchi's shaders, run in f32 without a GPU, against the same formulas in f64.

use std::collections::BTreeMap;
use std::f64::consts::TAU;

use glam::DVec3;
use luthier_layers::layers::{Below, Layer, Layers};
use luthier_layers::models::statistics::diffuse_base::{DiffuseBase, Veil};
use luthier_layers::models::statistics::energy::Energy;
use luthier_layers::models::statistics::evaluate::{Follow, evaluate};
use luthier_layers::models::statistics::spread::Covariance;
use luthier_lut::{AtlasLayout, Image, TableKind, WeightBits, bilinear};
use luthier_manifest::{LayerKind, LayerRecord, MapSlot, MaterialEntry, ShadingModel, material_buffer};
use luthier_optics::fresnel::{FilmLayer, coated};
use luthier_optics::stack::{Distribution, Surface};
use luthier_shader::{Form, MaterialSet, Target, emit};
use num_complex::Complex64;

use crate::arithmetic::{direction, directions, eval, full};
use crate::features::with_map;
use crate::machine::{Machine, Value, vector};
use crate::scenes::{clear, conductor, dielectric, diffuse, filmed, material, sets, tables, with_escape};

/// The stack that a material's records describe.
fn layers(material: &MaterialEntry) -> Layers<3> {
    let mut above = 1.0;
    let layer = |record: &LayerRecord| {
        let [alpha_x, alpha_y] = record.alpha_xy;
        let surface = Surface { distribution: Distribution::Ggx, alpha_x, alpha_y, rotation: record.rotation };
        let ior = above * record.eta;
        let below = match record.kind {
            LayerKind::Dielectric => Below::Dielectric { ior, optical_depth: record.optical_depth },
            LayerKind::Conductor => Below::Conductor,
            LayerKind::Diffuse => Below::Diffuse { albedo: record.albedo, sigma: record.sigma },
        };
        let layer = Layer { surface, above, below };
        above = ior;
        layer
    };
    Layers { exterior: 1.0, layers: material.layers.iter().map(layer).collect() }
}

/// Level facets, as the form without tables has them.
struct LevelFacets<'a>(&'a MaterialEntry);

impl Energy<3> for LevelFacets<'_> {
    fn fgd(&self, layer: usize, cos_theta_i: f64, _: f64) -> [f64; 3] {
        let record = &self.0.layers[layer];
        [0, 1, 2].map(|c: usize| {
            let film = FilmLayer {
                ior: Complex64::new(record.film_ior_n[c], record.film_ior_k[c]),
                waves: record.film_thickness_waves[c],
            };
            let films = if record.film_ior_n[c] > 0.0 { vec![film] } else { Vec::new() };
            let below = Complex64::new(record.ior_n[c], record.ior_k[c]);
            coated(Complex64::new(1.0, 0.0), &films, below, cos_theta_i).unpolarised()
        })
    }

    fn escaping(&self, _: usize, _: f64, _: f64, _: f64) -> f64 {
        1.0
    }
}

/// Energies read from textures as the shader reads them.
struct Read<'a> {
    material: &'a MaterialEntry,
    fgd: (AtlasLayout, Image),
    escape: (AtlasLayout, Image),
}

impl Read<'_> {
    fn at((layout, image): &(AtlasLayout, Image), tile: u32, values: [f64; 2]) -> [f64; 3] {
        let [r, g, b, _] = bilinear(image, layout.position(tile, values), WeightBits::Exact);
        [r, g, b]
    }
}

impl Energy<3> for Read<'_> {
    fn fgd(&self, layer: usize, cos_theta_i: f64, alpha: f64) -> [f64; 3] {
        Self::at(&self.fgd, self.material.layers[layer].tiles[TableKind::Fgd].unwrap(), [cos_theta_i, alpha])
    }

    fn escaping(&self, layer: usize, cos_theta_i: f64, alpha: f64, eta: f64) -> f64 {
        let sin_sq = (1.0 - cos_theta_i * cos_theta_i) / (eta * eta);
        let tile = self.material.layers[layer].tiles[TableKind::Escape];
        tile.map_or(1.0, |tile| Self::at(&self.escape, tile, [(1.0 - sin_sq).max(0.0).sqrt(), alpha])[0])
    }
}

/// An atlas of any tiles whose values are smooth functions of the axes: `f(tile, x, y)`.
fn filled(kind: TableKind, f: impl Fn(u32, f64, f64) -> [f64; 4]) -> (AtlasLayout, Image) {
    let layout = tables().into_iter().find(|t| t.kind == kind).unwrap().layout;
    let [width, height] = layout.size();
    let mut image = Image::zeros(width, height, 4);
    let y_axis = layout.y.clone().unwrap();
    for tile in 0..layout.tiles {
        let [x0, y0] = layout.origin(tile);
        for j in 0..y_axis.size {
            for i in 0..layout.x.size {
                let value = f(tile, layout.x.node(i), y_axis.node(j)).map(|v| v as f32);
                image.texel_mut(x0 + i, y0 + j).copy_from_slice(&value);
            }
        }
    }
    (layout, image)
}

/// Albedos between those of glass and those of metals; tile 4 is white.
fn albedos() -> (AtlasLayout, Image) {
    filled(TableKind::Fgd, |tile, cos, alpha| {
        let normal = [0.04, 0.9, 0.06, 0.08, 1.0, 0.5][tile as usize];
        let grazing = (1.0 - cos).powi(5) * (1.0 - 0.5 * alpha);
        let value = |tint: f64| normal * (1.0 - tint) + (1.0 - normal * (1.0 - tint)) * grazing;
        let tint = if tile == 4 { 0.0 } else { 0.1 };
        [value(0.0), value(tint), value(3.0 * tint), 1.0]
    })
}

fn shares() -> (AtlasLayout, Image) {
    filled(TableKind::Escape, |_, cos, alpha| [1.0 - 0.5 * alpha * (1.0 - 0.5 * cos), 0.0, 0.0, 1.0])
}

fn baked(materials: &[MaterialEntry], more: &str) -> Machine {
    let set = MaterialSet::new(materials, tables());
    let text = emit(&set, Form::Baked, Target::Wgsl).unwrap() + more;
    let textures = [("luthier_fgd", albedos().1), ("luthier_escape", shares().1)];
    let textures: BTreeMap<_, _> = textures.map(|(name, image)| (name.to_owned(), image)).into();
    Machine::new(&text, &material_buffer(materials), textures)
}

fn twin(material: &MaterialEntry, energy: &impl Energy<3>, wi: [f64; 3], wo: [f64; 3]) -> [f64; 3] {
    let stack = layers(material);
    let constants = &material.constants;
    let veil = Veil { internal: constants.internal_reflectance, upward: [1.0 - constants.upward_loss; 3] };
    let base = DiffuseBase::veiled(&stack, veil);
    let [wi, wo] = [wi, wo].map(DVec3::from_array);
    match material.model {
        ShadingModel::Belcour => evaluate::<f64, 3>(&stack, energy, base.as_ref(), Follow::Eye, wi, wo),
        _ => evaluate::<Covariance, 3>(&stack, energy, base.as_ref(), Follow::Eye, wi, wo),
    }
}

/// The materials of the two models in all sets; bases have constants.
fn materials() -> Vec<MaterialEntry> {
    let is_statistical = |m: &MaterialEntry| matches!(m.model, ShadingModel::Belcour | ShadingModel::Yamaguchi);
    let mut materials: Vec<_> =
        sets().into_iter().flat_map(|(_, materials)| materials).filter(is_statistical).collect();
    for (i, material) in materials.iter_mut().enumerate() {
        material.name = format!("m{i}-{}", material.name);
        if material.layers.len() > 1 {
            material.constants.internal_reflectance = [0.6, 0.5, 0.4];
            material.constants.upward_loss = 0.05;
        }
    }
    materials
}

/// Pairs of directions, also at grazing angles, up to 89.9 degrees.
fn all_directions() -> Vec<([f64; 3], [f64; 3])> {
    let grazing = (0..120).map(|i| {
        let cos = |k: u32| 0.0017 * 1.6f64.powi(((i * k) % 12) as i32);
        (direction(cos(1), 0.3), direction(cos(5), 0.3 + TAU / 2.0 + 0.01 * f64::from(i % 10)))
    });
    directions(300).chain(grazing).collect()
}

/// Largest relative error over all directions, of values above the floor.
fn compare(machine: &Machine, number: usize, material: &MaterialEntry, energy: &impl Energy<3>, tolerance: f64) -> f64 {
    const FLOOR: f64 = 1e-3;
    let mut worst = 0.0f64;
    for (wi, wo) in all_directions() {
        let expected = twin(material, energy, wi, wo);
        let found = eval(machine, number as u32, wi, wo);
        for (e, f) in expected.iter().zip(&found) {
            let error = (f64::from(*f) - e).abs() / e.abs().max(FLOOR);
            assert!(error < tolerance, "{}: {wi:?} {wo:?}: {found:?}, f64 {expected:?}", material.name);
            worst = worst.max(error);
        }
    }
    worst
}

/// Directions in f32 are off by 6e-8, 3e-6 of the width of the narrowest lobe here (alpha 0.02); powers of slopes and
/// their inverse on top, and fourth powers of both in D.
const TOLERANCE: f64 = 2e-4;

#[test]
fn both_forms_agree_with_the_same_formulas_in_f64() {
    let materials = materials();
    let (level, reading) = (full(&materials), baked(&materials, ""));
    let mut worst = [0.0f64; 2];
    for (number, material) in materials.iter().enumerate() {
        let errors = [
            compare(&level, number, material, &LevelFacets(material), TOLERANCE),
            compare(&reading, number, material, &Read { material, fgd: albedos(), escape: shares() }, TOLERANCE),
        ];
        worst = [0, 1].map(|k: usize| worst[k].max(errors[k]));
        eprintln!("{}: full {:.1e}, baked {:.1e}", material.name, errors[0], errors[1]);
    }
    eprintln!("largest relative error: full {:.1e}, baked {:.1e}", worst[0], worst[1]);
}

/// Coats of any index on a metal or a diffuse base, of one slope parameter or of very different ones along two tangents.
fn extremes() -> Vec<MaterialEntry> {
    let mut materials = Vec::new();
    for model in [ShadingModel::Belcour, ShadingModel::Yamaguchi] {
        for alpha in [1e-3, 0.05, 1.0] {
            for eta in [0.5, 0.999, 1.0, 1.5, 2.4] {
                let rough = |layer: LayerRecord, [x, y]: [f64; 2]| LayerRecord {
                    alpha: (x * y).sqrt(),
                    alpha_xy: [x, y],
                    rotation: 0.7,
                    ..layer
                };
                let coat = LayerRecord { eta, ior_n: [eta; 3], ..with_escape(dielectric()) };
                let under = LayerRecord { eta: 1.0 / eta, ior_n: [1.0 / eta; 3], ..with_escape(clear()) };
                let coats = [rough(coat, [alpha, 1.0]), rough(under, [alpha; 2])];
                for base in [rough(conductor(), [alpha; 2]), diffuse(0.7)] {
                    let name = format!("m{}-a", materials.len());
                    let layers = [&coats[..], &[base]].concat();
                    materials.push(MaterialEntry { model, ..material(&name, &layers) });
                }
            }
        }
    }
    materials
}

#[test]
fn every_unit_direction_gives_a_finite_value() {
    let materials = extremes();
    let machines = [full(&materials), baked(&materials, "")];
    let cosines = [1.0, 0.5, 1e-2, 1.7e-3, 1e-7, 1e-20, 1e-38, 1e-44, 0.0, -0.3];
    for (number, material) in materials.iter().enumerate() {
        for (ci, co) in cosines.into_iter().flat_map(|ci| cosines.map(|co| (ci, co))) {
            for turn in [0.0, 0.5, 0.5 + 1e-7] {
                let at = |cos: f64, turn: f64| {
                    let sin = (1.0 - cos * cos).sqrt();
                    // Half a turn is exactly opposite: the half vector vanishes at the horizon.
                    let y = if turn == 0.5 { 0.0 } else { sin * (TAU * turn).sin() };
                    [sin * (TAU * turn).cos(), y, cos]
                };
                for machine in &machines {
                    let found = eval(machine, number as u32, at(ci, 0.0), at(co, turn));
                    let is_lit = ci > 0.0 && co > 0.0;
                    let holds = found.iter().all(|v| v.is_finite() && *v >= 0.0 && (is_lit || *v == 0.0));
                    assert!(holds, "{:?} {ci} {co} {turn}: {found:?}", material.layers);
                }
            }
        }
    }
}

/// Lobes 0.06 degrees wide: directions are known to 6e-8, that is 1e-4 of their width.
#[test]
fn narrow_lobes_keep_their_shape() {
    for model in [ShadingModel::Belcour, ShadingModel::Yamaguchi] {
        let sharp = |layer: LayerRecord| LayerRecord { alpha: 1e-3, alpha_xy: [1e-3; 2], ..layer };
        let layers = [sharp(with_escape(clear())), sharp(conductor())];
        let materials = [MaterialEntry { model, ..material("sharp", &layers) }];
        let machine = full(&materials);
        for (wi, _) in directions(200) {
            for step in 0..6 {
                let wo = direction((wi[2] + 4e-4 * f64::from(step)).min(1.0), wi[1].atan2(wi[0]) + TAU / 2.0);
                let expected = twin(&materials[0], &LevelFacets(&materials[0]), wi, wo);
                let found = eval(&machine, 0, wi, wo);
                let error = (f64::from(found[0]) - expected[0]).abs() / expected[0].max(1e-3);
                assert!(error < 5e-3, "{model:?} {wi:?} {wo:?}: {found:?}, f64 {expected:?}");
            }
        }
    }
}

/// All lobes together carry no more than arrives, and all of it on a white base, on its way through f32.
#[test]
fn lobes_carry_no_more_than_arrives_and_all_of_it_on_a_white_base() {
    let white = || LayerRecord { tiles: conductor().tiles.with([(TableKind::Fgd, Some(4))]), ..conductor() };
    let coat = |layer: LayerRecord, alpha: f64| with_escape(LayerRecord { alpha, alpha_xy: [alpha; 2], ..layer });
    for model in [ShadingModel::Belcour, ShadingModel::Yamaguchi] {
        let of = |name: &str, layers: &[LayerRecord]| MaterialEntry { model, ..material(name, layers) };
        let materials: Vec<_> = [0.001, 0.3, 1.0]
            .into_iter()
            .enumerate()
            .flat_map(|(i, alpha)| {
                let lossless = [coat(clear(), alpha), coat(clear(), 0.2), white()];
                let absorbing = [coat(dielectric(), alpha), coat(dielectric(), 0.2), white()];
                [of(&format!("a{i}-lossless"), &lossless), of(&format!("b{i}-absorbing"), &absorbing)]
            })
            .collect();
        let name = format!("luthier_{}", model.name());
        let add = |i: u32| format!("path = {name}_add(path, luthier_layer(material, {i}u)); sum += path.lobe_energy;");
        let probe = format!(
            "fn probe(material: u32, cos_theta: f32) -> vec3<f32> {{ var path = {name}_start(cos_theta); \
             var sum = vec3<f32>(0.0); {} {} {} return sum; }}",
            add(0),
            add(1),
            add(2)
        );
        let machine = baked(&materials, &probe);
        // Rounding of three steps; where the series nearly diverges its denominator is a small difference.
        const ROUNDING: f32 = 4e-6;
        for number in 0..materials.len() {
            for cos in [1.0, 0.7, 0.3, 0.1, 0.01, 1e-4, 1e-7] {
                let sum = machine.call("probe", vec![Value::U(number as u32), Value::F(cos)]).floats();
                let is_lossless = number % 2 == 0;
                for value in &sum {
                    assert!(*value <= 1.0 + ROUNDING, "{cos}: {sum:?}");
                    assert!(!is_lossless || (value - 1.0).abs() < ROUNDING, "{cos}: {sum:?}");
                    assert!(is_lossless || cos < 0.05 || *value < 0.99, "{cos}: {sum:?}");
                }
            }
        }
    }
}

/// Energies of which another F0 of the second layer leaves a factor of what is not reflected.
struct Passing<'a>(&'a dyn Energy<3>, [f64; 3]);

impl Energy<3> for Passing<'_> {
    fn fgd(&self, layer: usize, cos_theta_i: f64, alpha: f64) -> [f64; 3] {
        let given = self.0.fgd(layer, cos_theta_i, alpha);
        if layer == 1 { [0, 1, 2].map(|c: usize| 1.0 - self.1[c] * (1.0 - given[c])) } else { given }
    }

    fn escaping(&self, layer: usize, cos_theta_i: f64, alpha: f64, eta: f64) -> f64 {
        self.0.escaping(layer, cos_theta_i, alpha, eta)
    }
}

/// Oracle: the formulas in f64. Copper made of plastic below a coat: what its interface does not reflect is in proportion to 1 - F0.
#[test]
fn places_change_the_f0_of_a_layer() {
    let passing = [0.05, 0.4, 0.5];
    let probe = "fn probe(material: u32, wi: vec3<f32>, wo: vec3<f32>) -> vec3<f32> { var place = luthier_place(); \
                 place.layers[1].passing = vec3<f32>(0.05, 0.4, 0.5); return luthier_eval_at(place, material, wi, wo); }";
    for model in [ShadingModel::Belcour, ShadingModel::Yamaguchi] {
        let plastic = LayerRecord { eta: 1.0, f0: Some([0.04; 3]), ..with_escape(clear()) };
        let layers = [with_escape(dielectric()), plastic, diffuse(0.0)];
        let entry = with_map(material("painted", &layers), MapSlot::Metallic, 1);
        let materials = [MaterialEntry { model, ..entry }];
        let machine = baked(&materials, probe);
        let read = Read { material: &materials[0], fgd: albedos(), escape: shares() };
        for (wi, wo) in directions(200) {
            let expected = twin(&materials[0], &Passing(&read, passing), wi, wo);
            let [a, b] = [wi, wo].map(|w| vector(&w.map(|v| v as f32)));
            let found = machine.call("probe", vec![Value::U(0), a, b]).floats();
            for (e, f) in expected.iter().zip(&found) {
                let error = (f64::from(*f) - e).abs() / e.abs().max(1e-3);
                assert!(error < TOLERANCE, "{wi:?} {wo:?}: {found:?}, f64 {expected:?}");
            }
        }
    }
}

/// Factors of textures at a place change slopes, slabs and films to those of another material.
#[test]
fn places_change_slopes_slabs_and_films() {
    let probe = "fn probe(material: u32, wi: vec3<f32>, wo: vec3<f32>) -> vec3<f32> { var place = luthier_place(); \
                 place.alpha_factor = 2.0; place.slab_factor = 3.0; place.film_factor = 0.5; \
                 return luthier_eval_at(place, material, wi, wo); }";
    for model in [ShadingModel::Belcour, ShadingModel::Yamaguchi] {
        let oiled = LayerRecord { optical_depth: [0.1, 0.2, 0.3], ..with_escape(filmed()) };
        let base = LayerRecord { alpha: 0.2, alpha_xy: [0.1, 0.4], rotation: 0.5, ..conductor() };
        let of = |layers: &[LayerRecord]| [MaterialEntry { model, ..material("oiled", layers) }];
        let materials = of(&[oiled.clone(), base.clone()]);
        let doubled = |layer: &LayerRecord| LayerRecord {
            alpha: 2.0 * layer.alpha,
            alpha_xy: layer.alpha_xy.map(|alpha| 2.0 * alpha),
            optical_depth: layer.optical_depth.map(|depth| 3.0 * depth),
            film_thickness_waves: layer.film_thickness_waves.map(|waves| 0.5 * waves),
            ..layer.clone()
        };
        let [other] = of(&[doubled(&oiled), doubled(&base)]);
        let text = emit(&MaterialSet::new(&materials, Vec::new()), Form::Full, Target::Wgsl).unwrap();
        let machine = Machine::new(&(text + probe), &material_buffer(&materials), BTreeMap::new());
        for (wi, wo) in directions(200) {
            let expected = twin(&other, &LevelFacets(&other), wi, wo);
            let arguments = [wi, wo].map(|w| vector(&w.map(|v| v as f32)));
            let found = machine.call("probe", [&[Value::U(0)][..], &arguments].concat()).floats();
            for (e, f) in expected.iter().zip(&found) {
                assert!((f64::from(*f) - e).abs() < TOLERANCE * e.max(1e-3), "{wi:?} {wo:?}: {found:?} {expected:?}");
            }
        }
    }
}

/// Equal variances, and tangents that differ by a quarter turn: any axis will do, and none is missing.
#[test]
fn equal_variances_make_one_lobe_whatever_their_axes() {
    let coat = |rotation: f64| LayerRecord { alpha: 0.1, alpha_xy: [0.2, 0.05], rotation, ..clear() };
    let round = LayerRecord { alpha_xy: [0.3; 2], alpha: 0.3, ..conductor() };
    let of = |model, name: &str, layers: &[LayerRecord]| MaterialEntry { model, ..material(name, layers) };
    let quarter = std::f64::consts::FRAC_PI_2;
    let turned = LayerRecord { alpha_xy: [0.05, 0.2], rotation: 0.4 + quarter, ..coat(0.0) };
    let materials = [
        of(ShadingModel::Yamaguchi, "round", std::slice::from_ref(&round)),
        of(ShadingModel::Belcour, "plain", std::slice::from_ref(&round)),
        of(ShadingModel::Yamaguchi, "one", &[coat(0.4), round.clone()]),
        of(ShadingModel::Yamaguchi, "other", &[turned, round]),
    ];
    let machine = full(&materials);
    for (wi, wo) in directions(200) {
        let [round, plain, one, other] = [0, 1, 2, 3].map(|number| eval(&machine, number, wi, wo));
        for (a, b) in round.iter().zip(&plain).chain(one.iter().zip(&other)) {
            assert!(a.is_finite() && (a - b).abs() <= 1e-4 * a.max(1e-3), "{wi:?} {wo:?}: {a} {b}");
        }
    }
}
