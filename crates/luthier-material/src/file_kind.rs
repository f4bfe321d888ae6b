//! Kinds of TOML files by their keys.

use toml::de::DeTable;

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
        let table = document.get_ref();
        let has = |key: &str| table.get(key).is_some();
        if has("scene") || has("light") && !has("layer") {
            Self::Scene
        } else if !has("schema") && (has("surface") || has("cells") && !has("layer")) {
            Self::Surface
        } else if has("schema") || has("layer") {
            Self::Material
        } else {
            Self::Other
        }
    }
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
