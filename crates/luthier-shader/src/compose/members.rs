//! Assignments to members of structures that were compiled out: they are removed, so that only the member needs a condition.

use std::collections::BTreeMap;

use crate::identifiers::{is_of_word, words};

/// Structures of a text, and types of the values of its functions.
pub(crate) struct Kinds<'t> {
    /// Members of structures, and their types.
    pub(crate) structures: BTreeMap<&'t str, BTreeMap<&'t str, &'t str>>,
    /// Structures by their members.
    having: BTreeMap<&'t str, Vec<&'t str>>,
    returned: BTreeMap<&'t str, &'t str>,
}

impl<'t> Kinds<'t> {
    pub(crate) fn of(wgsl: &'t str) -> Self {
        let mut kinds = Self { structures: BTreeMap::new(), having: BTreeMap::new(), returned: BTreeMap::new() };
        let mut open = None;
        for line in wgsl.lines() {
            if let Some(name) = line.strip_prefix("struct ") {
                open = Some(kinds.structures.entry(name.trim_end_matches([' ', '{'])).or_default());
            } else if line == "}" {
                open = None;
            } else if let Some((name, (_, kind))) = signature(line) {
                kinds.returned.insert(name, kind);
            } else if let (Some(members), Some((member, kind))) = (&mut open, line.trim().split_once(": ")) {
                members.insert(member, kind.trim_end_matches(','));
            }
        }
        for (name, members) in &kinds.structures {
            members.keys().for_each(|member| kinds.having.entry(member).or_default().push(name));
        }
        kinds
    }

    /// Types of the parameters of a function.
    pub(crate) fn parameters(&self, parameters: &'t str) -> BTreeMap<&'t str, &'t str> {
        parameters.split(", ").filter_map(|parameter| parameter.split_once(": ")).collect()
    }

    /// Adds the variable of a declaration with a known type: `NAME: KIND;`, `NAME = VARIABLE;` or `NAME = FUNCTION(...`.
    pub(crate) fn declare(&self, code: &'t str, variables: &mut BTreeMap<&'t str, &'t str>) {
        let Some(declared) = code.strip_prefix("var ").or_else(|| code.strip_prefix("let ")) else { return };
        let Some((name, value)) = declared.split_once(" = ") else {
            variables.extend(declared.strip_suffix(';').and_then(|declared| declared.split_once(": ")));
            return;
        };
        let kind = match value.split_once('(') {
            Some((function, rest))
                if rest.ends_with(");") && rest.matches(')').count() == 1 + rest.matches('(').count() =>
            {
                self.returned.get(function)
            }
            Some(_) => None,
            None => variables.get(value.trim_end_matches(';')),
        };
        match kind.copied() {
            Some(kind) => variables.insert(name, kind),
            None => variables.remove(name),
        };
    }

    /// Members of structures that a line reads. If the structure is unknown, every structure with such a member counts.
    pub(crate) fn read(&self, code: &'t str, variables: &BTreeMap<&'t str, &'t str>) -> Vec<(&'t str, &'t str)> {
        let mut found = Vec::new();
        let mut rest = code;
        // The type of the value before a dot; `None` if it is unknown.
        let mut kind: Option<&str> = None;
        let mut is_first = true;
        while let Some(next) = rest.chars().next() {
            let end = rest.find(|c| !is_of_word(c)).unwrap_or(rest.len());
            let (word, after) = rest.split_at(end);
            match next {
                _ if end == 0 => {
                    is_first = next != '.';
                    kind = if is_first { None } else { kind };
                    rest = &rest[next.len_utf8()..];
                }
                _ if is_first => {
                    kind = variables.get(word).copied();
                    rest = after;
                }
                _ => {
                    let known = kind.map(|kind| self.structures.get_key_value(kind));
                    kind = match known {
                        Some(Some((name, members))) => {
                            found.extend(members.get_key_value(word).map(|(member, _)| (*name, *member)));
                            members.get(word).copied()
                        }
                        Some(None) => Some(""),
                        None => {
                            found.extend(
                                self.having
                                    .get_key_value(word)
                                    .into_iter()
                                    .flat_map(|(member, names)| names.iter().map(|name| (*name, *member))),
                            );
                            None
                        }
                    };
                    rest = after;
                }
            }
        }
        found
    }
}

/// The text without assignments to members that structures lack, and without each `let` that is unread for that.
pub(crate) fn without_missing(wgsl: &str) -> String {
    let kinds = Kinds::of(wgsl);
    let mut out = String::with_capacity(wgsl.len());
    let mut function = Vec::new();
    let mut variables = BTreeMap::new();
    for line in wgsl.lines() {
        let code = line.trim();
        if let Some((_, (parameters, _))) = signature(line) {
            variables = kinds.parameters(parameters);
        }
        kinds.declare(code, &mut variables);
        let is_missing = assigned(code).is_some_and(|(name, member)| {
            let members = variables.get(name).and_then(|kind| kinds.structures.get(kind));
            members.is_some_and(|members| !members.contains_key(member))
        });
        if !is_missing {
            function.push(line);
        }
        if line == "}" {
            without_unread_lets(&mut function);
            out.extend(function.drain(..).flat_map(|line| [line, "\n"]));
        }
    }
    out.extend(function.iter().flat_map(|line| [line, "\n"]));
    out
}

/// Name, parameters and kind of the value of a function, from its first line.
pub(crate) fn signature(line: &str) -> Option<(&str, (&str, &str))> {
    let (name, rest) = line.strip_prefix("fn ")?.split_once('(')?;
    Some((name, rest.strip_suffix(" {")?.split_once(") -> ")?))
}

/// Variable and member of a line `VARIABLE.MEMBER = ...`, or with `+=` or `*=`.
pub(crate) fn assigned(code: &str) -> Option<(&str, &str)> {
    let (target, _) = code.split_once("= ")?;
    let (name, member) = target.trim_end_matches([' ', '+', '*']).split_once('.')?;
    name.chars().chain(member.chars()).all(is_of_word).then_some((name, member))
}

/// Removes every `let` that no other line of a function mentions.
fn without_unread_lets<'t>(function: &mut Vec<&'t str>) {
    let mut counts: BTreeMap<&str, usize> = BTreeMap::new();
    for word in function.iter().filter(|line| !line.trim().starts_with("//")).flat_map(|line| words(line)) {
        *counts.entry(word).or_default() += 1;
    }
    // From the last line up: a `let` that only a removed line read is removed, too.
    for i in (0..function.len()).rev() {
        let line: &'t str = function[i];
        let declared = line.trim().strip_prefix("let ").filter(|_| line.ends_with(';'));
        if declared.and_then(|rest| rest.split_once(" = ")).is_some_and(|(name, _)| counts.get(name) < Some(&2)) {
            words(line).for_each(|word| *counts.entry(word).or_default() -= 1);
            function.remove(i);
        }
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

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
