//! GLSL of a module: naga's output with luthier's names and comments, without an entry point.

use std::collections::BTreeMap;

use luthier_manifest::BindingEntry;
use naga::back::glsl::{Options, PipelineOptions, ReflectionInfo, Version, Writer, WriterFlags};
use naga::proc::BoundsCheckPolicies;
use naga::{GlobalVariable, Handle, Module, ResourceBinding, ShaderStage};

use crate::identifiers::{camel_case, rename};
use crate::languages::text::layout;
use crate::validate::module;
use crate::{ShaderError, Target};

/// naga writes GLSL for an entry point only. This one is cut off afterwards.
const ENTRY: &str = "luthier_entry";

/// Functions, blocks and uniforms in GLSL, without `#version`, precision and `main`.
///
/// `calls` are statements that use every binding: naga reports its names only for bindings that the entry point uses.
pub(crate) fn from_wgsl(
    wgsl: &str,
    bindings: &[BindingEntry],
    group: u32,
    calls: &str,
    target: Target,
) -> Result<String, ShaderError> {
    let (module, info) = module(&format!("{wgsl}\n@fragment fn {ENTRY}() {{\n{calls}}}\n"))?;
    let version = if target == Target::GlslEs300 { Version::new_gles(300) } else { Version::Desktop(450) };
    let slots = bindings.iter().map(|e| (ResourceBinding { group, binding: e.binding }, e.binding as u8));
    let options = Options {
        version,
        writer_flags: WriterFlags::INCLUDE_UNUSED_ITEMS,
        binding_map: slots.collect(),
        zero_initialize_workgroup_memory: false,
    };
    let pipeline =
        PipelineOptions { shader_stage: ShaderStage::Fragment, entry_point: ENTRY.to_owned(), multiview: None };
    let mut text = String::new();
    let names = Writer::new(&mut text, &module, &info, &options, &pipeline, BoundsCheckPolicies::default())
        .and_then(|mut writer| writer.write())
        .map(|reflection| names(&module, &reflection))
        .map_err(|e| ShaderError::untranslatable(target, e))?;
    let body = body(&text).ok_or_else(|| ShaderError::untranslatable(target, "no entry point"))?;
    let body = rename(body, |word| names.get(word).map(String::as_str));
    if body.contains(&format!("_group_{group}_")) {
        return Err(ShaderError::untranslatable(target, "a binding without a name"));
    }
    Ok(layout(&body, &module, wgsl))
}

/// Names in the WGSL by naga's names of bindings and blocks.
fn names(module: &Module, reflection: &ReflectionInfo) -> BTreeMap<String, String> {
    let mut names = BTreeMap::new();
    for (name, mapping) in &reflection.texture_mapping {
        names.insert(name.clone(), global(module, mapping.texture));
    }
    for (&handle, block) in &reflection.uniforms {
        names.insert(block.clone(), camel_case(&global(module, handle)));
        if let Some(at) = &module.global_variables[handle].binding {
            names.insert(format!("_group_{}_binding_{}_fs", at.group, at.binding), global(module, handle));
        }
    }
    names
}

/// Name of a binding in the WGSL.
fn global(module: &Module, handle: Handle<GlobalVariable>) -> String {
    module.global_variables[handle].name.clone().unwrap_or_default()
}

/// The text between the precision statements and the entry point.
fn body(text: &str) -> Option<&str> {
    let end = text.find("\nvoid main()")?;
    let mut start = 0;
    for line in text[..end].split_inclusive('\n') {
        // Storage blocks need no extension in 450.
        let is_header = line.starts_with('#') || line.starts_with("precision ") || line.trim().is_empty();
        if !is_header {
            break;
        }
        start += line.len();
    }
    Some(&text[start..end])
}
