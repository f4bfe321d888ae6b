//! naga's temporaries and numbered names, made readable again.

use std::collections::{BTreeMap, BTreeSet};

use naga::{Block, Function, Statement};

use crate::identifiers::{rename, words};

/// A function with the names of its values in WGSL, unless they clash; without temporaries whose only use is on the next line; without brackets
/// around whole expressions and arguments.
///
/// Precondition: functions have no side effects, and there are no loops. Otherwise moving a value to its use could change it.
pub(super) fn tidy(text: &str, function: &Function, globals: &BTreeSet<&str>) -> String {
    let mut names: BTreeMap<String, String> = BTreeMap::new();
    let mut taken: BTreeSet<String> = local_words(text).map(str::to_owned).collect();
    let mut wanted: Vec<(String, String)> = Vec::new();
    calls(&function.body, &mut |index, result| {
        if let Some(name) = function.named_expressions.get(&result) {
            wanted.push((format!("_e{index}"), name.clone()));
        }
    });
    wanted.extend(local_words(text).filter_map(|word| Some((word.to_owned(), unnumbered(word)?.to_owned()))));
    for (from, to) in wanted {
        if names.contains_key(&from) || !taken.contains(&from) || globals.contains(from.as_str()) {
            continue;
        }
        if !taken.contains(&to) && !globals.contains(to.as_str()) && !RESERVED.split(' ').any(|word| word == to) {
            taken.insert(to.clone());
            names.insert(from, to);
        }
    }
    let renamed = rename(text, |word| names.get(word).map(String::as_str));
    let lines = declared_late(without_temporaries(renamed.lines().map(str::to_owned).collect()));
    lines.iter().map(|line| unbracketed(line) + "\n").collect()
}

/// The identifiers of a function that are not members.
fn local_words(text: &str) -> impl Iterator<Item = &str> {
    let mut is_member = false;
    words(text).filter(move |word| {
        let is_identifier = word.starts_with(|c: char| c.is_ascii_alphabetic() || c == '_');
        let keep = is_identifier && !is_member;
        is_member = word.ends_with('.');
        keep
    })
}

/// Visits the results of all calls, each with naga's number for it.
fn calls(block: &Block, visit: &mut impl FnMut(usize, naga::Handle<naga::Expression>)) {
    for statement in block.iter() {
        match statement {
            Statement::Call { result: Some(result), .. } => visit(result.index(), *result),
            Statement::Block(inner) => calls(inner, visit),
            Statement::If { accept, reject, .. } => {
                calls(accept, visit);
                calls(reject, visit);
            }
            _ => {}
        }
    }
}

/// `name` of `name_3`: naga numbers a name that it has seen before.
fn unnumbered(word: &str) -> Option<&str> {
    let (name, number) = word.rsplit_once('_')?;
    let is_numbered = !number.is_empty() && number.chars().all(|c| c.is_ascii_digit());
    (is_numbered && name.ends_with(|c: char| c.is_ascii_alphabetic())).then_some(name)
}

/// Words that WGSL allows and another language reserves, as far as a shader may well use them as names of values.
const RESERVED: &str = "active asm attribute buffer centroid char common constant device double filter fixed flat fragment half highp in \
    inline inout input kernel line linear long lowp matrix metal out output partition pass patch point precise \
    sample sampler shared short smooth string superp technique texture triangle varying vector vertex";

/// Moves the value of `TYPE _eN = VALUE;` into the next line, if only that line reads it.
fn without_temporaries(mut lines: Vec<String>) -> Vec<String> {
    // A move takes a name away and changes the number of no other.
    let mut counts: BTreeMap<String, usize> = BTreeMap::new();
    for word in lines.iter().flat_map(|line| words(line)).filter(|word| word.starts_with("_e")) {
        *counts.entry(word.to_owned()).or_default() += 1;
    }
    for i in (0..lines.len().saturating_sub(1)).rev() {
        let Some((name, value)) = temporary(&lines[i]).map(|(name, value)| (name.to_owned(), value.to_owned())) else {
            continue;
        };
        if counts.get(&name) == Some(&2) && uses(&lines[i + 1], &name) == 1 {
            let value = if is_compound(&value) { format!("({value})") } else { value };
            lines[i + 1] = rename(&lines[i + 1], |word| (word == name).then_some(value.as_str()));
            lines.remove(i);
        }
    }
    lines
}

/// How often a line mentions a name.
fn uses(line: &str, name: &str) -> usize {
    // Most lines lack it, and a search for bytes is quicker than one for words.
    if line.contains(name) { words(line).filter(|word| *word == name).count() } else { 0 }
}

/// Name and value of a line that declares a temporary of naga's.
fn temporary(line: &str) -> Option<(&str, &str)> {
    let (declared, value) = line.trim_start().strip_suffix(';')?.split_once(" = ")?;
    let name = declared.split_once(' ')?.1;
    name.strip_prefix("_e")?.parse::<usize>().ok()?;
    Some((name, value))
}

/// Whether a value has an operator outside all brackets.
fn is_compound(value: &str) -> bool {
    let mut depth = 0;
    value.chars().any(|c| {
        match c {
            '(' | '[' | '{' => depth += 1,
            ')' | ']' | '}' => depth -= 1,
            _ => {}
        }
        depth == 0 && c == ' '
    })
}

