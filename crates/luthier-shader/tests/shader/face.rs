//! The functions beside `luthier_eval`: light of a prepared material is that of `luthier_eval`, draws have the density and the weight that
//! the other functions say, and a shader has no text for groups that were not asked for.

use std::collections::BTreeMap;

use luthier_lut::{Image, TableKind};
use luthier_manifest::{FunctionGroup, LayerKind, LayerRecord, MaterialEntry, ShadingModel, material_buffer};
use luthier_optics::fresnel;
use luthier_shader::{Form, MaterialSet, Target, emit};
use num_complex::Complex64;

use crate::arithmetic::directions;
use crate::machine::{Machine, Value, vector};
use crate::scenes::{forms, sets, tables};

/// Tables whose values rise along both axes; rows of lobes as wide as they are strong.
fn textures() -> BTreeMap<String, Image> {
    let texture = |face: &luthier_shader::TableFace| {
        let [width, height] = face.layout.size();
        let mut image = Image::zeros(width, height, 4);
        for (y, x) in (0..height).flat_map(|y| (0..width).map(move |x| (y, x))) {
            let value = 0.1 + 0.4 * x as f32 / width as f32 + 0.4 * y as f32 / height as f32;
            image.texel_mut(x, y).fill(if face.kind == TableKind::Lobes { 0.5 + value } else { value });
        }
        (format!("luthier_{}", face.kind.name()), image)
    };
    tables().iter().map(texture).collect()
}

fn single(w: [f64; 3]) -> Value {
    vector(&w.map(|v| v as f32))
}

fn are_near(found: &[f32], expected: &[f32]) -> bool {
    let floor = expected.iter().fold(1e-3f32, |most, v| most.max(v.abs()));
    found.iter().zip(expected).all(|(a, b)| a.is_finite() && (a - b).abs() <= 2e-5 * floor)
}

#[test]
fn prepared_materials_give_the_light_of_eval() {
    let mut compared = 0;
    for (name, materials) in sets() {
        for form in forms(&materials) {
            let functions = FunctionGroup::ALL.into_iter().collect();
            let set = MaterialSet { functions, ..MaterialSet::new(&materials, tables()) };
            let text = emit(&set, form, Target::Wgsl).unwrap();
            let machine = Machine::new(&text, &material_buffer(&materials), textures());
            for number in 0..materials.len() as u32 {
                for (i, (wi, wo)) in (0..).zip(directions(12)) {
                    let what = format!("{name} {form} {number} {wi:?} {wo:?}");
                    let expected =
                        machine.call("luthier_eval", vec![Value::U(number), single(wi), single(wo)]).floats();
                    let prepared = machine.call("luthier_prepare", vec![Value::U(number), single(wo)]);
                    let call = |function: &str, w: Value| machine.call(function, vec![prepared.clone(), w]);
                    let found = call("luthier_light", single(wi)).floats();
                    assert!(are_near(&found, &expected), "{what}: {found:?} {expected:?}");
                    compared += usize::from(expected.iter().any(|&v| v > 1e-3));

                    let u = [0.05 + 0.08 * f64::from(i), 0.3, 0.7];
                    let drawn = call("luthier_sample", single(u));
                    let drawn = drawn.members();
                    let pdf = call("luthier_pdf", drawn[0].clone()).floats()[0];
                    assert_eq!(drawn[1].floats(), [pdf], "{what}");
                    let weight = drawn[2].floats();
                    if pdf > 0.0 {
                        let light = call("luthier_light", drawn[0].clone()).floats();
                        let expected: Vec<f32> = light.iter().map(|value| value / pdf).collect();
                        assert!(are_near(&weight, &expected), "{what}: {weight:?} {expected:?}");
                    } else {
                        assert_eq!(weight, [0.0; 3], "{what}");
                    }
                    let albedo = machine.call("luthier_albedo", vec![prepared.clone()]).floats();
                    assert!(albedo.iter().all(|value| value.is_finite()), "{what}: {albedo:?}");
                }
                for (wi, wo) in [([0.0, 0.6, -0.8], [0.6, 0.0, 0.8]), ([0.6, 0.0, 0.8], [0.0, 0.6, -0.8])] {
                    let prepared = machine.call("luthier_prepare", vec![Value::U(number), single(wo)]);
                    for function in ["luthier_light", "luthier_pdf"] {
                        let value = machine.call(function, vec![prepared.clone(), single(wi)]).floats();
                        assert!(value.iter().all(|&v| v == 0.0), "{name} {function} {value:?}");
                    }
                }
            }
        }
    }
    assert!(compared > 800, "{compared}");
}

