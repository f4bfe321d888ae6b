//! Scene files: which materials are seen, in what light and from where, and what their models may err and cost.

use std::ops::Range;

use luthier_lut::{FormatSet, TexelFormat};
use luthier_manifest::SceneBudget;

use crate::check::check_table;
use crate::diagnostic::{Diagnostic, Severity, Sink};
use crate::grammar::SCENE;
use crate::section::{Section, parse_toml};

/// A validated scene.
#[derive(Debug, Clone, PartialEq)]
pub struct Scene {
    /// Name: letters, digits and hyphens.
    pub name: String,
    /// Label of the file that it was read from.
    pub source: String,
    /// Text of that file.
    pub text: String,
    /// One or two sentences; empty when the file has none.
    pub description: String,
    /// The materials, in the order of the file; at least one.
    pub materials: Vec<SceneMaterial>,
    /// The lights; at least one.
    pub lights: Vec<Light>,
    /// Angles under which surfaces are seen.
    pub view: View,
    /// Share of neighbouring pixels that differ in material, 0 to 1.
    pub neighbours_differ: f64,
    /// Room and time of the target.
    pub target: SceneTarget,
    /// Limits on the errors of models, unless a material has limits of its own.
    pub budget: SceneBudget,
}

/// A material of a scene.
#[derive(Debug, Clone, PartialEq)]
pub struct SceneMaterial {
    /// The material file, relative to the scene's.
    pub file: String,
    /// Limits in place of the scene's.
    pub budget: SceneBudget,
    /// Bytes of the text that name the file.
    pub span: Range<usize>,
}

impl Scene {
    /// An error about a material that the scene names.
    pub fn diagnostic(&self, material: &SceneMaterial, message: impl Into<String>) -> Diagnostic {
        let hint = Some("the path is relative to the scene file".to_owned());
        Sink::one(&self.source, &self.text, Severity::Error, material.span.clone(), message.into(), hint)
    }
}

/// A light.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Light {
    /// A light from one direction.
    Directional {
        /// Angle between light and eye.
        from_eye_deg: f64,
    },
    /// A light from nearby: surfaces see it under different angles to the eye.
    Point {
        /// Least and largest angle between light and eye.
        from_eye_deg: [f64; 2],
    },
    /// A light of equal radiance from everywhere.
    Environment,
}

/// Angles under which surfaces are seen.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct View {
    /// Least and largest angle between normal and eye, 0 to 85.
    pub angles_deg: [f64; 2],
    /// How far the normals within a pixel lean from their mean.
    pub footprint_deg: f64,
}

/// Room and time of a target.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct SceneTarget {
    /// Bytes of the texels of all tables.
    pub max_bytes: Option<u64>,
    /// Cost of one evaluation, in the unit of the device.
    pub max_cost: Option<f64>,
    /// Short name of the device whose costs count.
    pub device: Option<String>,
    /// Texel formats that tables may have.
    pub formats: Option<FormatSet>,
}

/// Reads a scene file. `label` names it in diagnostics. The materials that it names are not read.
///
/// ```
/// let text = r#"
/// scene = 1
/// name = "shelf"
///
/// [[material]]
/// file = "gilding.toml"
///
/// [[light]]
/// type = "directional"
/// from_eye_deg = 40
///
/// [budget]
/// max_rel = 0.1
/// "#;
/// let scene = luthier_material::parse_scene("shelf.toml", text).unwrap();
/// assert_eq!(scene.view.angles_deg, [0.0, 75.0]);
///
/// let wrong = text.replace("from_eye_deg", "from_eye");
/// let diagnostics = luthier_material::parse_scene("shelf.toml", &wrong).unwrap_err();
/// assert_eq!((diagnostics[0].line, diagnostics[0].column), (10, 1));
/// assert_eq!(diagnostics[0].hint.as_deref(), Some("did you mean `from_eye_deg`?"));
/// ```
///
/// # Errors
/// All diagnostics, in the order of the text.
pub fn parse_scene(label: &str, text: &str) -> Result<Scene, Vec<Diagnostic>> {
    let mut sink = Sink::new(label, text);
    let Some(document) = parse_toml(text, &mut sink) else { return Err(sink.into_diagnostics()) };
    let document = Section::document(&document);
    check_table(&SCENE, &[], &document, &mut sink);
    if sink.has_errors() {
        return Err(sink.into_diagnostics());
    }
    let scene = decode(label, text, &document, &mut sink);
    if sink.has_errors() { Err(sink.into_diagnostics()) } else { Ok(scene) }
}

fn decode(label: &str, text: &str, document: &Section<'_>, sink: &mut Sink<'_>) -> Scene {
    let budget = document.section("budget").map(|at| budget(&at)).unwrap_or_default();
    let materials = document.sections("material");
    for (at, file) in materials.iter().zip(materials.iter().map(|at| at.text("file"))) {
        let first = materials.iter().find(|other| other.text("file") == file);
        if first.is_some_and(|first| first.span != at.span) {
            let hint = Some("keep one of the two".to_owned());
            sink.error(at.value_span("file"), format!("{} is in the scene already", file.unwrap_or_default()), hint);
        }
    }
    let scene_materials: Vec<SceneMaterial> = materials
        .iter()
        .map(|at| SceneMaterial {
            file: at.text("file").unwrap_or_default().to_owned(),
            budget: at.section("budget").map(|at| self::budget(&at)).unwrap_or_default(),
            span: at.value_span("file"),
        })
        .collect();
    let none = SceneBudget::default();
    if budget == none && scene_materials.iter().any(|material| material.budget == none) {
        let hint = Some("add `max_rel = 0.1` to [budget]".to_owned());
        sink.error(document.value_span("budget"), "the budget limits nothing", hint);
    }
    let lights = document.sections("light").iter().filter_map(|at| light(at, sink)).collect();
    let view = document.section("view");
    let angles_deg = view.as_ref().and_then(|at| range(at, "angles_deg", sink)).unwrap_or([0.0, 75.0]);
    let footprint_deg = view.as_ref().and_then(|at| at.number("footprint_deg")).unwrap_or(0.0);
    Scene {
        name: document.text("name").unwrap_or_default().to_owned(),
        source: label.to_owned(),
        text: text.to_owned(),
        description: document.text("description").unwrap_or_default().to_owned(),
        materials: scene_materials,
        lights,
        view: View { angles_deg, footprint_deg },
        neighbours_differ: view.as_ref().and_then(|at| at.number("neighbours_differ")).unwrap_or(0.0),
        target: document.section("target").map(|at| target(&at)).unwrap_or_default(),
        budget,
    }
}

