//! Material files to begin with: one for each class of surfaces, and real substances.
//!
//! They are files of the folder `templates` of this crate. A class is said by its numbers, which were chosen by eye; a preset names a substance,
//! and its `references` are the sources of its optical constants.

use crate::{Diagnostic, parse};

/// A material file to begin with.
///
/// ```
/// use luthier_material::Template;
///
/// let gold = Template::PRESETS.iter().find(|preset| preset.name == "gold").expect("it is listed");
/// let text = gold.called("wedding-ring").expect("a valid name");
/// assert!(text.contains("\nname = \"wedding-ring\"\n") && text.contains("ior = \"au\""));
/// assert!(gold.called("wedding ring").is_err());
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Template {
    /// Its name, also that of the material in its text.
    pub name: &'static str,
    /// The file.
    pub text: &'static str,
}

macro_rules! templates {
    ($folder:literal: $($name:literal)*) => {
        &[$(Template {
            name: $name,
            text: include_str!(concat!("../../templates/", $folder, "/", $name, ".toml")),
        }),*]
    };
}

impl Template {
    /// One for each [`SurfaceClass`](crate::SurfaceClass), in the order of its list, by the name of the class.
    pub const CLASSES: &[Self] = templates!("classes":
        "glossy-paint" "tinted-glazing" "frosted-paint" "metal-foil" "metallic-paint" "frosted-metal" "patina" "multi-layer" "bare-metal"
        "thin-film" "matte" "glass");

    /// Real substances, in the order of their names.
    pub const PRESETS: &[Self] = templates!("presets":
        "aluminium" "anodised-titanium" "brass" "chromium" "copper" "crown-glass" "fused-silica" "gold" "ice" "iron" "nickel" "platinum"
        "silicon" "silver" "soap-film" "stainless-steel" "titanium" "tungsten" "water");

    /// The description that the file has of itself.
    pub fn description(&self) -> &'static str {
        let line = self.text.lines().find_map(|line| line.strip_prefix("description = \""));
        line.and_then(|rest| rest.strip_suffix('"')).unwrap_or_default()
    }

    /// The file, with another name for the material.
    ///
    /// # Errors
    /// The mistake in the name, if materials cannot have it.
    pub fn called(&self, name: &str) -> Result<String, Diagnostic> {
        // Of a text that breaks out of its quotes, the name would be a part.
        let shown: String = name.chars().map(|c| if c.is_control() || "\"\\".contains(c) { '?' } else { c }).collect();
        let [old, new] = [self.name, &shown].map(|name| format!("\nname = \"{name}\"\n"));
        let text = self.text.replacen(&old, &new, 1);
        match parse("", &text, &|_| Err(std::io::ErrorKind::NotFound.into())) {
            Ok(_) => Ok(text),
            Err(mistakes) => Err(mistakes.into_iter().next().unwrap_or_else(|| unreachable!("an error says why"))),
        }
    }
}