/// A surface whose normal leans, and directions that lean with it: the same densities, and draws that lean with it.
/// Oracle: Algorithm 1 of Elek 2010, lines 28 and 29, by the f64 function of the same lines: what the first interface mirrors, from where the eye is
/// mirrored, for both forms; and the light of a diffuse base, which does not see the mirrored half.
#[test]
fn the_first_interface_mirrors_the_environment() {
    let of = |layers: Vec<LayerRecord>, model| {
        vec![MaterialEntry { name: "one".to_owned(), model, layers, ..MaterialEntry::default() }]
    };
    let kind = LayerKind::Conductor;
    let metal = LayerRecord {
        kind,
        alpha: 0.2,
        alpha_xy: [0.2; 2],
        ior_n: [0.2; 3],
        ior_k: [3.0; 3],
        ..LayerRecord::default()
    };
    let coat = LayerRecord { alpha: 0.1, alpha_xy: [0.1; 2], eta: 1.5, ior_n: [1.5; 3], ..LayerRecord::default() };
    let base = LayerRecord { kind: LayerKind::Diffuse, eta: 1.0, albedo: [0.5; 3], ..LayerRecord::default() };
    let mut map = Image::zeros(2, 1, 3);
    map.texel_mut(0, 0).fill(2.0);
    let mut white = Image::zeros(1, 1, 3);
    white.texel_mut(0, 0).fill(1.0);
    let maps = [("luthier_environment_map", map), ("luthier_irradiance_map", white)];
    let textures: BTreeMap<String, Image> = maps.map(|(name, map)| (name.to_owned(), map)).into();
    for model in [ShadingModel::Elek, ShadingModel::WeidlichWilkie, ShadingModel::Microfacet] {
        for (layers, n) in [
            (vec![metal.clone()], Complex64::new(0.2, 3.0)),
            (vec![coat.clone(), base.clone()], Complex64::new(1.5, 0.0)),
        ] {
            let materials = of(layers, model);
            let functions = [FunctionGroup::Environment].into_iter().collect();
            let set = MaterialSet { functions, ..MaterialSet::new(&materials, Vec::new()) };
            let text = emit(&set, Form::Full, Target::Wgsl).unwrap();
            let machine = Machine::new(&text, &material_buffer(&materials), textures.clone());
            for (x, light) in [(0.6, 2.0), (-0.6, 0.0)] {
                let prepared = machine.call("luthier_prepare", vec![Value::U(0), single([x, 0.0, 0.8])]);
                let wide = |prepared: &Value| {
                    machine.call("luthier_environment", vec![prepared.clone(), frame(), Value::F(0.0)]).floats()
                };
                let dark = machine.call("luthier_prepare", vec![Value::U(0), single([-0.6, 0.0, 0.8])]);
                let expected = light * fresnel::interface(Complex64::new(1.0, 0.0), n, 0.8).unpolarised();
                let found = wide(&prepared)[1] - wide(&dark)[1];
                assert!((f64::from(found) - expected).abs() < 2e-6, "{model} {n} {x}: {found} {expected}");
            }
        }
    }
}

/// The frame of a surface that faces +z.
fn frame() -> Value {
    [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].map(single).into_iter().collect()
}