fn budget(at: &Section<'_>) -> SceneBudget {
    SceneBudget { max_rel: at.number("max_rel"), max_abs: at.number("max_abs"), delta_e: at.number("delta_e") }
}

fn target(at: &Section<'_>) -> SceneTarget {
    SceneTarget {
        max_bytes: at.number("max_bytes").map(|bytes| bytes as u64),
        max_cost: at.number("max_cost"),
        device: at.text("device").map(str::to_owned),
        formats: at
            .has("formats")
            .then(|| at.texts("formats").iter().filter_map(|name| TexelFormat::from_name(name)).collect()),
    }
}

fn light(at: &Section<'_>, sink: &mut Sink<'_>) -> Option<Light> {
    match at.text("type")? {
        "directional" => Some(Light::Directional { from_eye_deg: at.number("from_eye_deg")? }),
        "point" => Some(Light::Point { from_eye_deg: range(at, "from_eye_deg", sink)? }),
        _ => Some(Light::Environment),
    }
}

/// Two numbers that ascend.
fn range(at: &Section<'_>, key: &str, sink: &mut Sink<'_>) -> Option<[f64; 2]> {
    let [least, most] = at.two_numbers(key)?;
    if least > most {
        let hint = Some(format!("write `{key} = [{most}, {least}]`"));
        sink.error(at.value_span(key), format!("`{key}` must ascend"), hint);
    }
    Some([least, most])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::FileKind;

    const SHELF: &str = "scene = 1\nname = \"shelf\"\n\n[[material]]\nfile = \"a.toml\"\nbudget = { delta_e = 2 }\n\n\
                         [[light]]\ntype = \"point\"\nfrom_eye_deg = [20, 60]\n\n[[light]]\ntype = \"environment\"\n\n\
                         [view]\nangles_deg = [0, 60]\nfootprint_deg = 0.5\nneighbours_differ = 0.25\n\n\
                         [target]\nmax_bytes = 4096\nmax_cost = 200\ndevice = \"rdna3\"\nformats = [\"rgba8unorm\"]\n\n[budget]\nmax_rel = 0.1\n";

    #[test]
    fn every_key_arrives() {
        let scene = parse_scene("shelf.toml", SHELF).unwrap();
        assert_eq!(scene.materials[0].budget.delta_e, Some(2.0));
        assert_eq!(scene.lights, [Light::Point { from_eye_deg: [20.0, 60.0] }, Light::Environment]);
        assert_eq!(scene.view, View { angles_deg: [0.0, 60.0], footprint_deg: 0.5 });
        assert_eq!((scene.target.max_bytes, scene.target.max_cost), (Some(4096), Some(200.0)));
        assert_eq!(scene.target.formats, Some([TexelFormat::Rgba8Unorm].into_iter().collect()));
        assert_eq!((scene.target.device.as_deref(), scene.neighbours_differ), (Some("rdna3"), 0.25));
        assert_eq!(scene.budget.max_rel, Some(0.1));
        assert_eq!(FileKind::of(SHELF), FileKind::Scene);
    }

    #[test]
    fn a_scene_is_no_material() {
        let no_files = |_: &str| Err(std::io::ErrorKind::NotFound.into());
        let found = crate::parse("shelf.toml", SHELF, &no_files).unwrap_err();
        assert_eq!((found.len(), found[0].line, found[0].message.as_str()), (1, 1, "this is a scene, not a material"));
    }

    /// Each mistake has one message, at its place, with a way out.
    #[test]
    fn mistakes_are_pointed_at() {
        for (from, to, line, message, hint) in [
            ("footprint_deg", "footprint", 17, "unknown key `footprint`", "did you mean `footprint_deg`?"),
            ("\"point\"", "\"pont\"", 9, "`pont` is no `type`", "did you mean `type = \"point\"`?"),
            ("[20, 60]", "[60, 20]", 10, "must ascend", "write `from_eye_deg = [20, 60]`"),
            ("[0, 60]", "[0, 95]", 16, "must be from 0 to 85", ""),
            ("rgba8unorm", "rgba8", 24, "`rgba8` is no value", ""),
            ("max_rel = 0.1\n", "", 26, "limits nothing", "max_rel"),
            ("scene = 1", "scene = 2", 1, "`scene` must be 1", "scene = 1"),
            ("file = ", "flie = ", 5, "unknown key `flie`", "did you mean `file`?"),
        ] {
            let text = if message == "limits nothing" {
                SHELF.replace(from, to).replace("budget = { delta_e = 2 }\n", "\n")
            } else {
                SHELF.replace(from, to)
            };
            let found = parse_scene("shelf.toml", &text).unwrap_err();
            assert!(found[0].message.contains(message), "{to}: {found:?}");
            assert_eq!(found[0].line, line, "{to}: {found:?}");
            assert!(found[0].hint.clone().unwrap_or_default().contains(hint), "{to}: {found:?}");
        }
    }
}
