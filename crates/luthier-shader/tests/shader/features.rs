//! The table of what models show, against what their shaders do: a feature is shown where values move when it is taken away.

use std::collections::BTreeMap;

use luthier_lut::{Image, TableKind};
use luthier_manifest::{
    Distribution, Feature, FileEntry, LayerRecord, MapEntry, MapSlot, Masking, MaterialConstants, MaterialEntry,
    ShadingModel, material_buffer,
};
use luthier_shader::{Form, MaterialSet, TableFace, Target, emit};

use crate::arithmetic::directions;
use crate::machine::{Machine, Value, vector};
use crate::scenes::{
    FLAKES, GLITTER, clear, conductor, dielectric, diffuse, filmed, fluorescent, material, patina, tables,
};

/// Change of values that a shown feature exceeds; a feature that is not shown moves none.
const SHOWN: f32 = 0.02;

/// A shader of one material, and a place of its surface.
struct Shader {
    machine: Machine,
    wgsl: String,
    place: Option<Value>,
}

/// D is computed: a table of it would hide which distribution a record names.
fn faces() -> Vec<TableFace> {
    tables().into_iter().filter(|face| face.kind != TableKind::Distribution).collect()
}

/// Tables whose values rise along both axes.
fn textures() -> BTreeMap<String, Image> {
    let texture = |face: &TableFace| {
        let [width, height] = face.layout.size();
        let mut image = Image::zeros(width, height, 4);
        for y in 0..height {
            for x in 0..width {
                let value = 0.1 + 0.4 * x as f32 / width as f32 + 0.4 * y as f32 / height as f32;
                image.texel_mut(x, y).fill(value);
            }
        }
        (format!("luthier_{}", face.kind.name()), image)
    };
    faces().iter().map(texture).collect()
}

impl Shader {
    fn new(material: MaterialEntry, form: Form) -> Self {
        let materials = [material];
        let set = MaterialSet::new(&materials, faces());
        let wgsl = emit(&set, form, Target::Wgsl).unwrap();
        let machine = Machine::new(&wgsl, &material_buffer(&materials), textures());
        let has_place = wgsl.contains("fn luthier_place(");
        let place = has_place.then(|| machine.call("luthier_place", Vec::new()));
        Self { machine, wgsl, place }
    }

    /// Sets a member of the place, if shaders of the set have it.
    fn at(mut self, member: &str, value: Value) -> Self {
        let text = self.wgsl.split("struct LuthierPlace {").nth(1).unwrap().split('}').next().unwrap();
        let mut names = text.lines().filter_map(|line| line.trim().split_once(": ")).map(|(name, _)| name);
        let names: Vec<&str> = names.by_ref().filter(|name| !name.starts_with("//")).collect();
        if let (Some(index), Some(place)) = (names.iter().position(|name| *name == member), &mut self.place) {
            place.members_mut()[index] = value;
        }
        self
    }

    /// Sets a member of the place of a layer, if shaders of the set have it.
    fn at_layer(mut self, layer: usize, member: &str, value: Value) -> Self {
        let Some(text) = self.wgsl.split("struct LuthierLayerPlace {").nth(1) else { return self };
        let text = text.split('}').next().unwrap();
        let names = text.lines().filter_map(|line| line.trim().split_once(": ")).map(|(name, _)| name);
        let index = names.filter(|name| !name.starts_with("//")).position(|name| name == member);
        let layers = self.place.as_mut().and_then(|place| place.members_mut().last_mut());
        if let (Some(index), Some(layers)) = (index, layers) {
            layers.members_mut()[layer].members_mut()[index] = value;
        }
        self
    }

    fn values(&self) -> Vec<f32> {
        let value = |(wi, wo): ([f64; 3], [f64; 3])| {
            let [wi, wo] = [wi, wo].map(|w| vector(&w.map(|v| v as f32)));
            match &self.place {
                Some(place) => {
                    let arguments = vec![place.clone(), Value::U(0), wi, wo];
                    self.machine.call("luthier_eval_at", arguments).floats()
                }
                None => self.machine.call("luthier_eval", vec![Value::U(0), wi, wo]).floats(),
            }
        };
        directions(120).flat_map(value).collect()
    }
}

