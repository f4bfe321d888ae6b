//! Metal Shading Language of a module: naga's output with luthier's names and comments.
//!
//! No compiler for it runs on Linux; a lint reads it instead.

use luthier_manifest::BindingEntry;
use naga::ResourceBinding;
use naga::back::msl::{BindSamplerTarget, BindTarget, EntryPointResources, Options, PipelineOptions, write_string};

use crate::identifiers::{camel_case, rename};
use crate::languages::lint;
use crate::languages::text::{helper, layout};
use crate::validate::module;
use crate::{ShaderError, Target};

/// Longest line of a joined list of parameters.
const WIDTH: usize = 120;

/// The module in MSL 2.0. Argument indices of entry points are binding numbers.
pub(crate) fn from_wgsl(wgsl: &str, bindings: &[BindingEntry], group: u32) -> Result<String, ShaderError> {
    let (module, info) = module(wgsl)?;
    let slots = bindings.iter().map(|entry| slot(entry, group));
    let resources = EntryPointResources { resources: slots.collect(), ..Default::default() };
    let options = Options {
        lang_version: (2, 0),
        per_entry_point_map: module.entry_points.iter().map(|e| (e.name.clone(), resources.clone())).collect(),
        fake_missing_bindings: false,
        ..Options::default()
    };
    let (text, written) = write_string(&module, &info, &options, &PipelineOptions::default()).map_err(refused)?;
    for name in written.entry_point_names {
        name.map_err(refused)?;
    }
    let text = without_end_padding(&text.replace(", metal::access::sample>", ">"));
    let text = rename(text.trim_start_matches(|c| c != '#'), helper);
    let buffers: Vec<(&str, String)> = bindings.iter().filter_map(|entry| type_of(&text, &entry.name)).collect();
    let body = rename(&text, |word| {
        let buffer = buffers.iter().find(|(of, _)| *of == word).map(|(_, name)| name.clone());
        buffer.or_else(|| wrapper(word))
    });
    if body.to_ascii_lowercase().contains("naga") {
        return Err(refused("a name of naga's is left"));
    }
    let text = layout(&joined(&body), &module, wgsl);
    lint::check(&text, Target::Msl)?;
    Ok(text)
}

fn refused(reason: impl ToString) -> ShaderError {
    ShaderError::untranslatable(Target::Msl, reason)
}

/// naga's name for the type of a buffer, and the one it gets.
fn type_of<'t>(text: &'t str, binding: &str) -> Option<(&'t str, String)> {
    let (before, _) = text.split_once(&format!(" const& {binding}"))?;
    Some((before.rsplit(' ').next()?, camel_case(binding)))
}

/// The name of a structure around an array, which naga numbers.
fn wrapper(word: &str) -> Option<String> {
    let number = word.strip_prefix("type_").filter(|number| number.chars().all(|c| c.is_ascii_digit()))?;
    Some(format!("LuthierArray{number}"))
}

/// Argument index of a binding in an entry point.
fn slot(entry: &BindingEntry, group: u32) -> (ResourceBinding, BindTarget) {
    let at = entry.binding as u8;
    let target = match entry.resource.as_str() {
        _ if entry.is_buffer() => BindTarget { buffer: Some(at), ..BindTarget::default() },
        "sampler" => BindTarget { sampler: Some(BindSamplerTarget::Resource(at)), ..BindTarget::default() },
        _ => BindTarget { texture: Some(at), ..BindTarget::default() },
    };
    (ResourceBinding { group, binding: entry.binding }, target)
}

/// The text without padding at the end of structures: no buffer holds them, and no initialiser names it.
fn without_end_padding(text: &str) -> String {
    let lines: Vec<&str> = text.lines().collect();
    let followed = lines.iter().zip(lines.iter().skip(1).map(Some).chain([None]));
    followed
        .filter(|(line, next)| !(line.starts_with("    char _pad") && *next == Some(&"};")))
        .map(|(line, _)| format!("{line}\n"))
        .collect()
}

/// The text with the head of each function on one line, unless that is too long.
fn joined(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    let mut rest = text;
    while let Some((before, after)) = rest.split_once("(\n    ") {
        let head = before.rsplit('\n').next().unwrap_or_default();
        out.push_str(before);
        rest = after;
        let end = if head.starts_with(' ') { None } else { after.split_once("\n) {\n") };
        match end.map(|(list, tail)| (list.replace("\n    ", " "), tail)) {
            Some((list, tail)) if !list.contains('\n') && head.len() + list.len() + 4 <= WIDTH => {
                out.push_str(&format!("({list}) {{\n"));
                rest = tail;
            }
            _ => out.push_str("(\n    "),
        }
    }
    out + rest
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn short_heads_are_joined() {
        let long = format!("float f(\n    float {},\n    float b\n) {{\n    return b;\n}}\n", "a".repeat(WIDTH));
        assert_eq!(joined(&long), long);
        let short = "int g(\n    int a,\n    int b\n) {\n    return a;\n}\n";
        assert_eq!(joined(&(long.clone() + short)), long + "int g(int a, int b) {\n    return a;\n}\n");
    }

    #[test]
    fn only_padding_at_the_end_goes() {
        let text = "struct A {\n    float a;\n    char _pad1[12];\n    float b;\n    char _pad2[15];\n};\n";
        assert_eq!(without_end_padding(text), "struct A {\n    float a;\n    char _pad1[12];\n    float b;\n};\n");
    }
}
