//! Assignments to members of structures that were compiled out: they are removed, so that only the member needs a condition.

use std::collections::{BTreeMap, BTreeSet};

use crate::languages::text::words;

/// A text whose functions assign no member that a structure lacks, nor have a `let` that nothing reads for that.
pub(crate) fn without_missing(wgsl: &str) -> String {
    let mut structures: BTreeMap<&str, BTreeSet<&str>> = BTreeMap::new();
    let mut returned = BTreeMap::new();
    let mut open = None;
    for line in wgsl.lines() {
        if let Some(name) = line.strip_prefix("struct ") {
            open = Some(structures.entry(name.trim_end_matches([' ', '{'])).or_default());
        } else if line == "}" {
            open = None;
        } else if let Some((name, (_, kind))) = signature(line) {
            returned.insert(name, kind);
        } else if let (Some(members), Some((member, _))) = (&mut open, line.trim().split_once(": ")) {
            members.insert(member);
        }
    }
    let mut out = String::with_capacity(wgsl.len());
    let (mut function, mut is_whole) = (Vec::new(), true);
    // Structures that parameters and variables of a function are of.
    let mut kinds: BTreeMap<&str, &str> = BTreeMap::new();
    for line in wgsl.lines() {
        let code = line.trim();
        if let Some((_, (parameters, _))) = signature(line) {
            kinds = parameters.split(", ").filter_map(|parameter| parameter.split_once(": ")).collect();
        } else if let Some((name, kind)) = code.strip_prefix("var ").and_then(|code| variable(code, &kinds, &returned))
        {
            kinds.insert(name, kind);
        }
        let is_missing = assigned(code).is_some_and(|(name, member)| {
            let members = kinds.get(name).and_then(|kind| structures.get(kind));
            members.is_some_and(|members| !members.contains(member))
        });
        match is_missing {
            true => is_whole = false,
            false => function.push(line),
        }
        if line == "}" {
            let lines = function.iter().filter(|line| is_whole || !is_unread(line, &function));
            out.extend(lines.flat_map(|line| [line, "\n"]));
            function.clear();
            is_whole = true;
        }
    }
    out.extend(function.iter().flat_map(|line| [line, "\n"]));
    out
}

/// Name, parameters and kind of the value of a function, from its first line.
fn signature(line: &str) -> Option<(&str, (&str, &str))> {
    let (name, rest) = line.strip_prefix("fn ")?.split_once('(')?;
    Some((name, rest.strip_suffix(" {")?.split_once(") -> ")?))
}

/// Name and structure of a variable: of `NAME: KIND;`, `NAME = VARIABLE;` or `NAME = FUNCTION(...`.
fn variable<'t>(
    code: &'t str,
    kinds: &BTreeMap<&str, &'t str>,
    returned: &BTreeMap<&str, &'t str>,
) -> Option<(&'t str, &'t str)> {
    if let Some((name, value)) = code.split_once(" = ") {
        let kind = match value.split_once('(') {
            Some((function, _)) => returned.get(function),
            None => kinds.get(value.trim_end_matches(';')),
        };
        return Some((name, *kind?));
    }
    code.strip_suffix(';')?.split_once(": ")
}

/// Variable and member of a line `VARIABLE.MEMBER = ...`, or with `+=` or `*=`.
fn assigned(code: &str) -> Option<(&str, &str)> {
    let (target, _) = code.split_once("= ")?;
    let (name, member) = target.trim_end_matches([' ', '+', '*']).split_once('.')?;
    let is_name = |text: &str| text.chars().all(|c| c.is_ascii_alphanumeric() || c == '_');
    (is_name(name) && is_name(member)).then_some((name, member))
}

/// Whether a line is a `let` that no other line of code mentions.
fn is_unread(line: &str, function: &[&str]) -> bool {
    let declared = line.trim().strip_prefix("let ").and_then(|rest| rest.split_once(" = "));
    let code = function.iter().filter(|line| !line.trim().starts_with("//"));
    declared.is_some_and(|(name, _)| code.flat_map(|line| words(line)).filter(|word| *word == name).count() < 2)
}

#[cfg(test)]
mod tests {
    use luthier_lut::TableKind;

    use super::*;
    use crate::compose::blocks::modules;

    /// A member that no structure has in any set is a slip, which would go unseen.
    #[test]
    fn modules_assign_members_that_some_set_has() {
        let modules = modules();
        let lines = || modules.iter().flat_map(|(_, module)| module.lines());
        let declared = lines().filter_map(|line| line.strip_suffix(',')?.trim().split_once(": ")).map(|(name, _)| name);
        let tiles = TableKind::ALL.map(|kind| format!("{}_tile", kind.name()));
        let declared: BTreeSet<&str> = declared.chain(tiles.iter().map(String::as_str)).collect();
        let assigned: Vec<_> = lines().filter_map(|line| assigned(line.trim())).collect();
        assert!(assigned.len() > 50, "{assigned:?}");
        for (name, member) in assigned {
            assert!(declared.contains(member), "{name}.{member}");
        }
    }

    #[test]
    fn what_assigns_a_missing_member_goes_with_it() {
        let text = |member: &str, read: &str, lines: &[&str; 3]| {
            let [first, second, third] = lines;
            format!(
                "struct S {{\n{member}    b: f32,\n}}\n\nstruct T {{\n    a: f32,\n}}\n\nfn s(t: T) -> S {{\n{read}    var s: S;\n{first}    \
                 s.b = 1.0;\n    return s;\n}}\n\nfn t(given: S, t: T) -> S {{\n    var next = given;\n{second}    var other = t;\n    \
                 other.a = 1.0;\n    var third = s(t);\n    // read a\n{third}    if third.b == 2.0 {{\n        return third;\n    }}\n    \
                 return next;\n}}\n"
            )
        };
        let (member, read) = ("    a: f32,\n", "    let read = f();\n");
        let lines = ["    s.a = read;\n", "    next.a *= 2.0;\n", "    third.a += t.a;\n"];
        let whole = text(member, read, &lines);
        assert_eq!(without_missing(&whole), whole);
        assert_eq!(without_missing(&text("", read, &lines)), text("", "", &[""; 3]));
    }
}
