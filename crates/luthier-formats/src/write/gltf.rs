//! glTF 2.0: a file of materials, without a mesh.

use luthier_material::UvTransform;
use serde_json::{Map, Value, json};

use super::{Named, rounded};
use crate::maps::{Slot, Texture};
use crate::{Coat, Film, Numbers};

/// The file as text.
pub(super) fn text(materials: &[Named<'_>], generator: &str) -> String {
    let mut file = File::default();
    let written: Vec<Value> = materials.iter().map(|material| file.material(material)).collect();
    let mut root = Map::new();
    root.insert("asset".to_owned(), json!({ "version": "2.0", "generator": generator }));
    if !file.extensions.is_empty() {
        root.insert("extensionsUsed".to_owned(), json!(file.extensions));
    }
    if !file.images.is_empty() {
        root.insert("images".to_owned(), file.images.iter().map(|path| json!({ "uri": path })).collect());
        root.insert("textures".to_owned(), (0..file.images.len()).map(|source| json!({ "source": source })).collect());
    }
    root.insert("materials".to_owned(), Value::Array(written));
    format!("{:#}\n", Value::Object(root))
}

#[derive(Default)]
struct File {
    /// Extensions that are used, sorted.
    extensions: std::collections::BTreeSet<&'static str>,
    /// Paths of pictures, each once; a texture has the number of its picture.
    images: Vec<String>,
}

fn color(rgb: [f64; 3]) -> Value {
    json!(rgb.map(rounded))
}

/// An object without its members that have a value that need not be said.
fn said<const N: usize>(members: [(&str, Option<Value>); N]) -> Value {
    members.into_iter().filter_map(|(name, value)| Some((name.to_owned(), value?))).collect::<Map<_, _>>().into()
}

/// A number unless it is the default.
fn unless(value: f64, default: f64) -> Option<Value> {
    let value = rounded(value);
    (value != default).then(|| json!(value))
}

impl File {
    fn material(&mut self, material: &Named<'_>) -> Value {
        let numbers = &material.of.numbers;
        let [r, g, b] = numbers.base_color.map(rounded);
        let metallic = said([
            ("baseColorFactor", (numbers.base_color != [1.0; 3]).then(|| json!([r, g, b, 1.0]))),
            ("baseColorTexture", self.texture(material, Slot::BaseColor)),
            ("metallicFactor", unless(numbers.metallic, 1.0)),
            ("roughnessFactor", unless(numbers.roughness, 1.0)),
            ("metallicRoughnessTexture", self.texture(material, Slot::RoughnessAndMetal)),
        ]);
        let normal = self.texture(material, Slot::Normal);
        let mut extensions = Map::new();
        let mut add = |name: &'static str, value: Option<Value>| {
            if let Some(value) = value {
                extensions.insert(name.to_owned(), value);
            }
        };
        add("KHR_materials_anisotropy", self.anisotropy(material, numbers));
        add("KHR_materials_clearcoat", numbers.coat.as_ref().map(|coat| self.coat(material, coat)));
        add("KHR_materials_ior", unless(numbers.ior, 1.5).map(|ior| json!({ "ior": ior })));
        add("KHR_materials_iridescence", numbers.film.as_ref().map(|film| self.film(material, film)));
        add("KHR_materials_specular", self.specular(material, numbers));
        self.extensions.extend(
            [
                "KHR_materials_anisotropy",
                "KHR_materials_clearcoat",
                "KHR_materials_ior",
                "KHR_materials_iridescence",
                "KHR_materials_specular",
            ]
            .into_iter()
            .filter(|name| extensions.contains_key(*name)),
        );
        said([
            ("name", Some(json!(material.name))),
            ("pbrMetallicRoughness", Some(metallic)),
            ("normalTexture", normal),
            ("extensions", (!extensions.is_empty()).then_some(Value::Object(extensions))),
        ])
    }

    fn coat(&mut self, material: &Named<'_>, coat: &Coat) -> Value {
        said([
            ("clearcoatFactor", unless(coat.weight, 0.0)),
            ("clearcoatTexture", self.texture(material, Slot::CoatWeight)),
            ("clearcoatRoughnessFactor", unless(coat.roughness, 0.0)),
            ("clearcoatRoughnessTexture", self.texture(material, Slot::CoatRoughness)),
            ("clearcoatNormalTexture", self.texture(material, Slot::CoatNormal)),
        ])
    }

    fn film(&mut self, material: &Named<'_>, film: &Film) -> Value {
        let [least, most] = film.thickness_nm;
        let map = self.texture(material, Slot::FilmThickness);
        said([
            ("iridescenceFactor", unless(film.weight, 0.0)),
            ("iridescenceTexture", self.texture(material, Slot::FilmWeight)),
            ("iridescenceIor", unless(film.ior, 1.3)),
            ("iridescenceThicknessMinimum", map.as_ref().and_then(|_| unless(least, 100.0))),
            ("iridescenceThicknessMaximum", unless(most, 400.0)),
            ("iridescenceThicknessTexture", map),
        ])
    }

    fn specular(&mut self, material: &Named<'_>, numbers: &Numbers) -> Option<Value> {
        let map = self.texture(material, Slot::SpecularColor);
        let tint = numbers.specular_color;
        let is_plain = numbers.specular == 1.0 && tint == [1.0; 3] && map.is_none();
        (!is_plain).then(|| {
            said([
                ("specularFactor", unless(numbers.specular, 1.0)),
                ("specularColorFactor", (tint != [1.0; 3]).then(|| color(tint))),
                ("specularColorTexture", map),
            ])
        })
    }

    fn anisotropy(&mut self, material: &Named<'_>, numbers: &Numbers) -> Option<Value> {
        (numbers.anisotropy > 0.0).then(|| {
            said([
                ("anisotropyStrength", unless(numbers.anisotropy, 0.0)),
                ("anisotropyRotation", unless(numbers.turn, 0.0)),
                ("anisotropyTexture", self.texture(material, Slot::Anisotropy)),
            ])
        })
    }

    /// A reference to a texture.
    fn texture(&mut self, material: &Named<'_>, slot: Slot) -> Option<Value> {
        let (path, texture) = material.textures.iter().find(|(_, texture)| texture.slot == slot)?;
        let index = self.images.iter().position(|known| known == path).unwrap_or_else(|| {
            self.images.push(path.clone());
            self.images.len() - 1
        });
        let Texture { scale, transform, .. } = texture;
        let is_normal = matches!(slot, Slot::Normal | Slot::CoatNormal);
        let transform = transform.as_ref().map(|transform| {
            self.extensions.insert("KHR_texture_transform");
            json!({ "KHR_texture_transform": placement(transform) })
        });
        Some(said([
            ("index", Some(json!(index))),
            ("scale", if is_normal { unless(*scale, 1.0) } else { None }),
            ("extensions", transform),
        ]))
    }
}

/// A placement; the format turns the other way.
fn placement(transform: &UvTransform) -> Value {
    let UvTransform { offset, rotation, scale } = transform;
    said([
        ("offset", (*offset != [0.0; 2]).then(|| json!(offset.map(rounded)))),
        ("rotation", unless(-rotation, 0.0)),
        ("scale", (*scale != [1.0; 2]).then(|| json!(scale.map(rounded)))),
    ])
}
