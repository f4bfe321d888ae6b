//! Packages with names and bindings of their own.

use std::collections::BTreeSet;

use luthier_manifest::{FunctionGroup, Names};
use luthier_shader::{Form, MaterialSet, ShaderError, Target, bindings, complete, emit, emit_spirv, validate};

use crate::scenes::{sets, tables};

fn named(prefix: &str, group: u32, first_binding: u32) -> Names {
    Names { prefix: prefix.to_owned(), group, first_binding }
}

/// Names that a text declares at its top level: functions, structures, constants, blocks and resources.
fn declared(text: &str) -> BTreeSet<String> {
    let is_of_word = |c: char| c.is_ascii_alphanumeric() || c == '_';
    let mut names = BTreeSet::new();
    for line in text.lines().filter(|line| line.starts_with(|c: char| c.is_ascii_alphabetic() || c == '@')) {
        if line.starts_with("using ") {
            continue;
        }
        let line = line.replace("metal::", "");
        let line = line.as_str();
        // The name is the last word before what follows it; attributes and layouts come before it.
        let line =
            line.strip_prefix("@group(").map_or(line, |line| line.split_once(") var").map_or(line, |(_, rest)| rest));
        let line =
            line.strip_prefix("layout(").map_or(line, |line| line.split_once(')').map_or(line, |(_, rest)| rest));
        let end = line.find(['(', ':', ';', '=', '{', '[']).unwrap_or(line.len());
        names.extend(line[..end].split(|c| !is_of_word(c)).rfind(|word| !word.is_empty()).map(str::to_owned));
    }
    names
}

/// Oracle: naga reads both packages as one module; and no language declares a name without the prefix.
#[test]
fn two_packages_are_one_program() {
    let sets = sets();
    for (name, materials) in sets.iter().filter(|(name, _)| ["models", "lobes-mixed", "everything"].contains(name)) {
        let functions = FunctionGroup::ALL.into_iter().collect();
        let own = MaterialSet { functions, ..MaterialSet::new(materials, tables()) };
        let [car, room] =
            [named("car", 0, 0), named("the_room", 0, 16)].map(|names| MaterialSet { names, ..own.clone() });
        let [first, second] = [&car, &room].map(|set| emit(set, Form::Baked, Target::Wgsl).unwrap());
        validate(&format!("{first}\n{second}")).unwrap_or_else(|e| panic!("{name}: {e}"));
        assert!(
            !first.contains("luthier_") && second.contains("fn the_room_eval(") && second.contains("struct TheRoom")
        );
        // Without its own names a text is that by default.
        assert_eq!(car.names.own_wgsl(&first), emit(&own, Form::Baked, Target::Wgsl).unwrap());
        for target in Target::TEXT {
            let text = emit(&room, Form::Baked, target).unwrap();
            let known = declared(&text);
            assert!(known.len() > 50, "{name} {target}: {known:?}");
            let is_own = |word: &&String| {
                let word = word.strip_prefix("Construct").unwrap_or(word);
                ["the_room_", "TheRoom", "THE_ROOM_"].iter().any(|prefix| word.starts_with(prefix))
            };
            let foreign: Vec<_> = known.iter().filter(|word| !is_own(word)).collect();
            assert!(foreign.is_empty(), "{name} {target}: {foreign:?}");
        }
        let spirv = emit_spirv(&room, Form::Baked).unwrap();
        let text = String::from_utf8_lossy(&spirv);
        assert!(text.contains("the_room_eval") && !text.contains("luthier_eval"), "{name}");
    }
}

/// Oracle: the numbers by hand, from the list in docs/bindings.md.
#[test]
fn resources_are_where_the_program_has_room() {
    let materials = sets().into_iter().find(|(name, _)| *name == "lobes").unwrap().1;
    let set = MaterialSet { names: named("car", 2, 40), ..MaterialSet::new(&materials, tables()) };
    assert!(
        bindings(&set, Form::Baked)
            .iter()
            .any(|entry| (entry.binding, entry.name.as_str()) == (46, "luthier_materials"))
    );
    for (target, expected) in [
        (Target::Wgsl, "@group(2) @binding(46) var<storage, read> car_materials"),
        (Target::Glsl450, "layout(std430, set = 2, binding = 46) readonly buffer CarMaterials"),
        (Target::Hlsl, "car_materials : register(t46, space2)"),
    ] {
        let text = emit(&set, Form::Baked, target).unwrap();
        assert!(text.contains(expected), "{target}: {text}");
    }
    let msl = complete(&set, Form::Baked, Target::Msl).unwrap();
    assert!(msl.contains("car_materials [[buffer(46)]]"), "{msl}");
    for target in Target::TEXT {
        complete(&set, Form::Baked, target).unwrap_or_else(|e| panic!("{target}: {e}"));
    }
}

#[test]
fn a_prefix_that_other_words_have_is_refused() {
    let materials = sets().into_iter().find(|(name, _)| *name == "lobes").unwrap().1;
    for names in [named("Car", 0, 0), named("", 0, 0), named("car", 99, 0)] {
        let set = MaterialSet { names, ..MaterialSet::new(&materials, tables()) };
        assert!(matches!(emit(&set, Form::Baked, Target::Wgsl), Err(ShaderError::Names(_))), "{:?}", set.names);
    }
    // Parameters of functions begin so.
    let set = MaterialSet { names: named("cos", 0, 0), ..MaterialSet::new(&materials, tables()) };
    let refused = emit(&set, Form::Baked, Target::Wgsl).unwrap_err();
    assert!(
        matches!(&refused, ShaderError::Prefix { prefix, word } if prefix == "cos" && word.starts_with("cos_")),
        "{refused}"
    );
}
