//! Documentation comments, which naga does not carry over.

use std::collections::BTreeMap;
use std::fmt::Write as _;

/// The `///` comments of WGSL, by `FUNCTION`, `STRUCTURE` and `STRUCTURE.MEMBER`.
pub(super) struct Comments<'w>(BTreeMap<String, Vec<&'w str>>);

impl<'w> Comments<'w> {
    pub(super) fn of(wgsl: &'w str) -> Self {
        let mut comments = BTreeMap::new();
        let mut pending = Vec::new();
        let mut structure = "";
        for line in wgsl.lines() {
            let text = line.trim_start();
            if let Some(comment) = text.strip_prefix("///") {
                pending.push(comment.trim());
                continue;
            }
            let key = if let Some(rest) = text.strip_prefix("fn ") {
                rest.split('(').next().map(str::to_owned)
            } else if let Some(rest) = text.strip_prefix("struct ") {
                structure = rest.trim_end_matches(['{', ' ']);
                Some(structure.to_owned())
            } else {
                text.split_once(':').map(|(member, _)| format!("{structure}.{member}"))
            };
            let comment = std::mem::take(&mut pending);
            if let (Some(key), false) = (key, comment.is_empty()) {
                comments.insert(key, comment);
            }
        }
        Self(comments)
    }

    /// Writes the comment of a key, if there is one.
    pub(super) fn write(&self, out: &mut String, key: &str, indent: &str) {
        for line in self.0.get(key).into_iter().flatten() {
            let _ = writeln!(out, "{indent}// {line}");
        }
    }

    /// A GLSL structure with the comments of itself and its members.
    pub(super) fn on_structure(&self, declaration: &str) -> String {
        let mut out = String::new();
        let mut structure = "";
        for line in declaration.lines() {
            if let Some(rest) = line.strip_prefix("struct ") {
                structure = rest.trim_end_matches([' ', '{']);
                self.write(&mut out, structure, "");
            } else if let Some(member) = line.trim_end_matches(';').rsplit(' ').next() {
                self.write(&mut out, &format!("{structure}.{member}"), "    ");
            }
            let _ = writeln!(out, "{line}");
        }
        out
    }
}
