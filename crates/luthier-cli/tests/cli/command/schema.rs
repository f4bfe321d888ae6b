//! `schema`.

use std::fs;

use luthier_workshop::material_files;
use serde_json::Value;

use crate::workshop::Workshop;

/// Everything named `$ref`.
fn references<'v>(value: &'v Value, found: &mut Vec<&'v str>) {
    match value {
        Value::Array(items) => items.iter().for_each(|item| references(item, found)),
        Value::Object(entries) => {
            found.extend(entries.get("$ref").and_then(Value::as_str));
            entries.values().for_each(|entry| references(entry, found));
        }
        _ => {}
    }
}

#[test]
fn it_is_a_json_schema() {
    let schema = Workshop::new().run(&["schema"]).exits(0).json();
    assert!(schema["$schema"].as_str().is_some_and(|uri| uri.starts_with("https://json-schema.org/draft")), "{schema}");
    let mut found = Vec::new();
    references(&schema, &mut found);
    for reference in found {
        let pointer = reference.strip_prefix('#').unwrap();
        assert!(schema.pointer(pointer).is_some(), "{reference} leads nowhere");
    }
}

#[test]
fn it_knows_the_keys_of_the_materials() {
    let text = Workshop::new().run(&["schema"]).exits(0).stdout;
    for path in ["materials", "materials/papers"].into_iter().flat_map(material_files) {
        let material = fs::read_to_string(&path).unwrap();
        let keys = material.lines().filter_map(|line| line.split_once(" = ")).map(|(key, _)| key);
        for key in keys.filter(|key| key.chars().all(|c| c.is_ascii_alphanumeric() || c == '_')) {
            assert!(text.contains(&format!("\"{key}\"")), "{}: {key}", path.display());
        }
    }
}
