//! Tests of the parameters that the window edits.

use std::path::Path;

use luthier_material::{parse, rewritten};

use super::*;

/// A film over a coat over a metal, with everything else that can be edited.
const EVERYTHING: &str = r#"
schema = 1
name = "everything"

[[layer]]
type = "thin-film"
ior = 2.0
thickness_nm = { min = 100, max = 300, extent_um = 1000, map = { noise = {} } }

[[layer]]
type = "dielectric"
ior = 1.5
alpha = 0.1
thickness_um = 10
absorption_per_um = [0.1, 0.2, 0.3]

[[layer]]
type = "thin-film"
ior = 1.8
thickness_nm = 50

[[layer]]
type = "conductor"
ior = { n = 0.5, k = 3.0 }
alpha_x = 0.2
alpha_y = 0.4

[effects]
glitter = {}
flakes = { cells = {} }

[effects.patina]
extent = 0.5
transition = 0.25
map = { noise = {} }
base_alpha = 0.3
"#;

const MATTE: &str = "schema = 1\nname = \"matte\"\n[[layer]]\ntype = \"diffuse\"\nalbedo = 0.5\n";

fn material(text: &str) -> Material {
    let no_files = |_: &str| Err(std::io::ErrorKind::NotFound.into());
    parse("m.toml", text, &no_files).unwrap().material
}

fn all(material: &Material) -> Vec<Parameter> {
    groups(material).into_iter().flat_map(|group| group.parameters).collect()
}

#[test]
fn what_there_is_to_edit() {
    let everything = material(EVERYTHING);
    let titles: Vec<String> = groups(&everything).into_iter().map(|group| group.title).collect();
    assert_eq!(titles, ["1 · dielectric", "2 · conductor", "patina", "flakes", "glitter"]);
    assert_eq!(all(&everything).len(), 9 + 7 + 3 + 4 + 3);
    assert_eq!(all(&material(MATTE)).len(), 4);
}

/// The middle of each range arrives in the material, and what is set is what is read.
#[test]
fn every_parameter_reads_what_was_set() {
    for text in [EVERYTHING, MATTE] {
        for Parameter { handle, range, .. } in all(&material(text)) {
            let mut edited = material(text);
            let before = handle.get(&edited).unwrap();
            assert!(range.contains(&before), "{handle:?}: {before}");
            let value = 0.5 * (range.start() + range.end()) + 0.0137;
            handle.set(&mut edited, value);
            assert!((handle.get(&edited).unwrap() - value).abs() < 1e-9, "{handle:?}");
            assert!(edited != material(text), "{handle:?} changed nothing");
        }
    }
}

#[test]
fn values_stay_within_their_range() {
    for text in [EVERYTHING, MATTE] {
        for Parameter { handle, range, .. } in all(&material(text)) {
            for wild in [-1e9, 1e9, f64::NAN, f64::INFINITY] {
                let mut edited = material(text);
                handle.set(&mut edited, wild);
                let value = handle.get(&edited).unwrap();
                assert!(*range.start() - 1e-9 <= value && value <= *range.end() + 1e-9, "{handle:?} {wild}: {value}");
            }
        }
    }
}

#[test]
fn edits_reach_the_stack() {
    let mut edited = material(EVERYTHING);
    Handle::Alpha(0).set(&mut edited, 0.7);
    Handle::SlabThickness(0).set(&mut edited, 25.0);
    Handle::IorN(0).set(&mut edited, 1.7);
    Handle::FilmThickness(1, 0).set(&mut edited, 80.0);
    Handle::IorK(1).set(&mut edited, 4.0);
    Handle::Rotation(1).set(&mut edited, 90.0);
    let [coat, metal] = &edited.stack.layers[..] else { panic!("two layers") };
    assert_eq!(coat.surface, Surface { alpha_x: 0.7, alpha_y: 0.7, ..material(EVERYTHING).stack.layers[0].surface });
    let Base::Dielectric { ior, slab } = &coat.base else { panic!("a coat") };
    assert_eq!((ior.at(500.0).re, slab.thickness_um), (1.7, 25.0));
    let depths = [2.5, 5.0, 7.5];
    slab.optical_depth().iter().zip(depths).for_each(|(d, expected)| assert!((d - expected).abs() < 1e-12));
    assert_eq!((metal.films[0].thickness.min_nm, metal.films[0].thickness.max_nm), (80.0, 80.0));
    let Base::Conductor { ior } = &metal.base else { panic!("a metal") };
    assert_eq!((ior.at(500.0).re, ior.at(500.0).im), (0.5, 4.0));
    assert!((metal.surface.rotation - FRAC_PI_2).abs() < 1e-12);
    assert_eq!(edited.class, SurfaceClass::of(&edited.stack));
}

