//! HLSL of a module: naga's output with luthier's names and comments, and with plain samplers.

use luthier_manifest::BindingEntry;
use naga::back::hlsl::{Options, PipelineOptions, ShaderModel, Writer};

use crate::identifiers::rename;
use crate::languages::lint;
use crate::languages::text::{helper, layout};
use crate::validate::module;
use crate::{ShaderError, Target};

/// The module in shader model 5.1. Registers are binding numbers, in the space of the group.
pub(crate) fn from_wgsl(wgsl: &str, bindings: &[BindingEntry], group: u32) -> Result<String, ShaderError> {
    let (module, info) = module(wgsl)?;
    let options = Options { shader_model: ShaderModel::V5_1, restrict_indexing: false, ..Options::default() };
    let mut text = String::new();
    let pipeline = PipelineOptions { entry_point: None };
    let written = Writer::new(&mut text, &options, &pipeline).write(&module, &info, None).map_err(refused)?;
    for name in written.entry_point_names {
        name.map_err(refused)?;
    }
    let body = plain_sampler(&text.replace("\n{\n", " {\n"), bindings, group);
    let body = rename(&without_ceremony(&body), helper);
    if body.to_ascii_lowercase().contains("naga") {
        return Err(refused("a name of naga's is left"));
    }
    let text = layout(&body, &module, wgsl);
    lint::check(&text, Target::Hlsl)?;
    Ok(text)
}

fn refused(reason: impl ToString) -> ShaderError {
    ShaderError::untranslatable(Target::Hlsl, reason)
}

/// The text with each sampler as a declaration, instead of an index into naga's heap of samplers.
fn plain_sampler(text: &str, bindings: &[BindingEntry], group: u32) -> String {
    let space = if group == 0 { String::new() } else { format!(", space{group}") };
    let mut out = String::with_capacity(text.len());
    for line in text.lines() {
        let declared =
            line.strip_prefix("static const SamplerState ").and_then(|rest| rest.split_once(" = nagaSamplerHeap["));
        if let Some((name, _)) = declared {
            // naga appends an underscore to a reserved word of HLSL.
            let names = [Some(name), name.strip_suffix('_')];
            for entry in bindings.iter().filter(|entry| names.contains(&Some(entry.name.as_str()))) {
                out.push_str(&format!("SamplerState {name} : register(s{}{space});\n", entry.binding));
            }
        } else if !(line.contains(" nagaSamplerHeap[")
            || line.contains(" nagaComparisonSamplerHeap[")
            || line.contains("SamplerIndexArray :"))
        {
            out.push_str(line);
            out.push('\n');
        }
    }
    out
}

/// The text without padding of structures (no buffer holds them), without `const` before temporaries, and without names for values that are
/// returned at once.
fn without_ceremony(text: &str) -> String {
    let mut lines: Vec<String> = Vec::new();
    for line in text.lines().filter(|line| !is_padding(line)) {
        let code = line.trim_start();
        let indent = &line[..line.len() - code.len()];
        let code = if indent.is_empty() { code } else { code.strip_prefix("const ").unwrap_or(code) };
        let value = code.strip_prefix("return ").and_then(|rest| rest.strip_suffix(';')).and_then(|name| {
            let (kind, value) = lines.last()?.trim_start().strip_suffix(';')?.split_once(&format!(" {name} = "))?;
            let is_named_for_it =
                name.trim_end_matches(|c: char| c.is_ascii_digit() || c == '_') == kind.to_lowercase();
            is_named_for_it.then(|| value.to_owned())
        });
        match value {
            Some(value) => {
                lines.pop();
                lines.push(format!("{indent}return {value};"));
            }
            None => lines.push(format!("{indent}{code}")),
        }
    }
    lines.join("\n") + "\n"
}

/// Whether a line declares padding of a structure.
fn is_padding(line: &str) -> bool {
    let name = line.strip_prefix("    ").and_then(|l| l.strip_suffix(';')).and_then(|l| l.rsplit(' ').next());
    name.is_some_and(|name| name.starts_with("_pad") || name.starts_with("_end_pad"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ceremony_goes_and_the_rest_stays() {
        for (text, expected) in [
            ("    float3 a;\n    int _pad1_0;\n    int _end_pad_2;\n    float b;\n", "    float3 a;\n    float b;\n"),
            ("    const Path path_2 = next;\n    return path_2;\n", "    return next;\n"),
            ("    float kept = a;\n    return kept;\n", "    float kept = a;\n    return kept;\n"),
            ("    return 1.0;\n", "    return 1.0;\n"),
            ("static const uint A = 0u;\n", "static const uint A = 0u;\n"),
        ] {
            assert_eq!(without_ceremony(text), expected);
        }
    }
}
