//! JSON Schema of the grammar, for editors.

use std::collections::BTreeMap;

use serde_json::{Map, Value, json};

use crate::grammar::{DOCUMENT, Kind, NAME_MAX, SCENE, SURFACE, Table, TextForm, unit};

/// The grammar of material files as JSON Schema (draft 2020-12), generated from the tables that files are checked against. `x-unit` is the
/// unit of numbers, "1" for pure ones.
///
/// Conditions between values, such as a conductor being the last layer, are beyond it.
pub fn schema() -> Value {
    document(&DOCUMENT, "luthier material")
}

/// The grammar of scene files as JSON Schema (draft 2020-12).
pub fn scene_schema() -> Value {
    document(&SCENE, "luthier scene")
}

/// The grammar of surface files as JSON Schema (draft 2020-12).
pub fn surface_schema() -> Value {
    document(&SURFACE, "luthier surface")
}

fn document(of: &'static Table, title: &str) -> Value {
    let mut definitions = BTreeMap::new();
    let mut root = match table(of, &mut definitions) {
        Value::Object(root) => root,
        _ => Map::new(),
    };
    root.insert("$schema".to_owned(), json!("https://json-schema.org/draft/2020-12/schema"));
    root.insert("title".to_owned(), json!(title));
    root.insert("$defs".to_owned(), definitions.into_iter().collect::<Map<_, _>>().into());
    Value::Object(root)
}

type Definitions = BTreeMap<String, Value>;

fn table(table: &'static Table, definitions: &mut Definitions) -> Value {
    let mut properties = Map::new();
    for key in table.keys {
        let mut value = kind(&key.kind, definitions);
        let unit = unit(table, key);
        if let Value::Object(value) = &mut value {
            value.insert("description".to_owned(), json!(key.doc));
            if let Ok(default) = serde_json::from_str::<Value>(key.default) {
                value.insert("default".to_owned(), default);
            }
            if let Some(unit) = unit {
                value.insert("x-unit".to_owned(), json!(unit));
            }
        }
        properties.insert(key.name.to_owned(), value);
    }
    let required: Vec<&str> = table.keys.iter().filter(|k| k.required).map(|k| k.name).collect();
    let mut schema = json!({
        "type": "object",
        "description": table.doc,
        "properties": properties,
        "required": required,
        "additionalProperties": false,
    });
    for (number, alternatives) in table.alternatives().enumerate() {
        let Value::Object(schema) = &mut schema else { continue };
        let forms: Vec<Value> = alternatives.forms.iter().map(|form| json!({ "required": form })).collect();
        let word = if alternatives.together { "anyOf" } else { "oneOf" };
        if number == 0 {
            schema.insert(word.to_owned(), forms.into());
        } else if let Value::Array(all) = schema.entry("allOf").or_insert_with(|| json!([])) {
            all.push(json!({ word: forms }));
        }
        // Keys that go together.
        let together = alternatives.forms.iter().filter(|form| form.len() > 1);
        let dependent: Map<String, Value> =
            together.flat_map(|form| form.iter().map(move |k| ((*k).to_owned(), json!(form)))).collect();
        if !dependent.is_empty() {
            schema.insert("dependentRequired".to_owned(), dependent.into());
        }
    }
    schema
}