/// The largest change of a value, relative to it; values below a thousandth of the largest do not count.
fn moved(with: &Shader, without: &Shader) -> f32 {
    let (with, without) = (with.values(), without.values());
    let floor = 1e-3 * with.iter().chain(&without).fold(0.0f32, |a, b| a.max(b.abs()));
    let change = |(a, b): (&f32, &f32)| (a - b).abs() / a.abs().max(b.abs()).max(floor);
    with.iter().zip(&without).map(change).fold(0.0, f32::max)
}

fn rough(layer: LayerRecord, alpha: f64) -> LayerRecord {
    LayerRecord { alpha, alpha_xy: [alpha; 2], tiles: layer.tiles.with([(TableKind::Distribution, None)]), ..layer }
}

fn coat() -> LayerRecord {
    rough(LayerRecord { distribution: Distribution::Ggx, ..dielectric() }, 0.3)
}

fn gold() -> LayerRecord {
    rough(conductor(), 0.4)
}

fn of(model: ShadingModel, layers: &[LayerRecord]) -> MaterialEntry {
    let layers: Vec<LayerRecord> = layers
        .iter()
        .map(|layer| LayerRecord {
            tiles: layer
                .tiles
                .with([(TableKind::Fgd, layer.tiles[TableKind::Fgd].or(Some(2))), (TableKind::Distribution, None)]),
            ..layer.clone()
        })
        .collect();
    let constants = MaterialConstants {
        phong_diffuse: [0.2; 3],
        phong_specular: [0.3; 3],
        phong_exponent: 5.0,
        ..MaterialConstants::default()
    };
    MaterialEntry { model, constants, ..material("sample", &layers) }
}

/// A material whose surface varies.
fn mapped(material: MaterialEntry) -> MaterialEntry {
    with_map(material, MapSlot::Normal, 0)
}

/// A material with a map of a layer.
pub(crate) fn with_map(material: MaterialEntry, slot: MapSlot, layer: u32) -> MaterialEntry {
    let file = FileEntry::default();
    let map = MapEntry {
        slot,
        layer: Some(layer),
        source: String::new(),
        file,
        width: 1,
        height: 1,
        factor: None,
        srgb: false,
        transform: None,
    };
    MaterialEntry { maps: vec![map], ..material }
}

