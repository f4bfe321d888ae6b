//! Materials of the database physicallybased.info.

use std::io::ErrorKind;

use luthier_import::{Fate, Import, import};
use luthier_material::parse;

const DATABASE: &str = r#"{
  "header": {"schemaVersion": 2.1},
  "data": [
    {"name": "Aluminum", "metalness": 1, "roughness": 0,
     "color": [{"colorSpace": "acescg", "color": [0.918, 0.922, 0.923]}, {"colorSpace": "srgb-linear", "color": [0.916, 0.923, 0.924]}],
     "specularColor": [{"format": ["Gulbrandsen"], "color": [{"colorSpace": "srgb-linear", "color": [0.9, 0.9, 0.9]}]},
                       {"format": ["F82"], "color": [{"colorSpace": "srgb-linear", "color": [0.91, 0.936, 0.959]}]}],
     "complexIor": [], "density": [2700],
     "references": [{"title": "A \"quoted\" title", "author": "Polyanskiy, M. N.", "url": "https://refractiveindex.info"}]},
    {"name": "Titanium (Anodized)", "metalness": 1, "roughness": 0.3, "color": [{"colorSpace": "srgb-linear", "color": [0.54, 0.5, 0.45]}],
     "specularColor": [{"format": ["F82"], "color": [{"colorSpace": "srgb-linear", "color": [0.9, 0.9, 0.9]}]}],
     "thinFilmThickness": [20, 300], "thinFilmIor": 2.488},
    {"name": "Amber", "metalness": 0, "roughness": 0, "ior": 1.5, "transmission": 1, "color": [{"colorSpace": "srgb-linear", "color": [0.83, 0.288, -0.036]}],
     "subsurfaceRadius": [1, 1, 1], "novelty": 3}
  ]
}"#;

fn imported() -> Import {
    import("materials.json", DATABASE.as_bytes(), &|_| Err(ErrorKind::NotFound.into())).unwrap()
}

#[test]
fn every_entry_is_a_material() {
    let found = imported();
    let names: Vec<&str> = found.materials.iter().map(|material| material.name.as_str()).collect();
    assert_eq!(names, ["aluminum", "titanium-anodized", "amber"]);
    for material in &found.materials {
        let parsed = parse("x.toml", &material.text, &|_| Err(ErrorKind::NotFound.into()));
        assert!(parsed.is_ok(), "{parsed:?}\n{}", material.text);
    }
    let [metal, film, glass] = found.materials.as_slice() else { panic!() };
    assert!(metal.text.contains("f0 = [0.916, 0.923, 0.924]\nf82_tint = [0.91, 0.936, 0.959]\nsmooth = true"));
    assert!(metal.text.contains("A \\\"quoted\\\" title"), "{}", metal.text);
    assert!(film.text.contains("thickness_nm = 300.0") && !film.text.contains("f82_tint"), "{}", film.text);
    assert!(glass.text.contains("base_color = [0.83, 0.288, 0.0]") && glass.text.contains("f0 = 0.04\n"));
    let fate = |property: &str| glass.lines.iter().find(|line| line.property == property).map(|line| line.fate);
    for (property, expected) in [
        ("color", Fate::Approximated),
        ("transmission", Fate::Dropped),
        ("subsurfaceRadius", Fate::Dropped),
        ("novelty", Fate::Dropped),
        ("ior", Fate::ClosedForm),
    ] {
        assert_eq!(fate(property), Some(expected), "{property}");
    }
}

#[test]
fn mistakes_have_a_line() {
    let text = DATABASE.replace("\"roughness\": 0.3", "\"roughness\": \"rough\"");
    let error = import("materials.json", text.as_bytes(), &|_| Err(ErrorKind::NotFound.into())).unwrap_err();
    assert!(error.to_string().contains("line 10"), "{error}");
}
