//! The manual at the top of a text names what is in the text, all of it, and nothing else.

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

use crate::scenes::{Part, clear, conductor, forms, material, sets, tables, text};
use luthier_lut::TableKind;
use luthier_manifest::{FunctionGroup, MaterialEntry};
use luthier_shader::{Form, MaterialSet, Target, bindings, emit, identifier};

/// Functions of the shader's face, as ARCHITECTURE.md has them, each once.
fn face() -> BTreeSet<String> {
    let page = fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("../../ARCHITECTURE.md")).unwrap();
    let part = page.split("## The shader's face").nth(1).unwrap().split("\n\nA material has a model").next().unwrap();
    let quoted = part.split('`').skip(1).step_by(2);
    let names = quoted.filter(|name| name.starts_with("luthier_")).map(|name| name.split('(').next().unwrap());
    names.map(str::to_owned).collect()
}

/// The manual of a text, and the rest.
fn parts(text: &str) -> (&str, &str) {
    let start = text.find("// luthier ").unwrap();
    let (manual, code) = text[start..].split_once("\n\n").unwrap();
    assert!(manual.lines().all(|line| line.starts_with("//") && line.len() <= 140), "{manual}");
    assert!(manual.lines().count() <= 60, "{manual}");
    (manual, code)
}

/// Whether a function is declared: at the start of a line stands its kind or `fn`.
fn declares(code: &str, function: &str) -> bool {
    let call = format!(" {function}(");
    code.lines().any(|line| !line.starts_with([' ', '/']) && line.contains(&call))
}

fn check(what: &str, set: &MaterialSet<'_>, form: Form, has_buffer: bool, text: &str) {
    let (manual, code) = parts(text);
    for function in face() {
        let is_named = match function.strip_prefix("luthier_lookup_") {
            Some(table) => manual.lines().any(|line| line.contains("luthier_lookup_T") && line.contains(table)),
            None => manual.contains(&format!("{function}(")),
        };
        assert_eq!(is_named, declares(code, &function), "{what} {function}:\n{manual}");
    }
    let has_main = ["main(", "main_("].iter().any(|main| code.contains(main));
    assert_eq!(manual.contains(": a fragment shader"), has_main, "{what}:\n{manual}");
    let bound = bindings(set, form);
    for kind in TableKind::ALL {
        let name = format!("luthier_{}", kind.name());
        let is_bound = bound.iter().any(|entry| entry.name == name);
        assert_eq!(manual.contains(&format!("{name}: ")), is_bound, "{what} {name}:\n{manual}");
    }
    assert_eq!(manual.contains("luthier_materials: "), has_buffer, "{what}:\n{manual}");
    for words in
        ["wi points to the light", "unit vectors in the local frame", "+z is the normal", "cos_theta_i, linear Rec.709"]
    {
        assert!(manual.replace("\n//", "").contains(words), "{what} {words}:\n{manual}");
    }
}

#[test]
fn manuals_name_what_is_there() {
    assert_eq!(face().len(), 34, "{:?}", face());
    for (name, materials) in sets() {
        let plain = MaterialSet::new(&materials, tables());
        let whole = MaterialSet { functions: FunctionGroup::ALL.into_iter().collect(), ..plain.clone() };
        for (set, form) in [plain, whole].iter().flat_map(|set| forms(&materials).map(move |form| (set, form))) {
            for target in Target::TEXT {
                let what = format!("{name} {form} {target}");
                let check =
                    |part| check(&what, set, form, part != Part::Constant, &text((name, set), form, target, part));
                [Part::Snippet, Part::Complete].into_iter().for_each(check);
                if materials.len() == 1 {
                    check(Part::Constant);
                }
            }
        }
    }
}

/// Every number has a name while they are few; of many, the first and the last.
#[test]
fn materials_have_numbers_in_the_manual() {
    for count in [1, 6, 7, 63] {
        let materials: Vec<MaterialEntry> =
            (0..count).map(|i| material(&format!("m-{i}-x"), &[clear(), conductor()])).collect();
        let set = MaterialSet::new(&materials, tables());
        let text = emit(&set, Form::Full, Target::Wgsl).unwrap();
        let (manual, code) = parts(&text);
        for (i, material) in materials.iter().enumerate() {
            let constant = identifier(&material.name).unwrap();
            assert!(code.contains(&format!("const {constant}: u32 = {i}u;")), "{text}");
            let entry = format!("//   {i} {}, {constant}: elek, 2 layers\n", material.name);
            assert_eq!(manual.contains(&entry), count <= 6, "{manual}");
        }
        let range = format!("Materials: {count}, from 0 (m-0-x) to {} (m-{}-x).", count - 1, count - 1);
        assert_eq!(manual.contains(&range), count > 6, "{manual}");
    }
}
