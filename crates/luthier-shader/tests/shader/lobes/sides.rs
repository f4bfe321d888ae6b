//! A coat with a weight over layers with lobes of their own: two materials by area.

use std::collections::BTreeMap;

use luthier_lut::{AtlasLayout, Image, TableKind};
use luthier_manifest::{
    CoatRecord, FunctionGroup, LayerRecord, MapSlot, MaterialConstants, MaterialEntry, SideRecord, material_buffer,
};
use luthier_shader::{Form, MaterialSet, Target, emit};

use super::families::{FIRST, NODES, drawn_as_the_density_says, family, material, rows_of};
use super::{set, tables_with};
use crate::arithmetic::directions;
use crate::machine::{Machine, Value, vector};
use crate::scenes::bumpy;

/// Weight of the coat.
const WEIGHT: f32 = 0.625;

/// The shader of some materials, run on rows and on grey reflectances.
struct Shader {
    machine: Machine,
    text: String,
}

impl Shader {
    fn new(materials: &[MaterialEntry], (layout, image): &(AtlasLayout, Image)) -> Self {
        let functions = [FunctionGroup::Sample, FunctionGroup::Albedo].into_iter().collect();
        let set = MaterialSet { functions, ..MaterialSet::new(materials, tables_with(layout)) };
        let text = emit(&set, Form::Baked, Target::Wgsl).unwrap();
        let grey = Image { data: vec![0.1; 36], ..Image::zeros(3, 3, 4) };
        let textures = [
            ("luthier_fresnel", grey.clone()),
            ("luthier_distribution", grey.clone()),
            ("luthier_film", grey),
            ("luthier_lobes", image.clone()),
        ];
        let textures = BTreeMap::from(textures.map(|(name, image)| (name.to_owned(), image)));
        Self { machine: Machine::new(&text, &material_buffer(materials), textures), text }
    }

    /// Number of a member of a structure.
    fn member(&self, structure: &str, name: &str) -> Option<usize> {
        let text = self.text.split(&format!("struct {structure} {{")).nth(1)?.split('}').next()?;
        let names = text.lines().filter_map(|line| line.trim().strip_suffix(',')?.split_once(": "));
        names.map(|(name, _)| name).position(|known| known == name)
    }

    /// A place with these values, as far as the shader has them.
    fn place(&self, values: &Values, first: usize) -> Value {
        let mut place = self.machine.call("luthier_place", Vec::new());
        let slab = if first == 0 { values.slab } else { 1.0 };
        for (name, value) in [
            ("alpha_factor", Value::F(values.factor)),
            ("slab_factor", Value::F(slab)),
            ("weight_factor", Value::F(values.weight_factor)),
            ("base_color", vector(&values.color)),
        ] {
            if let Some(number) = self.member("LuthierPlace", name) {
                place.members_mut()[number] = value;
            }
        }
        let alphas: Vec<Value> = values.alphas.iter().map(|alpha| vector(&[*alpha, 1.0])).collect();
        let normals: Vec<Value> = values.normals.iter().map(|normal| vector(normal)).collect();
        for (name, given) in [("alpha_factors", alphas), ("normal", normals)] {
            let members = (self.member("LuthierPlace", "layers"), self.member("LuthierLayerPlace", name));
            let (Some(layers), Some(own)) = members else { continue };
            let layers = place.members_mut()[layers].members_mut();
            for (layer, value) in layers.iter_mut().zip(given.into_iter().skip(first)) {
                layer.members_mut()[own] = value;
            }
        }
        let normal = self.member("LuthierPlace", "normal").unwrap();
        place.members_mut()[normal] = vector(&values.normal);
        if self.text.contains("fn luthier_metallic_place(") {
            let arguments = vec![place, Value::U(0), vector(&values.color), Value::F(values.metal)];
            place = self.machine.call("luthier_metallic_place", arguments);
        }
        place
    }

    /// Light, albedo and density of a place.
    fn at(&self, place: &Value, wi: [f32; 3], wo: [f32; 3]) -> [Vec<f32>; 3] {
        let light = self.machine.call("luthier_eval_at", vec![place.clone(), Value::U(0), vector(&wi), vector(&wo)]);
        let prepared = self.machine.call("luthier_prepare_at", vec![place.clone(), Value::U(0), vector(&wo)]);
        let albedo = self.machine.call("luthier_albedo", vec![prepared.clone()]);
        let density = self.machine.call("luthier_pdf", vec![prepared, vector(&wi)]);
        [light, albedo, density].map(|value| value.floats())
    }
}

