//! Texts in TOML: materials and scenes.

use std::io;
use std::ops::RangeInclusive;

use luthier_manifest::{ShadingModel, SwitchBy};
use luthier_material::{
    Diagnostic, FileKind, Light, Material, SurfaceClass, left_out, parse, parse_partly, parse_scene, parse_surface,
};
use luthier_optics::stack::{Base, Stack};

/// Most errors and warnings that are listed: 20 of each, and how many more there are.
const LISTED_MAX: usize = 42;

/// Characters of the longest message.
const MESSAGE_MAX: usize = 700;

/// A material file. After a NUL, the contents of any CSV file that it names.
pub(super) fn material(bytes: &[u8]) {
    let text = String::from_utf8_lossy(bytes);
    let (text, csv) = text.split_once('\0').unwrap_or((&text, ""));
    let read = |_: &str| if csv.is_empty() { Err(io::Error::other("none")) } else { Ok(csv.to_owned()) };
    match parse("m.toml", text, &read) {
        Ok(parsed) => {
            assert!(FileKind::of(text) == FileKind::Material, "a material that is not recognised");
            can_be_shown(&parsed.warnings, text);
            assert!(!parsed.warnings.iter().any(Diagnostic::is_error));
            holds(&parsed.material);
            let again =
                parse("m.toml", text, &read).unwrap_or_else(|errors| panic!("refused the second time: {errors:?}"));
            assert_eq!(again, parsed);
        }
        Err(diagnostics) => {
            refused(&diagnostics, text);
            can_be_told(text, &read);
        }
    }
}

/// Checks that pictures of a file with errors are found at their places in it.
fn can_be_told(text: &str, read: &dyn Fn(&str) -> io::Result<String>) {
    let Some(material) = parse_partly("m.toml", text, read).0 else { return };
    for image in material.images() {
        assert!(text.get(material.places.span(&image.key)).is_some(), "{}", image.key);
    }
}

/// A scene file or a surface file.
pub(super) fn scene(bytes: &[u8]) {
    let text = String::from_utf8_lossy(bytes);
    surface(&text);
    let claims = FileKind::of(&text) == FileKind::Scene;
    match parse_scene("s.toml", &text) {
        Ok(scene) => {
            assert!(claims, "a scene that is not recognised");
            assert!(!scene.materials.is_empty() && !scene.lights.is_empty());
            for material in &scene.materials {
                assert!(text.get(material.span.clone()).is_some());
                can_be_shown(&[scene.diagnostic(material, "cannot be read")], &text);
            }
            ascends(scene.view.angles_deg, 0.0..=85.0);
            for light in &scene.lights {
                match *light {
                    Light::Directional { from_eye_deg } => ascends([from_eye_deg; 2], 0.0..=180.0),
                    Light::Point { from_eye_deg } => ascends(from_eye_deg, 0.0..=180.0),
                    Light::Environment => {}
                }
            }
            assert!(scene.view.footprint_deg.is_finite() && scene.target.max_cost.is_none_or(f64::is_finite));
        }
        Err(diagnostics) => refused(&diagnostics, &text),
    }
}

/// A surface file.
fn surface(text: &str) {
    let claims = FileKind::of(text) == FileKind::Surface;
    match parse_surface("s.toml", text) {
        Ok(surface) => {
            assert!(claims, "a surface that is not recognised");
            assert!(!surface.cells.materials.is_empty() && surface.cells.frequency > 0.0);
            for material in surface.materials() {
                can_be_shown(&[surface.diagnostic(material, "cannot be read", "look")], text);
            }
            can_be_shown(&[surface.of_name("taken")], text);
            for switch in &surface.switches {
                assert!(!switch.cells.materials.is_empty() && switch.cells.frequency > 0.0);
                if let SwitchBy::Noise { octaves, between, .. } = switch.by {
                    assert!((1..=12).contains(&octaves));
                    ascends(between, -1.0..=1.0);
                }
            }
            if let Some(glitter) = &surface.glitter {
                assert!((0.0..=1.0).contains(&glitter.filled) && (0.0..=0.8).contains(&glitter.tilt));
            }
        }
        Err(diagnostics) => refused(&diagnostics, text),
    }
}

fn ascends([from, to]: [f64; 2], range: RangeInclusive<f64>) {
    assert!(from <= to && range.contains(&from) && range.contains(&to), "{from} to {to}");
}

fn holds(material: &Material) {
    let stack: &Stack = &material.stack;
    assert!(!stack.layers.is_empty() && stack.layers.len() == material.layers.len());
    assert!(stack.exterior.samples().iter().all(|sample| sample.k == 0.0));
    for (number, layer) in stack.layers.iter().enumerate() {
        for alpha in [layer.surface.alpha_x, layer.surface.alpha_y] {
            assert!((0.0..=1.0).contains(&alpha), "slope parameter {alpha}");
        }
        for film in &layer.films {
            assert!(film.thickness.min_nm <= film.thickness.max_nm, "{:?}", film.thickness);
        }
        assert!(matches!(layer.base, Base::Dielectric { .. }) || number + 1 == stack.layers.len());
    }
    assert!(material.bake.wavelengths_nm().iter().all(|nm| nm.is_finite()));
    let (_, _) = (material.model(), material.model_without_fit());
    for model in ShadingModel::ALL {
        for feature in left_out(material, model) {
            assert!(!feature.forms.is_empty());
            assert!(material.text.get(material.places.span(&feature.key)).is_some(), "{}", feature.key);
        }
    }
    assert!(!SurfaceClass::of(stack).name().is_empty());
    for image in material.images() {
        assert!(!image.picture.path.is_empty());
    }
}

fn refused(diagnostics: &[Diagnostic], text: &str) {
    assert!(diagnostics.iter().any(Diagnostic::is_error), "refused without an error");
    can_be_shown(diagnostics, text);
}

fn can_be_shown(diagnostics: &[Diagnostic], text: &str) {
    assert!(diagnostics.len() <= LISTED_MAX);
    for d in diagnostics {
        assert!(d.message.chars().count() <= MESSAGE_MAX);
        let before = text.get(..d.span.start).unwrap_or_else(|| panic!("outside the text: {d:?}"));
        assert!(text.get(d.span.clone()).is_some(), "outside the text: {d:?}");
        assert_eq!(d.line, 1 + before.matches('\n').count());
        assert!(d.column >= 1);
        assert!(d.render(text).contains(d.severity.name()) && !d.render_coloured(text).is_empty());
    }
}
