//! Declarations and members that nothing reaches: they are removed, so that modules need no conditions around them.

use std::collections::{BTreeMap, BTreeSet};

use crate::compose::members::{Kinds, assigned, signature, without_missing};
use crate::functions::is_public;
use crate::identifiers::words;

/// Structures of programs around a shader: all their members stay.
const HOSTS: [&str; 4] = ["LuthierPlace", "LuthierLayerPlace", "LuthierSample", "LuthierPick"];

/// The text without functions, structures and constants that no public function reaches, without members that no function reads, and without
/// the statements that fill these. `kept` members of a layer stay, because programs around a shader read them.
pub(crate) fn reached(wgsl: &str, kept: &[&str]) -> String {
    let mut text = declarations_reached(wgsl);
    loop {
        let next = without_missing(&without_unread(&text, kept));
        if next == text {
            return text;
        }
        text = declarations_reached(&next);
    }
}

/// The text with the declarations that public functions, bindings and constants of materials reach.
fn declarations_reached(wgsl: &str) -> String {
    let declarations = declarations(wgsl);
    let mut by_name: BTreeMap<&str, Vec<usize>> = BTreeMap::new();
    for (i, (name, _)) in declarations.iter().enumerate() {
        by_name.entry(name).or_default().push(i);
    }
    let mut reached = BTreeSet::new();
    let mut next: Vec<usize> = (0..declarations.len()).filter(|&i| is_root(declarations[i])).collect();
    while let Some(i) = next.pop() {
        if reached.insert(i) {
            let code = declarations[i].1.lines().filter(|line| !line.trim().starts_with("//"));
            next.extend(code.flat_map(words).filter_map(|word| by_name.get(word)).flatten());
        }
    }
    let kept: Vec<&str> = reached.into_iter().map(|i| declarations[i].1.trim_end()).collect();
    let mut out = String::with_capacity(wgsl.len());
    for text in kept {
        // Constants stand close together, and so do bindings.
        let is_close = !text.contains('\n') && out.lines().next_back().is_some_and(|last| last[..1] == text[..1]);
        out.push_str(if out.is_empty() || is_close { "" } else { "\n" });
        out.push_str(text);
        out.push('\n');
    }
    out
}

/// Whether a declaration is for programs around a shader.
fn is_root((name, text): (&str, &str)) -> bool {
    is_public(name)
        || text.lines().any(|line| line.starts_with('@'))
        || ["LUTHIER_MATERIAL_", "LUTHIER_SURFACE_", "LUTHIER_PROPOSALS"].iter().any(|prefix| name.starts_with(prefix))
}

/// Names and texts of all declarations, with the comments above them.
fn declarations(wgsl: &str) -> Vec<(&str, &str)> {
    let mut found = Vec::new();
    let (mut start, mut at, mut name) = (0, 0, None);
    for line in wgsl.split_inclusive('\n') {
        let end = at + line.len();
        if name.is_none() && line.starts_with(['@', 'c', 'f', 's']) {
            name = match line.strip_prefix("@group(") {
                Some(binding) => binding.split(':').next().and_then(|rest| words(rest).last()),
                None => words(line).nth(2),
            };
        }
        let is_end = match line.as_bytes().first() {
            Some(b'@' | b'c') => line.trim_end().ends_with(';'),
            Some(b'}' | b')') => true,
            _ => false,
        };
        if let (true, Some(declared)) = (is_end, name) {
            // Here the parameters of a function end, and not the function.
            if !(line.starts_with(')') && line.trim_end().ends_with('{')) {
                found.push((declared, wgsl[start..end].trim_start_matches('\n')));
                (start, name) = (end, None);
            }
        }
        at = end;
    }
    found
}

/// The text without members that functions fill and never read.
fn without_unread(wgsl: &str, kept: &[&str]) -> String {
    let dead = unread(wgsl, kept);
    let mut out = String::with_capacity(wgsl.len());
    let (mut structure, mut comments) = ("", Vec::new());
    for line in wgsl.lines() {
        structure = match line.strip_prefix("struct ") {
            Some(name) => name.trim_end_matches([' ', '{']),
            None if line == "}" => "",
            None => structure,
        };
        if !structure.is_empty() && line.trim().starts_with("//") {
            comments.push(line);
            continue;
        }
        let member = line.trim().split_once(": ").map_or("", |(member, _)| member);
        if !dead.contains(&(structure, member)) {
            out.extend(comments.iter().flat_map(|comment| [comment, "\n"]));
            out.extend([line, "\n"]);
        }
        comments.clear();
    }
    out
}

/// Structures and members that no function reads.
fn unread<'t>(wgsl: &'t str, kept: &[&str]) -> BTreeSet<(&'t str, &'t str)> {
    let kinds = Kinds::of(wgsl);
    let code: Vec<&str> = wgsl.lines().map(str::trim).filter(|line| !line.starts_with("//")).collect();
    let made = code.iter().flat_map(|line| words(line).zip(words(line).skip(1)));
    let made: BTreeSet<&str> = made.filter(|(_, next)| next.starts_with('(')).map(|(word, _)| word).collect();
    let mut dead = BTreeSet::new();
    // A constructor takes all members in their order: structures with one stay whole.
    for (name, members) in kinds.structures.iter().filter(|(name, _)| !HOSTS.contains(name) && !made.contains(*name)) {
        let kept = if *name == "LuthierLayer" { kept } else { &[] };
        dead.extend(members.keys().filter(|member| !kept.contains(*member)).map(|member| (*name, *member)));
    }
    // An assignment to an unread member counts as reading nothing, until that member is read.
    let mut assignments = Vec::new();
    let mut variables = BTreeMap::new();
    for line in code {
        if let Some((_, (parameters, _))) = signature(line) {
            variables = kinds.parameters(parameters);
        }
        let target = assigned(line).and_then(|(name, member)| Some((*variables.get(name)?, member)));
        match target.filter(|target| dead.contains(target)) {
            Some(target) => {
                assignments.push((target, kinds.read(line.split_once("= ").map_or("", |of| of.1), &variables)))
            }
            None => kinds.read(line, &variables).iter().for_each(|member| _ = dead.remove(member)),
        }
        kinds.declare(line, &mut variables);
    }
    loop {
        while let Some(i) = assignments.iter().position(|(target, _)| !dead.contains(target)) {
            assignments.swap_remove(i).1.iter().for_each(|member| _ = dead.remove(member));
        }
        // WGSL has no empty structures: the first member stays.
        let is_empty = |name: &str, members: &BTreeMap<_, _>| {
            !members.is_empty() && members.keys().all(|member| dead.contains(&(name, *member)))
        };
        let empty = kinds.structures.iter().find(|(name, members)| is_empty(name, members));
        let Some((name, members)) = empty else { return dead };
        members.keys().take(1).for_each(|member| _ = dead.remove(&(*name, *member)));
    }
}