/// Values of the textures of a place.
struct Values {
    factor: f32,
    slab: f32,
    weight_factor: f32,
    /// Factors on the slope parameters of coat and base.
    alphas: [f32; 2],
    /// Normal of the surface, and own normals of coat, base and diffuse base in its frame: the last two have one map.
    normal: [f32; 3],
    normals: [[f32; 3]; 3],
    color: [f32; 3],
    metal: f32,
}

fn unit(v: [f32; 3]) -> [f32; 3] {
    let length = v.iter().map(|x| x * x).sum::<f32>().sqrt();
    v.map(|x| x / length)
}

/// The values of a place by number.
fn values(k: usize) -> Values {
    let share = |step: f64| (0.003 + k as f64 * step).fract() as f32;
    let of_base = unit([0.5 * share(0.47) - 0.3, -0.2, 1.0]);
    Values {
        factor: 1.0 - 0.5 * share(0.29),
        slab: share(0.43),
        // From no coat to one that would be there more than once.
        weight_factor: [0.0, 0.4, 1.0, 1.3, 2.0][k % 5],
        alphas: [share(0.37).max(1e-3), share(0.61).max(1e-3)],
        normal: unit([0.3 * share(0.53) - 0.1, 0.1, 1.0]),
        normals: [unit([0.1, 0.4 * share(0.19) - 0.2, 1.0]), of_base, of_base],
        color: [share(0.17), share(0.23), share(0.31)],
        metal: share(0.71),
    }
}

/// A coat with a weight over layers of a family.
fn of_families(is_metallic: bool, nodes: [u32; 2]) -> MaterialEntry {
    let mut coated = material(family(1, is_metallic, nodes));
    let side = material(family(0, is_metallic, [1, nodes[1]]));
    let mut bare = LayerRecord { alpha: coated.layers[1].alpha, ..side.layers[0].clone() };
    bare.tiles[TableKind::Lobes] = Some(FIRST + nodes[0] * nodes[1]);
    let coat = CoatRecord {
        weight: WEIGHT.into(),
        bare,
        side: Some(SideRecord { lobes: side.constants.lobes, without_film: false }),
    };
    coated.constants.coat = Some(coat);
    coated
}

