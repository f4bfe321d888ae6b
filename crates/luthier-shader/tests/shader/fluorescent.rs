//! Shaders of fluorescent bases: light of a colour goes in, and light of other colours comes out.

use std::collections::BTreeMap;

use luthier_manifest::{Form, FunctionGroup, MaterialEntry, ShadingModel, material_buffer};
use luthier_shader::{MaterialSet, Target, emit};

use crate::arithmetic::directions;
use crate::machine::{Machine, Value, vector};
use crate::paper;
use crate::scenes::{sets, tables};

const LIGHTS: [[f64; 3]; 4] = [[1.0, 1.0, 1.0], [0.0, 0.0, 3.0], [0.2, 0.9, 0.0], [5.0, 0.1, 0.4]];

fn single(w: [f64; 3]) -> Value {
    vector(&w.map(|v| v as f32))
}

fn machine(materials: &[MaterialEntry]) -> Machine {
    let functions = [FunctionGroup::Light].into_iter().collect();
    let set = MaterialSet { functions, ..MaterialSet::new(materials, tables()) };
    Machine::new(&emit(&set, Form::Full, Target::Wgsl).unwrap(), &material_buffer(materials), BTreeMap::new())
}

/// Oracle: the recursion of the paper, with light in channels on the way down and on the way up.
#[test]
fn light_of_a_colour_comes_out_in_others() {
    let mut compared = 0;
    for (name, materials) in sets().into_iter().filter(|(name, _)| name.starts_with("fluorescent")) {
        let machine = machine(&materials);
        for (number, material) in materials.iter().enumerate() {
            for (i, (wi, wo)) in directions(100).enumerate() {
                let light = LIGHTS[i % 4];
                let call = |function: &str, more: &[Value]| {
                    let arguments = [vec![Value::U(number as u32), single(wi), single(wo)], more.to_vec()].concat();
                    machine.call(function, arguments).floats()
                };
                let found = call("luthier_eval_lit", &[single(light)]);
                let plain = call("luthier_eval", &[]);
                let what = format!("{name}/{} {wi:?} {wo:?} {light:?}", material.name);
                let near = |found: &[f32], expected: [f64; 3]| {
                    let floor = expected.iter().fold(1e-3f64, |most, v| most.max(v.abs()));
                    found.iter().zip(expected).all(|(f, e)| (f64::from(*f) - e).abs() < 5e-5 * floor)
                };
                // The paper's layers are never smoother than those above; the other model has alpha of its own.
                if material.model == ShadingModel::Elek {
                    let expected = paper::eval_lit(&material.layers, light, wi, wo);
                    assert!(near(&found, expected), "{what}: {found:?} {expected:?}");
                    compared += 1;
                }
                if material.layers.iter().all(|layer| layer.reradiation.is_none()) {
                    let expected = [0, 1, 2].map(|c| f64::from(plain[c]) * light[c]);
                    assert!(near(&found, expected), "{what}: {found:?} {expected:?}");
                }
                // White light is `luthier_eval`, and lights add up.
                let white = call("luthier_eval_lit", &[single([1.0; 3])]);
                assert_eq!(white, plain, "{what}");
                let parts = [0, 1, 2].map(|c| {
                    let mut one = [0.0; 3];
                    one[c] = light[c];
                    call("luthier_eval_lit", &[single(one)])
                });
                let sum = [0, 1, 2].map(|c| parts.iter().map(|part| f64::from(part[c])).sum::<f64>());
                assert!(near(&found, sum), "{what}: {found:?} {sum:?}");
                let prepared = machine.call("luthier_prepare", vec![Value::U(number as u32), single(wo)]);
                let light = machine.call("luthier_light_lit", vec![prepared, single(wi), single(light)]).floats();
                assert!(near(&light, [0, 1, 2].map(|c| f64::from(found[c]))), "{what}: {light:?} {found:?}");
            }
        }
    }
    assert!(compared >= 400, "{compared}");
}

#[test]
fn sets_without_such_a_base_have_none_of_it() {
    for (name, materials) in sets() {
        let functions = FunctionGroup::ALL.into_iter().collect();
        let set = MaterialSet { functions, ..MaterialSet::new(&materials, tables()) };
        let text = emit(&set, Form::Baked, Target::Wgsl).unwrap();
        let has = materials.iter().flat_map(|m| &m.layers).any(|layer| layer.reradiation.is_some());
        for word in ["_lit", "reradiated", "fluoresces"] {
            assert_eq!(text.contains(word), has, "{name} {word}");
        }
    }
}