/// Change of values when a feature is taken away; `None` where the shader is not where it is taken away.
fn change(model: ShadingModel, feature: Feature, form: Form) -> Option<f32> {
    let shader = |layers: &[LayerRecord]| Shader::new(of(model, layers), form);
    let tilted = || vector(&[0.28, 0.0, 0.96]);
    // Phong's coefficients are the baker's; what the twin in f64 makes of stacks is tested in luthier-scene.
    let is_coefficient = model == ShadingModel::Phong;
    Some(match feature {
        Feature::InnerInterface | Feature::Base | Feature::Absorption | Feature::BaseAbsorption | Feature::Films
            if is_coefficient =>
        {
            return None;
        }
        // In the baked form, tables hold them; records have no more than one film.
        Feature::Films if form == Form::Baked => return None,
        Feature::InnerFilms => return None,
        Feature::InnerInterface => moved(&shader(&[rough(clear(), 0.3), gold()]), &shader(&[rough(clear(), 0.3)])),
        Feature::Base => moved(&shader(&[coat(), diffuse(0.0)]), &shader(&[coat()])),
        Feature::Absorption | Feature::BaseAbsorption => {
            let without = LayerRecord { optical_depth: [0.0; 3], ..coat() };
            let below = if feature == Feature::Absorption { gold() } else { diffuse(0.0) };
            moved(&shader(&[coat(), below.clone()]), &shader(&[without, below]))
        }
        Feature::Films => {
            let film = LayerRecord { film_thickness_max_nm: 300.0, ..rough(filmed(), 0.3) };
            let without = LayerRecord {
                film_ior_n: [0.0; 3],
                tiles: film.tiles.with([(TableKind::Phase, None), (TableKind::Film, None)]),
                ..film.clone()
            };
            moved(&shader(&[film, gold()]), &shader(&[without, gold()]))
        }
        Feature::FilmVariation => {
            let material = || of(model, &[rough(filmed(), 0.3)]);
            let thicker = Shader::new(material(), form).at("film_factor", Value::F(1.3));
            moved(&thicker, &Shader::new(material(), form))
        }
        // A model of the first layer has the base as its first layer.
        Feature::DiffuseSlopes if model == ShadingModel::Microfacet => {
            moved(&shader(&[diffuse(0.6)]), &shader(&[diffuse(0.0)]))
        }
        Feature::DiffuseSlopes => moved(&shader(&[coat(), diffuse(0.6)]), &shader(&[coat(), diffuse(0.0)])),
        Feature::Anisotropy => {
            let brushed = LayerRecord { alpha_xy: [0.1, 0.9], rotation: 0.5, ..rough(conductor(), 0.3) };
            moved(&shader(&[brushed]), &shader(&[rough(conductor(), 0.3)]))
        }
        Feature::Beckmann => {
            let beckmann = LayerRecord { distribution: Distribution::Beckmann, ..gold() };
            moved(&shader(&[beckmann]), &shader(&[gold()]))
        }
        // Other models refuse such layers.
        Feature::Distribution if !model.honours(feature, form) => return None,
        Feature::Distribution => {
            // Smith's masking has no closed form for it.
            let cavities = || LayerRecord { masking: Masking::VCavity, ..gold() };
            let blinn = LayerRecord { distribution: Distribution::Blinn, ..cavities() };
            moved(&shader(&[blinn]), &shader(&[cavities()]))
        }
        Feature::NormalMap | Feature::RoughnessMap | Feature::ThicknessMap => {
            let (member, value) = match feature {
                Feature::NormalMap => ("normal", tilted()),
                Feature::RoughnessMap => ("alpha_factor", Value::F(0.5)),
                _ => ("slab_factor", Value::F(3.0)),
            };
            let material = || mapped(of(model, &[coat(), diffuse(0.0)]));
            moved(&Shader::new(material(), form).at(member, value), &Shader::new(material(), form))
        }
        Feature::AbsorptionMap | Feature::InnerAbsorptionMap => {
            let layer = u32::from(feature == Feature::InnerAbsorptionMap);
            let shader = || {
                let material = of(model, &[coat(), coat(), diffuse(0.0)]);
                Shader::new(with_map(material, MapSlot::Absorption, layer), form)
            };
            let tint = vector(&[0.2, 3.0, 1.0]);
            moved(&shader().at_layer(layer as usize, "absorption_factors", tint), &shader())
        }
        Feature::Bumps | Feature::LayerAlpha | Feature::Tangents | Feature::InnerThickness => {
            let brushed = || LayerRecord { alpha_xy: [0.1, 0.9], rotation: 0.5, ..rough(conductor(), 0.3) };
            let (layers, slot, layer, member, value) = match feature {
                Feature::Bumps => (vec![coat(), gold()], MapSlot::Bumps, 1, "normal", tilted()),
                Feature::LayerAlpha => (vec![gold()], MapSlot::Alpha, 0, "alpha_factors", vector(&[0.5, 0.5])),
                Feature::Tangents => (vec![brushed()], MapSlot::Tangent, 0, "tangent", vector(&[0.6, 0.8])),
                _ => (vec![coat(), coat(), diffuse(0.0)], MapSlot::Thickness, 1, "slab_factor", Value::F(3.0)),
            };
            let shader = || Shader::new(with_map(of(model, &layers), slot, layer), form);
            moved(&shader().at_layer(layer as usize, member, value), &shader())
        }
        Feature::AlbedoMap if model == ShadingModel::Microfacet => {
            let shader = || Shader::new(with_map(of(model, &[diffuse(0.0)]), MapSlot::Albedo, 0), form);
            moved(&shader().at("base_color", vector(&[0.9, 0.1, 0.5])), &shader())
        }
        Feature::AlbedoMap => {
            let shader = || Shader::new(with_map(of(model, &[coat(), diffuse(0.0)]), MapSlot::Albedo, 1), form);
            moved(&shader().at("base_color", vector(&[0.9, 0.1, 0.5])), &shader())
        }
        Feature::LeanMap if model != ShadingModel::GranierHeidrich => return None,
        Feature::LeanMap => {
            let shader = || Shader::new(with_map(of(model, &[coat(), diffuse(0.0)]), MapSlot::Lean, 0), form);
            moved(&shader().at("inner_normal", tilted()), &shader())
        }
        Feature::MetallicMap => {
            let shader = || Shader::new(with_map(of(model, &[coat(), diffuse(0.0)]), MapSlot::Metallic, 0), form);
            moved(&shader().at_layer(0, "passing", vector(&[0.2, 0.5, 0.9])), &shader())
        }
        // The baker writes no surface without the film for models that do not show it.
        Feature::FilmWeight => return None,
        // The baker writes no matrix for models that do not show it.
        Feature::Reradiation if !model.honours(feature, form) => return None,
        Feature::Reradiation => moved(&shader(&[coat(), fluorescent()]), &shader(&[coat(), diffuse(0.0)])),
        Feature::Flakes | Feature::Patina | Feature::Weight | Feature::Glitter => {
            let plain = || of(model, &[coat(), gold()]);
            let patina = || LayerRecord { tiles: gold().tiles.with([(TableKind::Fgd, Some(2))]), ..gold() };
            let constants = match feature {
                Feature::Flakes => MaterialConstants { flakes: Some(FLAKES), ..plain().constants },
                Feature::Glitter => MaterialConstants { glitter: Some(GLITTER), ..plain().constants },
                Feature::Weight => {
                    let coat = luthier_manifest::CoatRecord { weight: 0.5, bare: patina(), side: None };
                    MaterialConstants { coat: Some(coat), ..plain().constants }
                }
                _ => {
                    let record = self::patina().constants.patina.unwrap();
                    let record = luthier_manifest::PatinaRecord { bare: patina(), ..record };
                    MaterialConstants { patina: Some(record), ..plain().constants }
                }
            };
            if feature == Feature::Weight {
                // A place without textures shows the weight.
                let shader = |constants| Shader::new(MaterialEntry { constants, ..plain() }, form);
                return Some(moved(&shader(constants), &shader(plain().constants)));
            }
            let shader = || Shader::new(MaterialEntry { constants: constants.clone(), ..plain() }, form);
            let with = match feature {
                Feature::Flakes => shader().at("flake_normal", tilted()),
                Feature::Glitter => {
                    let shader = shader();
                    let uv = |i: u32| vector(&[0.618 * i as f32 % 1.0, 0.414 * i as f32 % 1.0]);
                    let normal = |i| shader.machine.call("luthier_glitter_normal", vec![Value::U(0), uv(i)]);
                    let normal = (0..200).map(normal).find(|normal| normal.floats()[2] < 0.99).unwrap();
                    shader.at("normal", normal)
                }
                _ => shader().at("patina", Value::F(0.6)),
            };
            moved(&with, &shader())
        }
    })
}

#[test]
fn models_show_what_the_table_says() {
    let mut wrong = Vec::new();
    let mut tried = 0;
    // Rows have all that a stack has: for them, `luthier-scene/tests/left_out.rs` has the twin.
    for model in ShadingModel::ALL.into_iter().filter(|model| *model != ShadingModel::Lobes) {
        for feature in Feature::ALL {
            for form in Form::ALL {
                let Some(change) = change(model, feature, form) else { continue };
                tried += 1;
                let (says, does) = (model.honours(feature, form), change > SHOWN);
                if says != does || !does && change > 1e-5 {
                    wrong.push(format!("{} {feature:?} {form}: {says} in the table, moved by {change}", model.name()));
                }
            }
        }
    }
    assert!(tried > 150, "{tried}");
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}
