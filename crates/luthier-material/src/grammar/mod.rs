//! The grammar of material files as data. The checker, the decoder's choices and the JSON Schema all follow these
//! tables; a key that is not here does not exist.

mod bake;
mod document;
mod effects;
pub(crate) mod foreign;
mod layers;
mod picture;
mod scene;
mod surface;
mod table;
mod unit;

pub(crate) use document::DOCUMENT;
pub(crate) use layers::INDEX;
pub(crate) use scene::SCENE;
pub(crate) use surface::SURFACE;
pub(crate) use table::{
    Alternatives, Key, Kind, LAYERS_MAX, NAME_MAX, NOT_NEGATIVE, PATH_MAX, POSITIVE, REFLECTANCE_READ_MAX,
    REFLECTANCES, Range, Table, TextForm, UNIT,
};
pub(crate) use unit::unit;

#[cfg(test)]
mod tests {
    use super::*;

    fn visit(table: &'static Table, seen: &mut Vec<&'static str>) {
        if seen.contains(&table.name) {
            return;
        }
        seen.push(table.name);
        assert!(!table.doc.is_empty(), "{}", table.name);
        for (i, key) in table.keys.iter().enumerate() {
            assert!(table.keys[..i].iter().all(|k| k.name != key.name), "{}.{} twice", table.name, key.name);
            assert!(!key.doc.is_empty(), "{}.{}", table.name, key.name);
            assert!(!key.required || key.default.is_empty(), "{}.{}", table.name, key.name);
            let has_unit = unit(table, key).is_some();
            assert_eq!(has_unit, unit::is_numeric(&key.kind), "unit of {}.{}", table.name, key.name);
            visit_kind(&key.kind, seen);
        }
        for form in table.alternatives().flat_map(|a| a.forms) {
            assert!(form.iter().all(|name| table.key(name).is_some_and(|k| !k.required)), "{}: {form:?}", table.name);
        }
    }

    fn visit_kind(kind: &'static Kind, seen: &mut Vec<&'static str>) {
        match kind {
            Kind::Table(table) => visit(table, seen),
            Kind::Tagged { tag, variants, .. } => {
                for variant in *variants {
                    assert!(variant.key(tag).is_some(), "{}", variant.name);
                    visit(variant, seen);
                }
            }
            Kind::OneOf(kinds) => {
                let types: Vec<_> = kinds.iter().map(toml_type).collect();
                assert!((1..types.len()).all(|i| !types[..i].contains(&types[i])), "{types:?}");
                kinds.iter().for_each(|k| visit_kind(k, seen));
            }
            Kind::List { item, .. } => visit_kind(item, seen),
            _ => {}
        }
    }

    fn toml_type(kind: &Kind) -> &'static str {
        match kind {
            Kind::True | Kind::Flag => "boolean",
            Kind::Number(_) | Kind::Integer(..) => "number",
            Kind::Text(_) | Kind::Choice(_) => "string",
            Kind::List { .. } | Kind::Tagged { .. } => "array",
            Kind::Table(_) => "table",
            Kind::OneOf(_) => "nested",
        }
    }

    #[test]
    fn tables_are_consistent() {
        let mut seen = Vec::new();
        visit(&DOCUMENT, &mut seen);
        visit(&SCENE, &mut seen);
        visit(&SURFACE, &mut seen);
        assert!(seen.len() >= 15, "{seen:?}");
    }
}