/// The lines with each variable declared at its first assignment, if that is at the outer level. naga declares all variables at the top.
fn declared_late(mut lines: Vec<String>) -> Vec<String> {
    let mut i = 1;
    while i < lines.len() {
        let found = late_declaration(&lines, i);
        if let Some((first, line)) = found {
            lines[first] = line;
            lines.remove(i);
        } else {
            i += 1;
        }
    }
    lines
}

/// Number and new text of the line that can take over a declaration in line `i`.
fn late_declaration(lines: &[String], i: usize) -> Option<(usize, String)> {
    let (declared, _) = lines[i].strip_suffix(';')?.split_once(" = ")?;
    let (kind, name) = declared.trim_start().split_once(' ')?;
    let first = (i + 1..lines.len()).find(|&j| uses(&lines[j], name) > 0)?;
    let value = lines[first].strip_prefix("    ")?.strip_prefix(name)?.strip_prefix(" = ")?;
    (uses(value, name) == 0).then(|| (first, format!("    {kind} {name} = {value}")))
}

/// The line without brackets around a whole argument, index, condition or value.
fn unbracketed(line: &str) -> String {
    let bytes = line.as_bytes();
    let mut open = Vec::new();
    let mut dropped = BTreeSet::new();
    for (end, &byte) in bytes.iter().enumerate() {
        match byte {
            b'(' => open.push(end),
            b')' => {
                let Some(start) = open.pop() else { return line.to_owned() };
                let (before, after) = (&line[..start], bytes.get(end + 1));
                let is_argument = before.ends_with(['(', '[']) || before.ends_with(", ");
                let is_value = before.ends_with(" = ") || before.ends_with("return ");
                let is_argument_end = matches!(after, Some(b')' | b']' | b','));
                if (is_argument && is_argument_end) || (is_value && after == Some(&b';')) {
                    dropped.extend([start, end]);
                }
            }
            _ => {}
        }
    }
    line.char_indices().filter(|(i, _)| !dropped.contains(i)).map(|(_, c)| c).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn brackets_go_only_where_they_enclose_the_whole() {
        for (line, expected) in [
            ("    float x = (a + b);", "    float x = a + b;"),
            ("    float x = (a + b) * (c + d);", "    float x = (a + b) * (c + d);"),
            ("    return ((a + b) * (c + d));", "    return (a + b) * (c + d);"),
            ("    if ((a < b)) {", "    if (a < b) {"),
            ("    if ((a < b) && (c < d)) {", "    if ((a < b) && (c < d)) {"),
            ("    x = vec2((a + b), ((c + d) * e));", "    x = vec2(a + b, (c + d) * e);"),
            ("    x = words[(first + 1u)];", "    x = words[first + 1u];"),
            ("    f();", "    f();"),
        ] {
            assert_eq!(unbracketed(line), expected);
        }
    }

    #[test]
    fn renaming_leaves_members_alone() {
        let text = rename("a.alpha = alpha_1 + alpha;", |w| (w == "alpha").then_some("beta"));
        assert_eq!(text, "a.alpha = alpha_1 + beta;");
        assert_eq!(unnumbered("x_12"), Some("x"));
        assert_eq!(unnumbered("x_"), None);
        assert_eq!(unnumbered("_12"), None);
    }

    #[test]
    fn temporaries_move_only_into_their_one_use() {
        let lines = |text: &str| text.lines().map(str::to_owned).collect::<Vec<_>>();
        let once = "float f() {\n    float _e3 = g(x);\n    float _e4 = h(y);\n    return _e3 + _e4;\n}";
        assert_eq!(without_temporaries(lines(once)), lines("float f() {\n    return g(x) + h(y);\n}"));
        for kept in [
            "float f() {\n    float _e3 = g(x);\n    return _e3 * _e3;\n}",
            "float f() {\n    float _e3 = x;\n    x = 1.0;\n    return _e3;\n}",
        ] {
            assert_eq!(without_temporaries(lines(kept)), lines(kept));
        }
    }

    #[test]
    fn a_value_with_an_operator_moves_in_brackets() {
        let lines = ["float f() {", "    float _e3 = a + b;", "    return _e3 * c;", "}"].map(str::to_owned);
        assert_eq!(without_temporaries(lines.to_vec())[1], "    return (a + b) * c;");
        for (value, expected) in
            [("g(a + b)", false), ("a[i + 1].xyz", false), ("(a + b) * c", true), ("P {a, b}", true)]
        {
            assert_eq!(is_compound(value), expected, "{value}");
        }
    }

    #[test]
    fn variables_are_declared_at_their_first_value() {
        let lines = |text: &str| text.lines().map(str::to_owned).collect::<Vec<_>>();
        let early = "void f() {\n    float x = 0.0;\n    float y = 1.0;\n    x = y + 2.0;\n}";
        assert_eq!(declared_late(lines(early)), lines("void f() {\n    float y = 1.0;\n    float x = y + 2.0;\n}"));
        for kept in [
            "void f() {\n    float x = 0.0;\n    x = x + 2.0;\n}",
            "void f() {\n    float x = 0.0;\n    if (a) {\n        x = 2.0;\n    }\n}",
            "void f() {\n    P x = P(0.0);\n    x.y = 2.0;\n    x = z;\n}",
        ] {
            assert_eq!(declared_late(lines(kept)), lines(kept));
        }
    }
}
