//! The grammar in words: every table and key, for a page that people read.

use crate::grammar::{Alternatives, DOCUMENT, Kind, NAME_MAX, PATH_MAX, Range, SCENE, SURFACE, Table, TextForm, unit};
use crate::suggest::short;

/// A table of the grammar, in words.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct TableReference {
    /// Name, which no other table of the grammar has.
    pub name: &'static str,
    /// Description, in a sentence.
    pub doc: &'static str,
    /// Groups of keys of which one is needed, each as a sentence in Markdown.
    pub alternatives: Vec<String>,
    /// Its keys, in the order of the grammar.
    pub keys: Vec<KeyReference>,
}

/// A key of the grammar, in words.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct KeyReference {
    /// Name.
    pub name: &'static str,
    /// Description, in a sentence or two.
    pub doc: &'static str,
    /// Kind and range of its values, in Markdown; tables are links to headings of their names.
    pub value: String,
    /// Unit of its numbers, `1` for pure ones; `None` for a key without numbers.
    pub unit: Option<&'static str>,
    /// Value of a key that is absent, in Markdown.
    pub default: String,
}

/// The tables of material files, then those of surface files and of scene files, each once and before the tables that its keys take.
pub fn reference() -> Vec<TableReference> {
    let mut tables: Vec<&'static Table> = Vec::new();
    [&DOCUMENT, &SURFACE, &SCENE].into_iter().for_each(|table| collect(table, &mut tables));
    tables.into_iter().map(in_words).collect()
}

fn collect(table: &'static Table, found: &mut Vec<&'static Table>) {
    if found.iter().any(|known| known.name == table.name) {
        return;
    }
    found.push(table);
    table.keys.iter().for_each(|key| collect_kind(&key.kind, found));
}

fn collect_kind(kind: &'static Kind, found: &mut Vec<&'static Table>) {
    match kind {
        Kind::Table(table) => collect(table, found),
        Kind::Tagged { variants, .. } => variants.iter().for_each(|table| collect(table, found)),
        Kind::List { item, .. } => collect_kind(item, found),
        Kind::OneOf(kinds) => kinds.iter().for_each(|kind| collect_kind(kind, found)),
        _ => {}
    }
}

fn in_words(table: &'static Table) -> TableReference {
    let keys = table.keys.iter().map(|key| {
        let is_alternative = table.alternatives().any(|group| group.forms.iter().any(|form| form.contains(&key.name)));
        let default = match (key.required, key.default) {
            (true, _) => "none: it must be given".to_owned(),
            (false, "") if is_alternative => "none: see above".to_owned(),
            (false, "") => absent(table.name, key.name).to_owned(),
            (false, default) => format!("`{default}`"),
        };
        KeyReference { name: key.name, doc: key.doc, value: value(&key.kind), unit: unit(table, key), default }
    });
    let alternatives = table.alternatives().map(alternatives).collect();
    TableReference { name: table.name, doc: table.doc, alternatives, keys: keys.collect() }
}

fn alternatives(group: &Alternatives) -> String {
    let forms: Vec<String> = group
        .forms
        .iter()
        .map(|form| form.iter().map(|key| format!("`{key}`")).collect::<Vec<_>>().join(" with "))
        .collect();
    let needed = if group.together { "At least one" } else { "Exactly one" };
    format!("{needed} of these gives its {}: {}.", group.what, forms.join(", "))
}

/// The words for an absent key that has no default value.
fn absent(table: &str, key: &str) -> &'static str {
    match (table, key) {
        ("bake", "model") => "chosen by what the file asks for",
        ("budget" | "target" | "scene-budget", _) => "no limit",
        ("scene-material", "budget") => "that of the scene",
        ("patina", "diffuse_remainder") => "`diffuse_albedo` holds",
        ("patina", "base_alpha") => "that of the layer",
        ("picture" | "map" | "flake-heights", "transform") => "as the texture coordinates lie",
        ("picture" | "map" | "flake-heights", "channel") => "all that are needed",
        ("ior", "wavelengths_nm") => "none: numbers hold at all wavelengths",
        (table, _) if table.ends_with("-table") => "the baker's choice",
        _ => "nothing",
    }
}

/// Kind and range.
fn value(kind: &Kind) -> String {
    match kind {
        Kind::True => "`true`".to_owned(),
        Kind::Flag => "`true` or `false`".to_owned(),
        Kind::Number(range) => format!("a number{}", bounds(*range)),
        Kind::Integer(min, max) if min == max => format!("{min}"),
        Kind::Integer(min, max) if *max == i64::MAX => format!("a whole number, at least {min}"),
        Kind::Integer(min, max) => format!("a whole number, {min} to {max}"),
        Kind::Text(TextForm::Prose) => "text".to_owned(),
        Kind::Text(TextForm::Path) => format!("a name or a path, at most {} bytes", PATH_MAX[1]),
        Kind::Text(TextForm::Name) => format!("letters, digits and hyphens, at most {NAME_MAX}"),
        Kind::Choice(names) => names.iter().map(|name| format!("`\"{name}\"`")).collect::<Vec<_>>().join(", "),
        Kind::List { item, min, max } => {
            let count = match (min, max) {
                (min, max) if min == max => format!("{min}"),
                (min, &usize::MAX) => format!("{min} or more"),
                (min, max) => format!("{min} to {max}"),
            };
            format!("a list of {count}, each {}", value(item))
        }
        Kind::Table(table) => link(table),
        Kind::Tagged { variants, max, .. } => {
            let names: Vec<String> = variants.iter().map(|table| link(table)).collect();
            format!("1 to {max} tables, each {}", names.join(" or "))
        }
        Kind::OneOf(kinds) => kinds.iter().map(value).collect::<Vec<_>>().join("; or "),
    }
}

fn link(table: &Table) -> String {
    format!("a table [{0}](#{0})", table.name)
}

fn bounds(range: Range) -> String {
    let (min, max) = (short(range.min), short(range.max));
    match (range.min.is_finite(), range.max.is_finite()) {
        (true, true) if range.above => format!(" above {min}, at most {max}"),
        (true, true) => format!(", {min} to {max}"),
        _ => ", finite".to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn key(table: &str, name: &str) -> KeyReference {
        let tables = reference();
        let table = tables.iter().find(|t| t.name == table).unwrap();
        table.keys.iter().find(|k| k.name == name).unwrap().clone()
    }

    #[test]
    fn every_key_says_all() {
        let tables = reference();
        assert!(tables.len() > 30, "{}", tables.len());
        for table in &tables {
            for key in &table.keys {
                assert!(!key.value.is_empty() && !key.default.is_empty(), "{}.{}", table.name, key.name);
                assert!(key.doc.ends_with('.'), "{}.{}: {}", table.name, key.name, key.doc);
            }
        }
    }

    /// By hand, from the checks of the grammar.
    #[test]
    fn words_are_those_of_the_checks() {
        let slope = key("dielectric", "slope_deg");
        assert_eq!((slope.value.as_str(), slope.unit), ("a number, 0 to 45", Some("degrees")));
        assert_eq!(slope.default, "none: see above");
        assert_eq!(key("thin-film", "thickness_nm").unit, Some("nm"));
        assert_eq!(key("noise", "octaves").value, "a whole number, 1 to 12");
        assert_eq!(key("noise", "octaves").default, "`4`");
        assert_eq!(key("bake", "model").default, "chosen by what the file asks for");
        assert_eq!(key("material", "layer").unit, None);
        assert_eq!(key("diffuse", "albedo").value, "a number, 0 to 1; or a list of 3, each a number, 0 to 1");
    }
}
