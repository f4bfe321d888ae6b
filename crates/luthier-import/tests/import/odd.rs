//! Materials with odd numbers: each is a material file that can be read, whatever the numbers are.

use std::io::ErrorKind;

use luthier_import::gltf;
use luthier_material::parse;
use proptest::prelude::*;
use serde_json::{Map, Value, json};

/// Numbers within the format, at its ends and beyond.
const NUMBERS: [f64; 14] = [0.0, 1.0, 0.5, 0.04, 1e-9, 0.999_999, -1.0, 1.5, 2.42, 400.0, 1e6, 1e30, -1e30, 1.0e-40];

/// Properties that are numbers, colours and textures, by the path to them.
const PROPERTIES: [(&str, &str); 26] = [
    ("/pbrMetallicRoughness/metallicFactor", "number"),
    ("/pbrMetallicRoughness/roughnessFactor", "number"),
    ("/pbrMetallicRoughness/baseColorFactor", "rgba"),
    ("/pbrMetallicRoughness/baseColorTexture", "texture"),
    ("/pbrMetallicRoughness/metallicRoughnessTexture", "texture"),
    ("/normalTexture", "texture"),
    ("/extensions/KHR_materials_clearcoat/clearcoatFactor", "number"),
    ("/extensions/KHR_materials_clearcoat/clearcoatRoughnessFactor", "number"),
    ("/extensions/KHR_materials_clearcoat/clearcoatTexture", "texture"),
    ("/extensions/KHR_materials_clearcoat/clearcoatRoughnessTexture", "texture"),
    ("/extensions/KHR_materials_clearcoat/clearcoatNormalTexture", "texture"),
    ("/extensions/KHR_materials_ior/ior", "number"),
    ("/extensions/KHR_materials_specular/specularFactor", "number"),
    ("/extensions/KHR_materials_specular/specularColorFactor", "rgb"),
    ("/extensions/KHR_materials_specular/specularTexture", "texture"),
    ("/extensions/KHR_materials_specular/specularColorTexture", "texture"),
    ("/extensions/KHR_materials_anisotropy/anisotropyStrength", "number"),
    ("/extensions/KHR_materials_anisotropy/anisotropyRotation", "number"),
    ("/extensions/KHR_materials_anisotropy/anisotropyTexture", "texture"),
    ("/extensions/KHR_materials_iridescence/iridescenceFactor", "number"),
    ("/extensions/KHR_materials_iridescence/iridescenceIor", "number"),
    ("/extensions/KHR_materials_iridescence/iridescenceThicknessMinimum", "number"),
    ("/extensions/KHR_materials_iridescence/iridescenceThicknessMaximum", "number"),
    ("/extensions/KHR_materials_iridescence/iridescenceTexture", "texture"),
    ("/extensions/KHR_materials_iridescence/iridescenceThicknessTexture", "texture"),
    ("/extensions/KHR_materials_transmission/transmissionFactor", "number"),
];

/// Puts a value at a path, with objects on the way.
fn put(root: &mut Value, path: &str, value: Value) {
    let mut place = root;
    for name in path.split('/').skip(1) {
        if !place.is_object() {
            *place = Value::Object(Map::new());
        }
        place = &mut place[name];
    }
    *place = value;
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 600, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn every_import_is_a_material(
        chosen in prop::collection::vec((0..PROPERTIES.len(), prop::array::uniform4(0..NUMBERS.len())), 0..14),
    ) {
        let mut material = json!({});
        for (property, numbers) in chosen {
            let (path, kind) = PROPERTIES[property];
            let [r, g, b, a] = numbers.map(|number| NUMBERS[number]);
            let value = match kind {
                "number" => json!(r),
                "rgb" => json!([r, g, b]),
                "rgba" => json!([r, g, b, a]),
                _ => json!({
                    "index": 0, "scale": r,
                    "extensions": { "KHR_texture_transform": { "offset": [g, b], "rotation": a, "scale": [r, b] } },
                }),
            };
            put(&mut material, path, value);
        }
        let text = json!({
            "asset": { "version": "2.0" },
            "images": [crate::gltf::picture([[255, 0, 128], [13, 77, 0]])],
            "textures": [{ "source": 0 }],
            "materials": [material],
        });
        let import = gltf("odd.gltf", text.to_string().as_bytes(), &|_| Err(ErrorKind::NotFound.into())).unwrap();
        let imported = &import.materials[0];
        let parsed = parse("odd.toml", &imported.text, &|_| Err(ErrorKind::NotFound.into()));
        let said = parsed.as_ref().err().map(|errors| errors.iter().map(|e| e.render(&imported.text)).collect::<String>());
        prop_assert!(parsed.is_ok(), "{}\n{}", said.unwrap_or_default(), imported.text);
        // Pictures that the text names are there, and no others.
        let named = |path: &&String| imported.text.contains(&format!("\"{path}\""));
        prop_assert!(import.pictures.keys().all(|path| named(&path)), "{:?}\n{}", import.pictures.keys(), imported.text);
    }
}