fn kind(of: &'static Kind, definitions: &mut Definitions) -> Value {
    match of {
        Kind::True => json!({ "const": true }),
        Kind::Flag => json!({ "type": "boolean" }),
        Kind::Number(range) => {
            let mut schema = Map::new();
            schema.insert("type".to_owned(), json!("number"));
            if range.min.is_finite() {
                let bound = if range.above { "exclusiveMinimum" } else { "minimum" };
                schema.insert(bound.to_owned(), json!(range.min));
            }
            if range.max.is_finite() {
                schema.insert("maximum".to_owned(), json!(range.max));
            }
            schema.into()
        }
        Kind::Integer(min, max) if min == max => json!({ "const": min }),
        Kind::Integer(min, max) => json!({ "type": "integer", "minimum": min, "maximum": max }),
        Kind::Text(TextForm::Prose) => json!({ "type": "string" }),
        Kind::Text(TextForm::Path) => json!({ "type": "string", "minLength": 1 }),
        Kind::Text(TextForm::Name) => {
            json!({ "type": "string", "pattern": "^[A-Za-z0-9][A-Za-z0-9-]*$", "maxLength": NAME_MAX })
        }
        Kind::Choice([one]) => json!({ "const": one }),
        Kind::Choice(names) => json!({ "enum": names }),
        Kind::List { item, min, max } => {
            let mut schema = json!({ "type": "array", "items": kind(item, definitions), "minItems": min });
            if let (true, Value::Object(schema)) = (*max < usize::MAX, &mut schema) {
                schema.insert("maxItems".to_owned(), json!(max));
            }
            schema
        }
        Kind::Table(table) => reference(table, definitions),
        Kind::Tagged { variants, max, .. } => {
            let variants: Vec<Value> = variants.iter().map(|v| reference(v, definitions)).collect();
            json!({ "type": "array", "minItems": 1, "maxItems": max, "items": { "oneOf": variants } })
        }
        Kind::OneOf(kinds) => json!({ "oneOf": kinds.iter().map(|k| kind(k, definitions)).collect::<Vec<_>>() }),
    }
}

/// A reference to a table's definition, which is made on first use.
fn reference(to: &'static Table, definitions: &mut Definitions) -> Value {
    if !definitions.contains_key(to.name) {
        // A place holder first: a table that held itself would not end otherwise.
        definitions.insert(to.name.to_owned(), Value::Null);
        let schema = table(to, definitions);
        definitions.insert(to.name.to_owned(), schema);
    }
    json!({ "$ref": format!("#/$defs/{}", to.name) })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_reference_resolves() {
        fn visit(value: &Value, root: &Value) {
            match value {
                Value::Object(map) => {
                    if let Some(Value::String(reference)) = map.get("$ref") {
                        assert!(root.pointer(&reference[1..]).is_some_and(Value::is_object), "{reference}");
                    }
                    map.values().for_each(|v| visit(v, root));
                }
                Value::Array(items) => items.iter().for_each(|v| visit(v, root)),
                _ => {}
            }
        }
        for schema in [schema(), scene_schema(), surface_schema()] {
            visit(&schema, &schema);
        }
    }

    #[test]
    fn it_says_what_the_grammar_says() {
        let schema = schema();
        assert_eq!(schema.pointer("/properties/schema/const"), Some(&json!(1)));
        assert_eq!(schema.pointer("/required"), Some(&json!(["schema", "name", "layer"])));
        assert_eq!(schema.pointer("/$defs/dielectric/properties/alpha/maximum"), Some(&json!(1.0)));
        assert_eq!(schema.pointer("/$defs/dielectric/oneOf/6/required"), Some(&json!(["exponents"])));
        assert_eq!(schema.pointer("/$defs/dielectric/oneOf/4/required"), Some(&json!(["alpha_x", "alpha_y"])));
        assert_eq!(schema.pointer("/$defs/noise/properties/octaves/default"), Some(&json!(4)));
        assert_eq!(schema.pointer("/$defs/thin-film/properties/thickness_nm/x-unit"), Some(&json!("nm")));
        assert_eq!(schema.pointer("/$defs/thin-film/properties/roughness"), None);
        let index_or_f0 = json!([{ "required": ["ior"] }, { "required": ["f0"] }]);
        assert_eq!(schema.pointer("/$defs/conductor/allOf/0/oneOf"), Some(&index_or_f0));
        assert_eq!(schema.pointer("/$defs/dielectric/allOf/0/anyOf"), Some(&index_or_f0));
    }
}
