//! Parser of a material file: text to material, warnings and errors.

use toml::de::DeTable;

use crate::check::{check_key, check_table};
use crate::decode::decode;
use crate::diagnostic::{Diagnostic, Sink};
use crate::grammar::DOCUMENT;
use crate::material::Material;
use crate::section::{Section, parse_toml};

/// A material, with warnings.
#[derive(Debug, Clone, PartialEq)]
pub struct Parsed {
    /// The material.
    pub material: Material,
    /// Warnings in the order of the text.
    pub warnings: Vec<Diagnostic>,
}

/// The kind of file that a text is meant to be.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FileKind {
    /// A scene: it has the key `scene` of scene files, or their lights and no layers.
    Scene,
    /// A surface: it has the key `surface` of surface files, or their cells and no layers.
    Surface,
    /// A material: it has the key `schema` of material files, or layers.
    Material,
    /// A file of another program, or no TOML.
    Other,
}

impl FileKind {
    /// The kind of a text, which may have errors.
    ///
    /// ```
    /// use luthier_material::FileKind;
    ///
    /// assert_eq!(FileKind::of("schema = 1\nname = \"gilding\""), FileKind::Material);
    /// assert_eq!(FileKind::of("scene = 1"), FileKind::Scene);
    /// assert_eq!(FileKind::of("[cells]"), FileKind::Surface);
    /// assert_eq!(FileKind::of("[package]"), FileKind::Other);
    /// ```
    pub fn of(text: &str) -> Self {
        let (document, _) = DeTable::parse_recoverable(text);
        let file = Section::document(&document);
        if file.has("scene") || file.has("light") && !file.has("layer") {
            Self::Scene
        } else if !file.has("schema") && (file.has("surface") || file.has("cells") && !file.has("layer")) {
            Self::Surface
        } else if file.has("schema") || file.has("layer") {
            Self::Material
        } else {
            Self::Other
        }
    }
}

/// Reads a material file.
///
/// `label` names the file in diagnostics. `read` returns the text of a file that the material refers to by a path relative
/// to itself (CSV files of indices); images are not read.
///
/// ```
/// let text = r#"
/// schema = 1
/// name = "gilding"
///
/// [[layer]]
/// type = "conductor"
/// ior = "au"
/// roughness = 0.3
/// "#;
/// let no_files = |_: &str| Err(std::io::ErrorKind::NotFound.into());
/// let parsed = luthier_material::parse("gilding.toml", text, &no_files).unwrap();
/// assert!((parsed.material.stack.layers[0].surface.alpha_x - 0.09).abs() < 1e-12);
///
/// let wrong = text.replace("0.3", "30");
/// let diagnostics = luthier_material::parse("gilding.toml", &wrong, &no_files).unwrap_err();
/// assert_eq!((diagnostics[0].line, diagnostics[0].column), (8, 13));
/// assert_eq!(diagnostics[0].hint.as_deref(), Some("30 per cent is `roughness = 0.3`"));
/// ```
///
/// # Errors
/// All diagnostics, at least one of them an error, in the order of the text.
pub fn parse(
    label: &str,
    text: &str,
    read: &dyn Fn(&str) -> std::io::Result<String>,
) -> Result<Parsed, Vec<Diagnostic>> {
    let (material, diagnostics) = parse_partly(label, text, read);
    match material {
        Some(material) if !diagnostics.iter().any(Diagnostic::is_error) => {
            Ok(Parsed { material, warnings: diagnostics })
        }
        _ => Err(diagnostics),
    }
}

/// Reads a material file as [`parse`] does, and returns a material in spite of errors: enough to find further faults, such as missing
/// pictures.
///
/// Values with errors are left out or have defaults. There is no material if the file is not TOML, or is of another kind.
pub fn parse_partly(
    label: &str,
    text: &str,
    read: &dyn Fn(&str) -> std::io::Result<String>,
) -> (Option<Material>, Vec<Diagnostic>) {
    let mut sink = Sink::new(label, text);
    let Some(document) = parse_toml(text, &mut sink) else { return (None, sink.into_diagnostics()) };
    let document = Section::document(&document);
    if document.has("scene") && !document.has("schema") {
        let hint = Some("bake it: `luthier bake SCENE.toml`; it names its materials itself".to_owned());
        sink.error(document.key_span("scene"), "this is a scene, not a material", hint);
        return (None, sink.into_diagnostics());
    }
    if document.has("surface") && !document.has("schema") {
        let hint =
            Some("`check`, `bake`, `preview` and `eval` take surfaces; give other commands its materials".to_owned());
        sink.error(document.key_span("surface"), "this is a surface, not a material", hint);
        return (None, sink.into_diagnostics());
    }
    check_key(&DOCUMENT, "schema", &document, &mut sink);
    if sink.has_errors() {
        // A file of another version has other rules: only that is worth saying.
        return (None, sink.into_diagnostics());
    }
    check_table(&DOCUMENT, &[], &document, &mut sink);
    let material = decode(label, text, &document, read, &mut sink);
    (Some(material), sink.into_diagnostics())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keys_decide() {
        for (text, kind) in [
            ("surface = 2", FileKind::Surface),
            ("schema = 1\nsurface = 1", FileKind::Material),
            ("", FileKind::Other),
            ("[[light]]", FileKind::Scene),
            ("[[light]]\n[[layer]]", FileKind::Material),
            ("[cells]\n[[layer]]", FileKind::Material),
        ] {
            assert_eq!(FileKind::of(text), kind, "{text}");
        }
    }
}
