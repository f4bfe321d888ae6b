//! A material file as layers with keys, and its text.

use std::fmt::Write as _;

/// A value of a key.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Value {
    Number(f64),
    Rgb([f64; 3]),
    Bool(bool),
    /// A whole table, as TOML.
    Table(String),
}

impl Value {
    /// One number where all channels are the same.
    pub(crate) fn color(rgb: [f64; 3]) -> Self {
        if rgb[0] == rgb[1] && rgb[1] == rgb[2] { Self::Number(rgb[0]) } else { Self::Rgb(rgb) }
    }

    fn toml(&self) -> String {
        match self {
            Self::Number(number) => self::number(*number),
            Self::Rgb(rgb) => format!("[{}]", rgb.map(number).join(", ")),
            Self::Bool(is_set) => is_set.to_string(),
            Self::Table(text) => text.clone(),
        }
    }
}

/// A number with at most six digits that count, in its shortest form.
pub(crate) fn number(value: f64) -> String {
    // Of 0 with a sign, too.
    let rounded: f64 = format!("{:.5e}", value + 0.0).parse().unwrap_or(value);
    let text = rounded.to_string();
    if text.contains(['.', 'e']) || !rounded.is_finite() { text } else { format!("{text}.0") }
}

/// A text without control characters.
pub(crate) fn plain(text: &str) -> String {
    text.chars().map(|c| if c.is_control() { ' ' } else { c }).collect()
}

/// A string of TOML, in one line.
fn quoted(text: &str) -> String {
    format!("\"{}\"", plain(text).replace('\\', "\\\\").replace('"', "\\\""))
}

/// A layer.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Layer {
    kind: &'static str,
    keys: Vec<(&'static str, Value)>,
    maps: Vec<(&'static str, String)>,
}

impl Layer {
    pub(crate) fn new(kind: &'static str) -> Self {
        Self { kind, keys: Vec::new(), maps: Vec::new() }
    }

    pub(crate) fn set(&mut self, key: &'static str, value: Value) {
        self.keys.push((key, value));
    }

    /// Adds a picture under a key of `maps`.
    pub(crate) fn map(&mut self, key: &'static str, picture: String) {
        self.maps.push((key, picture));
    }

    /// Whether the value of a key is a table.
    pub(crate) fn has_table(&self, key: &str) -> bool {
        self.keys.iter().any(|(known, value)| *known == key && matches!(value, Value::Table(_)))
    }

    pub(crate) fn has(&self, key: &str) -> bool {
        self.keys.iter().any(|(known, _)| *known == key)
    }

    pub(crate) fn has_map(&self, key: &str) -> bool {
        self.maps.iter().any(|(known, _)| *known == key)
    }

    /// Adds to a `metallic-roughness` layer the white maps that its other maps need: see the maps of layers in docs/materials.md. `wants_maps` says that something above it needs one.
    pub(crate) fn complete(&mut self, metallic: f64, wants_maps: bool, white: &mut dyn FnMut() -> Option<String>) {
        let mut add = |layer: &mut Self, key: &'static str| {
            if !layer.has_map(key)
                && let Some(picture) = white()
            {
                layer.map(key, picture);
            }
        };
        if wants_maps && !self.has_map("metallic") {
            add(self, "base_color");
        }
        let is_blend = metallic > 0.0 && metallic < 1.0;
        if self.has_map("base_color") && metallic > 0.0 || is_blend {
            add(self, "metallic");
        }
        // The F0 of a place decides the albedo below it.
        if self.has_map("f0") || self.has_map("metallic") && self.has("f0") {
            add(self, "base_color");
            if metallic > 0.0 {
                add(self, "metallic");
            }
        }
    }
}

/// A material file.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct Draft {
    /// Lines before the first key.
    pub(crate) comments: Vec<String>,
    pub(crate) name: String,
    pub(crate) description: Option<String>,
    pub(crate) references: Vec<String>,
    pub(crate) layers: Vec<Layer>,
}

impl Draft {
    pub(crate) fn toml(&self) -> String {
        let mut out = String::new();
        // Writing to a String does not fail.
        for comment in &self.comments {
            let _ = writeln!(out, "# {}", plain(comment));
        }
        let _ = writeln!(out, "\nschema = 1\nname = \"{}\"", self.name);
        if let Some(description) = &self.description {
            let _ = writeln!(out, "description = {}", quoted(description));
        }
        if !self.references.is_empty() {
            let lines: String =
                self.references.iter().map(|reference| format!("    {},\n", quoted(reference))).collect();
            let _ = writeln!(out, "references = [\n{lines}]");
        }
        for Layer { kind, keys, maps } in &self.layers {
            let _ = writeln!(out, "\n[[layer]]\ntype = \"{kind}\"");
            for (key, value) in keys {
                let _ = writeln!(out, "{key} = {}", value.toml());
            }
            if !maps.is_empty() {
                let _ = writeln!(out, "\n[layer.maps]");
            }
            for (key, picture) in maps {
                let _ = writeln!(out, "{key} = {picture}");
            }
        }
        out
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short_and_floats() {
        let found = [0.0, 1.0, 0.1 + 0.2, f64::from(0.8_f32), 1.23456789e-7, 400.0].map(number);
        assert_eq!(found, ["0.0", "1.0", "0.3", "0.8", "0.000000123457", "400.0"]);
    }
}
