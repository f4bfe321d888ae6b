//! Readable text from naga's output: names, comments and order of the WGSL.

mod comments;
mod tidy;

use std::collections::BTreeSet;

use naga::Module;

use self::comments::Comments;
use self::tidy::tidy;

/// Our name for a helper function of naga's, by which another language keeps a promise of WGSL.
pub(crate) fn helper(word: &str) -> Option<String> {
    let name = word.strip_prefix("naga_").or_else(|| word.strip_prefix("Naga"))?;
    Some(format!("luthier_wgsl_{name}"))
}

/// The text with comments of the WGSL put back, functions tidied, and blank lines between unlike declarations.
pub(crate) fn layout(body: &str, module: &Module, wgsl: &str) -> String {
    let comments = Comments::of(wgsl);
    let globals: BTreeSet<&str> = module
        .functions
        .iter()
        .filter_map(|(_, f)| f.name.as_deref())
        .chain(module.constants.iter().filter_map(|(_, c)| c.name.as_deref()))
        .chain(module.global_variables.iter().filter_map(|(_, v)| v.name.as_deref()))
        .chain(module.types.iter().filter_map(|(_, t)| t.name.as_deref()))
        // Types of the language alone, such as MSL's structures around arrays.
        .chain(body.lines().filter_map(|line| line.strip_prefix("struct ")?.strip_suffix(" {")))
        .collect();
    let mut out = String::with_capacity(body.len() * 2);
    let mut last = String::new();
    for declaration in declarations(body) {
        let first = declaration.lines().next().unwrap_or_default();
        let kind =
            if first.contains(": register(") { "binding" } else { first.split([' ', '(']).next().unwrap_or_default() };
        if !out.is_empty() && (kind != last || declaration.contains('\n')) {
            out.push('\n');
        }
        kind.clone_into(&mut last);
        if kind == "struct" {
            out.push_str(&comments.on_structure(&declaration));
        } else if declaration.contains('\n') {
            let name = first.split('(').next().and_then(|head| head.rsplit(' ').next()).unwrap_or_default();
            comments.write(&mut out, name, "");
            // In MSL no function may be `main`: the entry point is `main_`.
            let entry = module.entry_points.iter().find(|e| e.name == name.trim_end_matches('_')).map(|e| &e.function);
            let function = module.functions.iter().map(|(_, f)| f).find(|f| f.name.as_deref() == Some(name)).or(entry);
            match function {
                Some(function) => out.push_str(&tidy(&declaration, function, &globals)),
                None => out.push_str(&declaration),
            }
        } else {
            out.push_str(&declaration);
        }
        if !out.ends_with('\n') {
            out.push('\n');
        }
    }
    out
}

/// The declarations at file level, in order: single lines, structures and functions.
fn declarations(body: &str) -> Vec<String> {
    let mut out: Vec<String> = Vec::new();
    let mut is_open = false;
    for line in body.lines().filter(|line| !line.is_empty()) {
        match out.last_mut() {
            Some(declaration) if is_open => {
                declaration.push('\n');
                declaration.push_str(line);
            }
            _ => out.push(line.to_owned()),
        }
        is_open = if is_open { !line.starts_with('}') } else { line.ends_with(['{', '(']) };
    }
    out
}
