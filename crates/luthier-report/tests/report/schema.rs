//! `docs/report.schema.json` against reports as they are written.

use std::fs;
use std::path::Path;

use luthier_lut::RowBase;
use luthier_report::{Asked, Device, Form, Settings, judge, limits};
use serde_json::{Value, json};

use crate::fixture::Bake;

/// The schema as documented, a file of the repository.
fn schema() -> Value {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/report.schema.json");
    serde_json::from_str(&fs::read_to_string(path).unwrap()).unwrap()
}

/// The part of JSON Schema 2020-12 that the schema uses; any other keyword is a mistake.
struct Validator {
    root: Value,
}

impl Validator {
    fn errors(&self, schema: &Value, value: &Value, at: &str) -> Vec<String> {
        let mut errors = Vec::new();
        let mut hold = |holds: bool, keyword: &str| {
            if !holds {
                errors.push(format!("{at}: {keyword}"));
            }
        };
        let mut below = Vec::new();
        let members = schema.as_object().unwrap();
        for (keyword, rule) in members {
            match keyword.as_str() {
                "$schema" | "$defs" | "title" | "description" => {}
                "$ref" => {
                    let target = rule.as_str().unwrap().strip_prefix('#').unwrap();
                    below.extend(self.errors(self.root.pointer(target).unwrap(), value, at));
                }
                "const" => hold(value == rule, keyword),
                "enum" => hold(rule.as_array().unwrap().contains(value), keyword),
                "type" => {
                    let types = rule.as_array().cloned().unwrap_or_else(|| vec![rule.clone()]);
                    hold(types.iter().any(|t| is(value, t.as_str().unwrap())), keyword);
                }
                "minimum" => hold(value.as_f64().is_none_or(|v| v >= rule.as_f64().unwrap()), keyword),
                "minItems" => hold(length(value).is_none_or(|n| n >= rule.as_u64().unwrap()), keyword),
                "maxItems" => hold(length(value).is_none_or(|n| n <= rule.as_u64().unwrap()), keyword),
                "anyOf" => {
                    let any = rule.as_array().unwrap().iter().any(|s| self.errors(s, value, at).is_empty());
                    hold(any, keyword);
                }
                "required" => {
                    for name in rule.as_array().unwrap() {
                        hold(value.get(name.as_str().unwrap()).is_some(), &format!("{name} is missing"));
                    }
                }
                "properties" => {
                    for (name, schema) in rule.as_object().unwrap() {
                        if let Some(value) = value.get(name) {
                            below.extend(self.errors(schema, value, &format!("{at}/{name}")));
                        }
                    }
                }
                "additionalProperties" => {
                    assert_eq!(*rule, json!(false));
                    for name in value.as_object().into_iter().flat_map(|o| o.keys()) {
                        hold(members["properties"].get(name).is_some(), &format!("{name} is unknown"));
                    }
                }
                "items" | "prefixItems" => {
                    for (i, item) in value.as_array().into_iter().flatten().enumerate() {
                        let schema = if keyword == "items" { Some(rule) } else { rule.get(i) };
                        if let Some(schema) = schema {
                            below.extend(self.errors(schema, item, &format!("{at}/{i}")));
                        }
                    }
                }
                other => panic!("{other} is not understood here"),
            }
        }
        errors.extend(below);
        errors
    }
}

fn length(value: &Value) -> Option<u64> {
    value.as_array().map(|items| items.len() as u64)
}

fn is(value: &Value, name: &str) -> bool {
    match name {
        "object" => value.is_object(),
        "array" => value.is_array(),
        "string" => value.is_string(),
        "number" => value.is_number(),
        "integer" => value.is_u64() || value.is_i64(),
        "boolean" => value.is_boolean(),
        "null" => value.is_null(),
        other => panic!("no type {other}"),
    }
}

#[test]
fn reports_are_of_the_documented_shape() {
    let validator = Validator { root: schema() };
    let errors = |value: &Value| validator.errors(&validator.root, value, "");
    let bake = Bake::new();
    let good = bake.device(|_, _, _, value| value);
    let broken = bake.device(|form, _, n, value| match (form, n) {
        (Form::Full, 3) => [f32::NAN; 3],
        (Form::Full, 4) => value.map(|v| v + 0.5),
        _ => value,
    });
    let devices: [Option<&dyn Device>; 3] = [None, Some(&good), Some(&broken)];
    for device in devices {
        let settings = Settings {
            pairs_per_set: 200,
            budget: device.map(|_| 1e-2),
            provenance: vec![("a".to_owned(), "b".to_owned())],
            ..Settings::default()
        };
        let mut report = judge(&bake.subject(), device, &settings).unwrap();
        crate::page::filled(&mut report);
        report.limits = limits(&report, &[], &Asked { max_abs: Some(1e-3), flip: Some(1.0), ..Asked::default() });
        report.tables[0].layout.base = RowBase::Schlick;
        assert!(!report.exceptions.is_empty());
        let mut value: Value = serde_json::from_str(&report.to_json().unwrap()).unwrap();
        assert_eq!(errors(&value), Vec::<String>::new());
        // And it notices.
        value["materials"][0]["comparisons"][0]["sets"][1][1]["worst"]["channel"] = json!("R");
        value["tables"][0]["surplus"] = json!(1);
        value["materials"][1]["against_reference"][0]["model"] = json!("lambert");
        value["searches"][0]["front"][1]["form"]["format"] = json!(null);
        value["limits"][0].as_object_mut().unwrap().remove("is_held");
        value["exceptions"][0].as_object_mut().unwrap().remove("parts");
        assert_eq!(errors(&value).len(), 6, "{:?}", errors(&value));
    }
}