/// Limits of a film that varies never meet: the shader would be another one.
#[test]
fn a_film_keeps_its_variation() {
    let mut edited = material(EVERYTHING);
    Handle::FilmMin(0, 0).set(&mut edited, 5000.0);
    let thickness = edited.stack.layers[0].films[0].thickness;
    assert_eq!((thickness.min_nm, thickness.max_nm), (1999.0, 2000.0));
    Handle::FilmMax(0, 0).set(&mut edited, 0.0);
    let thickness = edited.stack.layers[0].films[0].thickness;
    assert_eq!((thickness.min_nm, thickness.max_nm), (1.0, 2.0));
}

#[test]
fn a_narrower_transition_pulls_the_extent_along() {
    let mut edited = material(EVERYTHING);
    Handle::PatinaExtent.set(&mut edited, 1.25);
    Handle::PatinaTransition.set(&mut edited, 0.1);
    assert!((edited.effects.patina.unwrap().extent - 1.1).abs() < 1e-12);
}

#[test]
fn handles_that_a_material_lacks_change_nothing() {
    let mut edited = material(MATTE);
    for handle in [Handle::Alpha(0), Handle::IorN(0), Handle::SlabThickness(0), Handle::Alpha(7), Handle::PatinaExtent]
    {
        handle.set(&mut edited, 0.5);
    }
    assert_eq!(edited, material(MATTE));
    assert_eq!(Handle::PatinaExtent.get(&edited), None);
    assert_eq!(Handle::Albedo(0, 3).get(&edited), None);
}

/// An F0 has three numbers and no index; a medium above it does not become the denser one.
#[test]
fn an_f0_is_edited_by_channel() {
    let coat = |lines: &str| format!("[[layer]]\ntype = \"dielectric\"\nsmooth = true\n{lines}\n");
    let two = coat("ior = 1.5") + &coat("f0 = 0.04\nior = 1.6");
    let mut two = material(&format!("schema = 1\nname = \"two\"\n{two}"));
    let handles: Vec<Handle> = all(&two).into_iter().map(|parameter| parameter.handle).collect();
    assert!((0..3).all(|c| handles.contains(&Handle::F0(1, c))) && !handles.contains(&Handle::IorN(1)));
    Handle::F0(1, 1).set(&mut two, 0.5);
    assert_eq!([0, 1, 2].map(|c| Handle::F0(1, c).get(&two)), [0.04, 0.5, 0.04].map(Some));
    let index = |material: &Material| base_ior(material, 1).and_then(constant_ior).map(|[n, _]| n);
    assert_eq!(index(&two), Some(1.6));
    Handle::IorN(0).set(&mut two, 2.0);
    assert_eq!(index(&two), Some(2.0));
    assert_eq!(Handle::F0(1, 1).get(&two), Some(0.5));
}

/// A text that holds another value of any parameter is that of the edited material.
fn check_texts(label: &str, text: &str, read: &dyn Fn(&str) -> std::io::Result<String>) -> usize {
    let parse = |text: &str| parse(label, text, read).map(|parsed| parsed.material);
    let original = parse(text).unwrap();
    let parameters = all(&original);
    for Parameter { handle, range, logarithmic, .. } in &parameters {
        let (low, high) = (*range.start(), *range.end());
        // As a slider leaves it: a number of few digits.
        let value = if *logarithmic { low.max(1e-3) * 1.25 } else { low + 0.375 * (high - low) };
        let mut edited = original.clone();
        handle.set(&mut edited, value);
        let written =
            rewritten(&original, &edited).unwrap_or_else(|refusal| panic!("{label}: {handle:?}: {refusal:?}"));
        let found = parse(&written).unwrap_or_else(|errors| panic!("{label}: {handle:?}: {errors:?}\n{written}"));
        assert_eq!(found.stack, edited.stack, "{label}: {handle:?}\n{written}");
        assert_eq!(
            (&found.layers, &found.effects),
            (&edited.layers, &edited.effects),
            "{label}: {handle:?}\n{written}"
        );
        assert_eq!((&found.bake, &found.budget), (&edited.bake, &edited.budget), "{label}: {handle:?}\n{written}");
        assert_eq!(found.class, edited.class, "{label}: {handle:?}\n{written}");
    }
    parameters.len()
}

#[test]
fn every_parameter_has_a_text() {
    let no_files = |_: &str| Err(std::io::ErrorKind::NotFound.into());
    assert_eq!(check_texts("everything", EVERYTHING, &no_files), 26);
    assert_eq!(check_texts("matte", MATTE, &no_files), 4);
}

#[test]
fn shipped_materials_have_texts_of_their_edits() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../materials");
    let mut parameters = 0;
    let entries = ["", "papers"].into_iter().flat_map(|inner| std::fs::read_dir(folder.join(inner)).unwrap());
    for entry in entries {
        let path = entry.unwrap().path();
        if path.extension().is_some_and(|e| e == "toml") {
            let read = |name: &str| std::fs::read_to_string(folder.join(name));
            let text = std::fs::read_to_string(&path).unwrap();
            parameters += check_texts(&path.file_name().unwrap().to_string_lossy(), &text, &read);
        }
    }
    assert!(parameters > 150, "{parameters}");
}