/// Oracle: the material without the weight, and the layers below its coat as a material, each by a shader of its own.
#[test]
fn light_of_sides_is_that_of_two_materials() {
    let [both, one] = [NODES, [1, 3]];
    let plain = || super::rows();
    let family = |is_metallic, nodes: [u32; 2]| {
        let whole = FIRST + nodes[0] * nodes[1];
        (of_families(is_metallic, nodes), rows_of(whole + nodes[1], is_metallic, |tile| tile < whole))
    };
    let scene = |name| (set(name).swap_remove(0), plain());
    let own = |(material, rows): (MaterialEntry, (AtlasLayout, Image))| (bumpy(material), rows);
    let cases = [
        family(true, both),
        family(true, one),
        family(false, both),
        scene("lobes-sides"),
        scene("lobes-sides-base"),
        scene("lobes-sides-film"),
        own(family(true, both)),
        own(family(false, one)),
        own(scene("lobes-sides")),
        own(scene("lobes-sides-base")),
        own(scene("lobes-sides-film")),
    ];
    for (number, (material, rows)) in cases.into_iter().enumerate() {
        let mut material = material;
        let MaterialEntry { layers, constants, .. } = &mut material;
        layers.iter_mut().chain(constants.bare_mut()).for_each(|layer| layer.tiles[TableKind::Distribution] = None);
        if let Some(coat) = &mut constants.coat {
            coat.weight = WEIGHT.into();
        }
        // Without a film all layers are there.
        let coats = material.layers.len() - material.side().unwrap().layers.len();
        let is_base = material.constants.coat.as_ref().is_some_and(|coat| coat.side.unwrap().lobes.is_none());
        let below = material.side().unwrap();
        // A map, so that its shader has places.
        let below = if below.maps.is_empty() { crate::features::with_map(below, MapSlot::Normal, 0) } else { below };
        let constants = MaterialConstants { coat: None, ..material.constants.clone() };
        let coated = MaterialEntry { constants, ..material.clone() };
        let coated =
            if coated.maps.is_empty() { crate::features::with_map(coated, MapSlot::Normal, 0) } else { coated };
        // Beside other materials, too, of which one has a weight without sides.
        let others = [set("lobes-weight").swap_remove(0), set("gold").swap_remove(0)];
        let named = MaterialEntry { name: "sided".to_owned(), ..material.clone() };
        let beside: Vec<MaterialEntry> = [named].into_iter().chain(others).collect();
        let shaders = [vec![material], beside].map(|materials| Shader::new(&materials, &rows));
        let [coated, below] = [coated, below].map(|material| Shader::new(&[material], &rows));
        let mut brightest = 0.0_f32;
        for (k, (wi, wo)) in directions(120).enumerate() {
            let values = values(k);
            let [wi, wo] = [wi, wo].map(|w| w.map(|x| x as f32));
            let faces = |w: [f32; 3], normal: [f32; 3]| w.iter().zip(normal).map(|(w, n)| w * n).sum::<f32>() > 1e-3;
            if wi[2] <= 0.0 || wo[2] <= 0.0 || !faces(wi, values.normal) || !faces(wo, values.normal) {
                continue;
            }
            let first = coated.at(&coated.place(&values, 0), wi, wo);
            let second = below.at(&below.place(&values, coats), wi, wo);
            let weight = (WEIGHT * values.weight_factor).min(1.0);
            let mix = |of: usize| -> Vec<f32> {
                first[of].iter().zip(&second[of]).map(|(a, b)| weight * a + (1.0 - weight) * b).collect()
            };
            // Rows that no fit has made may have less than no light.
            let mean = |albedo: &[f32]| (albedo.iter().sum::<f32>() / 3.0).max(0.0);
            let [a, b] = [weight * mean(&first[1]), (1.0 - weight) * mean(&second[1])].map(|x| x + 1e-6);
            // A side that turns away from the eye has no draws.
            let chance = if weight >= 1.0 || weight > 0.0 && second[1] == [0.0; 3] {
                1.0
            } else if weight <= 0.0 || first[1] == [0.0; 3] {
                0.0
            } else {
                a / (a + b)
            };
            let density = chance * first[2][0] + (1.0 - chance) * second[2][0];
            for shader in &shaders {
                let found = shader.at(&shader.place(&values, 0), wi, wo);
                for (found, expected) in [(&found[0], mix(0)), (&found[1], mix(1)), (&found[2], vec![density])] {
                    for (found, expected) in found.iter().zip(expected) {
                        let error = (found - expected).abs() / expected.abs().max(0.03);
                        assert!(error < 2e-5, "{number} {is_base} {k} {weight}: {found} {expected}");
                        brightest = brightest.max(expected);
                    }
                }
            }
        }
        assert!(brightest > 0.1, "{number}: {brightest}");
    }
}

/// The mean of the weights of drawn directions is the albedo in a midpoint rule, and densities sum to at most 1.
#[test]
fn directions_of_sides_are_drawn_as_their_density_says() {
    let whole = FIRST + NODES[0] * NODES[1];
    let family = (of_families(true, NODES), rows_of(whole + NODES[1], true, |tile| tile < whole));
    let paint = (set("lobes-sides-base").swap_remove(0), super::rows());
    let bumps = [&family, &paint].map(|(material, rows)| (bumpy(material.clone()), rows.clone()));
    for (material, rows) in [family, paint].into_iter().chain(bumps) {
        let mut material = material;
        let MaterialEntry { layers, constants, .. } = &mut material;
        layers.iter_mut().chain(constants.bare_mut()).for_each(|layer| layer.tiles[TableKind::Distribution] = None);
        let shader = Shader::new(&[material], &rows);
        for (k, theta) in [(1, 0.3_f64), (2, 1.1)] {
            let place = shader.place(&values(k), 0);
            let wo = [theta.sin() * 0.8, theta.sin() * 0.6, theta.cos()].map(|w| w as f32);
            let prepared = shader.machine.call("luthier_prepare_at", vec![place, Value::U(0), vector(&wo)]);
            drawn_as_the_density_says(&shader.machine, &prepared, &format!("{k} {theta}"));
        }
    }
}