#[test]
fn draws_lean_with_the_normal_of_a_place() {
    let lean = glam::DQuat::from_rotation_arc(glam::DVec3::Z, glam::DVec3::new(0.12, -0.09, 1.0).normalize());
    let turned = |w: [f64; 3]| (lean * glam::DVec3::from(w)).to_array();
    let mut compared = 0;
    for (name, materials) in sets() {
        let functions = [FunctionGroup::Sample].into_iter().collect();
        let set = MaterialSet { functions, ..MaterialSet::new(&materials, tables()) };
        let text = emit(&set, Form::Baked, Target::Wgsl).unwrap();
        if !text.contains("fn luthier_place(") {
            continue;
        }
        let machine = Machine::new(&text, &material_buffer(&materials), textures());
        let place = machine.call("luthier_place", Vec::new());
        for number in 0..materials.len() as u32 {
            for (wi, wo) in directions(8).filter(|(wi, wo)| turned(*wi)[2] > 0.2 && turned(*wo)[2] > 0.2) {
                let what = format!("{name} {number} {wi:?} {wo:?}");
                let prepared = |place: &Value, wo| {
                    let arguments = vec![place.clone(), Value::U(number), single(wo)];
                    machine.call("luthier_prepare_at", arguments)
                };
                let mut leaning = place.clone();
                leaning.members_mut()[0] = single(turned([0.0, 0.0, 1.0]));
                let (level, leaning) = (prepared(&place, wo), prepared(&leaning, turned(wo)));
                let pdf =
                    |prepared: &Value, wi| machine.call("luthier_pdf", vec![prepared.clone(), single(wi)]).floats()[0];
                let (expected, found) = (pdf(&level, wi), pdf(&leaning, turned(wi)));
                // Directions in f32 are off by 6e-8, 3e-6 of the width of the narrowest lobe.
                assert!((found - expected).abs() <= 1e-3 * expected, "{what}: {found} {expected}");
                let draw = |prepared: &Value| {
                    let drawn = machine.call("luthier_sample", vec![prepared.clone(), single([0.4, 0.3, 0.6])]);
                    drawn.members()[0].floats()
                };
                let expected = turned([0, 1, 2].map(|i| f64::from(draw(&level)[i])));
                let found = draw(&leaning);
                let apart = (0..3).map(|i| (f64::from(found[i]) - expected[i]).abs()).fold(0.0, f64::max);
                assert!(apart < 1e-5, "{what}: {found:?} {expected:?}");
                compared += 1;
            }
        }
    }
    assert!(compared > 40, "{compared}");
}

#[test]
fn a_shader_has_the_groups_that_were_asked_for() {
    let names = [
        (FunctionGroup::Light, &["fn luthier_prepare(", "fn luthier_light("][..]),
        (FunctionGroup::Sample, &["fn luthier_sample(", "fn luthier_pdf("]),
        (FunctionGroup::Propose, &["fn luthier_propose(", "const LUTHIER_PROPOSALS"]),
        (FunctionGroup::Albedo, &["fn luthier_albedo("]),
        (FunctionGroup::Surface, &["    slope_variance: f32,"]),
    ];
    for (name, materials) in sets() {
        for asked in [
            &[][..],
            &[FunctionGroup::Light],
            &[FunctionGroup::Sample],
            &[FunctionGroup::Propose],
            &[FunctionGroup::Albedo],
            &[FunctionGroup::Surface],
        ] {
            let set =
                MaterialSet { functions: asked.iter().copied().collect(), ..MaterialSet::new(&materials, tables()) };
            let text = emit(&set, Form::Baked, Target::Wgsl).unwrap();
            for (group, functions) in names {
                for function in functions {
                    assert_eq!(text.contains(function), set.functions.has(group), "{name} {asked:?} {function}");
                }
            }
            assert_eq!(text.contains("LuthierPart "), text.contains("luthier_no_part("), "{name} {asked:?}");
        }
    }
}

/// On a surface of one slope parameter a variance of slopes is a factor on it: alpha^2 + 2 variance.
#[test]
fn a_variance_of_slopes_is_a_factor_on_the_only_slope_parameter() {
    for name in ["gold", "belcour", "microfacet"] {
        let materials = sets().into_iter().find(|(known, _)| *known == name).unwrap().1;
        let functions = [FunctionGroup::Surface].into_iter().collect();
        let set = MaterialSet { functions, ..MaterialSet::new(&materials, tables()) };
        let machine =
            Machine::new(&emit(&set, Form::Baked, Target::Wgsl).unwrap(), &material_buffer(&materials), textures());
        let neutral = machine.call("luthier_place", Vec::new());
        let (alpha, variance) = (materials[0].layers[0].alpha, 0.02);
        let (mut varied, mut scaled) = (neutral.clone(), neutral.clone());
        // After the normal and three factors.
        varied.members_mut()[4] = Value::F(variance as f32);
        scaled.members_mut()[1] = Value::F(((alpha * alpha + 2.0 * variance).sqrt() / alpha) as f32);
        let mut moved = 0.0_f32;
        for (wi, wo) in directions(40).filter(|(wi, wo)| wi[2] > 0.0 && wo[2] > 0.0) {
            let at = |place: &Value| {
                let arguments = vec![place.clone(), Value::U(0), single(wi), single(wo)];
                machine.call("luthier_eval_at", arguments).floats()[0]
            };
            let (found, expected, plain) = (at(&varied), at(&scaled), at(&neutral));
            assert!(
                (found - expected).abs() <= 1e-4 * expected.abs().max(1e-3),
                "{name} {wi:?} {wo:?}: {found} {expected}"
            );
            moved = moved.max((found - plain).abs());
        }
        assert!(moved > 0.05, "{name}: {moved}");
    }
}
