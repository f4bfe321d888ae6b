//! GLSL of a composed module: naga's output, with our names, comments and no entry point.

mod comments;
mod tidy;

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write as _;

use luthier_lut::TableKind;
use naga::back::glsl::{Options, PipelineOptions, ReflectionInfo, Version, Writer, WriterFlags};
use naga::proc::BoundsCheckPolicies;
use naga::{GlobalVariable, Handle, Module, ResourceBinding, ShaderStage};

use self::comments::Comments;
use self::tidy::{rename, tidy};
use crate::validate::module;
use crate::{Form, MaterialSet, ShaderError, Target, bindings};

/// naga writes GLSL for an entry point only; this one is cut off again.
const ENTRY: &str = "luthier_entry";
/// Name of the block of the material buffer.
const BLOCK: &str = "LuthierMaterials";

/// Functions, blocks and uniforms in GLSL, without `#version`, precision and `main`.
pub(crate) fn from_wgsl(wgsl: &str, set: &MaterialSet<'_>, form: Form, target: Target) -> Result<String, ShaderError> {
    let (module, info) = module(&format!("{wgsl}\n{}", entry_point(set, form)))?;
    let version = if target == Target::GlslEs300 { Version::new_gles(300) } else { Version::Desktop(450) };
    let slot = |binding: u32| (ResourceBinding { group: 0, binding }, binding as u8);
    let options = Options {
        version,
        writer_flags: WriterFlags::INCLUDE_UNUSED_ITEMS,
        binding_map: bindings(set, form).iter().map(|e| slot(e.binding)).collect(),
        zero_initialize_workgroup_memory: false,
    };
    let pipeline =
        PipelineOptions { shader_stage: ShaderStage::Fragment, entry_point: ENTRY.to_owned(), multiview: None };
    let mut text = String::new();
    let mut writer = Writer::new(&mut text, &module, &info, &options, &pipeline, BoundsCheckPolicies::default())?;
    let names = names(&module, &writer.write()?);
    let body = body(&text)?;
    let body = rename(body, |word| names.get(word).map(String::as_str));
    if body.contains("_group_0_") {
        return Err(ShaderError::GlslShape("a binding without a name"));
    }
    Ok(layout(&body, &module, &Comments::of(wgsl)))
}

/// An entry point that uses every binding, so that naga reports the name it gives to each.
fn entry_point(set: &MaterialSet<'_>, form: Form) -> String {
    let mut out = format!("@fragment fn {ENTRY}() {{\n");
    out.push_str("    _ = luthier_eval(0u, vec3<f32>(), vec3<f32>());\n");
    for table in set.tables_read(form) {
        let arguments = match table.kind {
            TableKind::Fresnel | TableKind::Phase => "0.0, 0.0",
            TableKind::Distribution => "0.0, 0.0, 0.0, 0.0",
            TableKind::Fgd | TableKind::Film | TableKind::Escape => "0.0, 0.0, 0.0",
            TableKind::Thickness => "0.0, vec2<f32>()",
        };
        let _ = writeln!(out, "    _ = luthier_lookup_{}({arguments});", table.kind.name());
    }
    out.push_str("}\n");
    out
}

/// From naga's names of bindings and blocks to ours.
fn names(module: &Module, reflection: &ReflectionInfo) -> BTreeMap<String, String> {
    let global = |handle: Handle<GlobalVariable>| module.global_variables[handle].name.clone().unwrap_or_default();
    let mut names = BTreeMap::new();
    for (name, mapping) in &reflection.texture_mapping {
        names.insert(name.clone(), global(mapping.texture));
    }
    for (&handle, block) in &reflection.uniforms {
        names.insert(block.clone(), BLOCK.to_owned());
        if let Some(at) = &module.global_variables[handle].binding {
            names.insert(format!("_group_{}_binding_{}_fs", at.group, at.binding), global(handle));
        }
    }
    names
}

/// What lies between the precision statements and the entry point.
fn body(text: &str) -> Result<&str, ShaderError> {
    let end = text.find("\nvoid main()").ok_or(ShaderError::GlslShape("no entry point"))?;
    let mut start = 0;
    for line in text[..end].split_inclusive('\n') {
        // Storage blocks need no extension in 450.
        let is_header = line.starts_with('#') || line.starts_with("precision ") || line.trim().is_empty();
        if !is_header {
            break;
        }
        start += line.len();
    }
    Ok(&text[start..end])
}

/// The declarations one by one: comments put back, functions tidied, blank lines between unlike things.
fn layout(body: &str, module: &Module, comments: &Comments<'_>) -> String {
    let globals: BTreeSet<&str> = module
        .functions
        .iter()
        .filter_map(|(_, f)| f.name.as_deref())
        .chain(module.constants.iter().filter_map(|(_, c)| c.name.as_deref()))
        .chain(module.global_variables.iter().filter_map(|(_, v)| v.name.as_deref()))
        .chain(module.types.iter().filter_map(|(_, t)| t.name.as_deref()))
        .collect();
    let mut out = String::with_capacity(body.len() * 2);
    let mut last = String::new();
    for declaration in declarations(body) {
        let first = declaration.lines().next().unwrap_or_default();
        let kind = first.split([' ', '(']).next().unwrap_or_default();
        if !out.is_empty() && (kind != last || declaration.contains('\n')) {
            out.push('\n');
        }
        kind.clone_into(&mut last);
        if kind == "struct" {
            out.push_str(&comments.on_structure(&declaration));
        } else if declaration.contains('\n') {
            let name = first.split('(').next().and_then(|head| head.rsplit(' ').next()).unwrap_or_default();
            comments.write(&mut out, name, "");
            let function = module.functions.iter().find(|(_, f)| f.name.as_deref() == Some(name));
            match function {
                Some((_, function)) => out.push_str(&tidy(&declaration, function, &globals)),
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
        is_open = if is_open { !line.starts_with('}') } else { line.ends_with('{') };
    }
    out
}
