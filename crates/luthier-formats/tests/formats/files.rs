//! The files as their formats have them.

use std::collections::BTreeSet;
use std::io;

use luthier_formats::{Exported, Fate, Format, WriteError, files};
use luthier_import::import;
use serde_json::Value;

use super::{imported, of_repository, quick};

/// Two materials of one name get two names, and extensions are listed that are used, and no others.
#[test]
fn gltf_names_its_extensions() {
    let (lacquer, beside) = of_repository("materials/car-paint.toml");
    let once = quick(&lacquer, Format::Gltf, &beside);
    let files = files(Format::Gltf, &[once.clone(), once], "test").unwrap();
    assert_eq!(files.keys().collect::<Vec<_>>(), ["materials.gltf"]);
    let root: Value = serde_json::from_slice(&files["materials.gltf"]).unwrap();
    assert_eq!(root["asset"]["version"], "2.0");
    assert_eq!(root["extensionsUsed"], serde_json::json!(["KHR_materials_clearcoat"]));
    let names: Vec<&str> =
        root["materials"].as_array().unwrap().iter().map(|of| of["name"].as_str().unwrap()).collect();
    assert_eq!(names, ["car-paint", "car-paint-2"]);
}

/// A material may be called as the shader of another.
#[test]
fn names_of_materialx_are_of_one_element() {
    let (oak, beside) = of_repository("materials/textured/board/varnished-oak.toml");
    let once = quick(&oak, Format::OpenPbr, &beside);
    let called = |name: &str| Exported { name: name.to_owned(), ..once.clone() };
    let all = ["SR-x", "x", "NG-x", "SR-x-", "1x"].map(called);
    let files = files(Format::OpenPbr, &all, "test").unwrap();
    let text = std::str::from_utf8(&files["materials.mtlx"]).unwrap();
    let document = roxmltree::Document::parse(text).unwrap();
    let elements = document.root_element().children().filter(roxmltree::Node::is_element);
    let mut names: Vec<&str> = elements.clone().map(|element| element.attribute("name").unwrap()).collect();
    let count = names.len();
    names.sort_unstable();
    names.dedup();
    assert_eq!(names.len(), count);
    let materials = elements.filter(|element| element.has_tag_name("surfacematerial"));
    assert_eq!(
        materials.map(|of| of.attribute("name").unwrap()).collect::<Vec<_>>(),
        ["SR_x", "x", "NG_x", "SR_x_", "_1x"]
    );
    let reader = |path: &str| files.get(path).cloned().ok_or_else(|| io::Error::from(io::ErrorKind::NotFound));
    assert_eq!(import("materials.mtlx", text.as_bytes(), &reader).unwrap().materials.len(), all.len());
}

/// Pictures whose names differ by case alone are two files on all file systems.
#[test]
fn pictures_differ_by_more_than_case() {
    let (oak, beside) = of_repository("materials/textured/board/varnished-oak.toml");
    let mut once = quick(&oak, Format::Gltf, &beside);
    let mut loud = once.clone();
    for texture in &mut once.textures {
        texture.name = "wood.png".to_owned();
    }
    for texture in &mut loud.textures {
        texture.name = "Wood.png".to_owned();
        texture.bytes.push(0);
    }
    let files = files(Format::Gltf, &[once, loud], "test").unwrap();
    let paths: BTreeSet<String> = files.keys().map(|path| path.to_ascii_lowercase()).collect();
    assert_eq!(paths.len(), files.len());
}

/// Every input of the shaders is one that the format defines, of its type.
#[test]
fn materialx_has_inputs_of_the_shader() {
    const OPENPBR: &str = "base_weight base_color base_diffuse_roughness base_metalness specular_weight specular_color specular_roughness specular_ior \
        specular_roughness_anisotropy coat_weight coat_color coat_roughness coat_roughness_anisotropy coat_ior coat_darkening thin_film_weight \
        thin_film_thickness thin_film_ior geometry_normal geometry_coat_normal geometry_tangent geometry_coat_tangent";
    const STANDARD: &str = "base base_color diffuse_roughness metalness specular specular_color specular_roughness specular_IOR specular_anisotropy \
        specular_rotation coat coat_color coat_roughness coat_anisotropy coat_rotation coat_IOR coat_normal thin_film_thickness thin_film_IOR normal";
    for (format, category, known) in
        [(Format::OpenPbr, "open_pbr_surface", OPENPBR), (Format::StandardSurface, "standard_surface", STANDARD)]
    {
        for name in ["red-lacquer", "brushed-aluminium", "soap-film", "textured/board/varnished-oak"] {
            let (material, beside) = of_repository(&format!("materials/{name}.toml"));
            let files = files(format, &[quick(&material, format, &beside)], "test").unwrap();
            let text = std::str::from_utf8(&files["materials.mtlx"]).unwrap();
            let document = roxmltree::Document::parse(text).unwrap();
            let shader = document.descendants().find(|node| node.has_tag_name(category)).unwrap();
            let inputs: Vec<_> = shader.children().filter(|node| node.is_element()).collect();
            for input in &inputs {
                let name = input.attribute("name").unwrap();
                assert!(known.split_whitespace().any(|known| known == name), "{name}");
                let is_color = name.ends_with("color");
                let is_vector = name.contains("normal") || name.contains("tangent");
                let kind = if is_color {
                    "color3"
                } else if is_vector {
                    "vector3"
                } else {
                    "float"
                };
                assert_eq!(input.attribute("type"), Some(kind), "{name}");
                // A value, or an output that is there.
                if let Some(output) = input.attribute("output") {
                    assert!(
                        document
                            .descendants()
                            .any(|node| node.has_tag_name("output") && node.attribute("name") == Some(output))
                    );
                }
            }
            for picture in document.descendants().filter(|node| node.attribute("name") == Some("file")) {
                assert!(files.contains_key(picture.attribute("value").unwrap()));
            }
        }
    }
}

/// Properties that no format has are told: colours below an absorbing coat of glTF, flakes, and the roughness of a diffuse base.
#[test]
fn what_is_lost_is_told() {
    let said = |name: &str, format: Format| {
        let (material, beside) = of_repository(&format!("materials/{name}.toml"));
        quick(&material, format, &beside).lines
    };
    let has = |lines: &[luthier_formats::Line], property: &str, fate: Fate| {
        assert!(lines.iter().any(|line| line.property == property && line.fate == fate), "{property}: {lines:?}");
    };
    has(&said("house-paint", Format::Gltf), "base: sigma", Fate::Dropped);
    has(&said("house-paint", Format::StandardSurface), "base: sigma", Fate::Kept);
    has(&said("car-paint", Format::Gltf), "coat: absorption", Fate::Approximated);
    has(&said("car-paint", Format::OpenPbr), "coat: absorption", Fate::ClosedForm);
    has(&said("copper-patina", Format::OpenPbr), "patina", Fate::Dropped);
    has(&said("soap-film", Format::Gltf), "film: noise of its thickness", Fate::Dropped);
}

#[test]
fn formats_are_not_mixed() {
    let found = imported("x.gltf", r#"{"asset": {"version": "2.0"}, "materials": [{}]}"#);
    let none = |_: &str| Err(std::io::ErrorKind::NotFound.into());
    let white = quick(&found[0].0, Format::Gltf, &none);
    assert!(white.lobe_error() < 1.0);
    assert_eq!(files(Format::OpenPbr, &[white], "test"), Err(WriteError::Mixed { name: "material-0".to_owned() }));
}
