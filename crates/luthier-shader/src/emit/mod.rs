//! Snippets and complete shaders, each under a comment that says how to use it.

mod manual;

use luthier_manifest::Interface;

use self::manual::manual;
use crate::compose::{Buffer, calls, compose};
use crate::functions::{STRUCTURES, is_public};
use crate::languages::{glsl, hlsl, msl, spirv};
use crate::{Form, MaterialSet, ShaderError, Target, bindings, validate};

/// The entry point of a complete shader, in WGSL.
const FRAGMENT: &str = include_str!("../wgsl/fragment.wgsl");

/// Kind of an emitted text.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Part {
    /// Functions to paste.
    Snippet,
    /// Functions to paste for one material, whose numbers are constants.
    Constant,
    /// A shader with an entry point.
    Complete,
}

/// A snippet to paste: functions, bindings and constants for the materials of a set, without an entry point, below a comment that is
/// its manual. It has been parsed and validated.
///
/// # Errors
/// See [`ShaderError`]: materials that no shader can be emitted for, a defect found by naga, or SPIR-V, which is no text.
pub fn emit(set: &MaterialSet<'_>, form: Form, target: Target) -> Result<String, ShaderError> {
    text(set, form, target, Part::Snippet)
}

/// The snippet for one material, whose numbers are constants of the code: it binds no buffer, and what depends on them alone is
/// computed when the shader is compiled. Same functions; the number of the material is not looked at.
///
/// # Errors
/// As [`emit`], and [`ShaderError::NotOne`] for sets of any other length than 1.
pub fn emit_constant(set: &MaterialSet<'_>, form: Form, target: Target) -> Result<String, ShaderError> {
    match set.materials.len() {
        1 => text(set, form, target, Part::Constant),
        count => Err(ShaderError::NotOne(count)),
    }
}

/// The part of a shader that a program around it calls, fills and binds: functions of its manual and look-ups, and the structures of places.
///
/// # Errors
/// As [`emit`].
pub fn interface(set: &MaterialSet<'_>, form: Form) -> Result<Interface, ShaderError> {
    let mut interface = Interface::read(&compose(set, form, Buffer::Storage)?);
    interface.functions.retain(|function| is_public(&function.name));
    interface.structures.retain(|structure| STRUCTURES.contains(&structure.name.as_str()));
    Ok(interface)
}

/// A complete fragment shader around the snippet: `luthier_eval` for interpolated directions and a flat material number.
/// Its entry point is `main`; in MSL, where no function may have that name, `main_`.
///
/// # Errors
/// As [`emit`].
pub fn complete(set: &MaterialSet<'_>, form: Form, target: Target) -> Result<String, ShaderError> {
    let text = text(set, form, target, Part::Complete)?;
    Ok(match target {
        Target::Wgsl | Target::Hlsl | Target::Msl | Target::SpirV => text,
        Target::Glsl450 => format!("#version 450 core\n{text}\n{}", include_str!("../glsl/fragment_450.glsl")),
        Target::GlslEs300 => {
            let precision = "precision highp float;\nprecision highp int;\n";
            format!("#version 300 es\n{precision}{text}\n{}", include_str!("../glsl/fragment_es300.glsl"))
        }
    })
}

/// A library in SPIR-V 1.3, little endian: capability Linkage, no entry point, and every function exported under its name for
/// a linker (`spirv-link`). Drivers take it only once it is linked.
///
/// # Errors
/// As [`emit`].
pub fn emit_spirv(set: &MaterialSet<'_>, form: Form) -> Result<Vec<u8>, ShaderError> {
    spirv::library_spirv(&body(set, form, Target::SpirV, "")?)
}

/// A complete fragment shader in SPIR-V 1.3 (Vulkan 1.1), little endian, with the entry point `main`.
///
/// # Errors
/// As [`emit`].
pub fn complete_spirv(set: &MaterialSet<'_>, form: Form) -> Result<Vec<u8>, ShaderError> {
    spirv::shader(&body(set, form, Target::SpirV, FRAGMENT)?)
}

/// A text of a language below its manual; entry points of GLSL are the caller's.
fn text(set: &MaterialSet<'_>, form: Form, target: Target, part: Part) -> Result<String, ShaderError> {
    let is_glsl = matches!(target, Target::Glsl450 | Target::GlslEs300);
    let wgsl = match part {
        Part::Constant => compose(set, form, Buffer::Constant)?,
        Part::Complete if !is_glsl => body(set, form, target, FRAGMENT)?,
        Part::Snippet | Part::Complete => body(set, form, target, "")?,
    };
    let body = match target {
        Target::Wgsl => {
            validate(&wgsl)?;
            wgsl.clone()
        }
        Target::Glsl450 | Target::GlslEs300 => {
            glsl::from_wgsl(&wgsl, &bindings(set, form), 0, &calls(set, form), target)?
        }
        Target::Hlsl => hlsl::from_wgsl(&wgsl, &bindings(set, form), 0)?,
        Target::Msl => msl::from_wgsl(&wgsl, &bindings(set, form))?,
        Target::SpirV => return Err(ShaderError::NotText),
    };
    Ok(format!("{}\n{body}", manual(set, form, target, part, &wgsl)?))
}

/// The WGSL that a target is made from, and what WGSL is to follow it.
fn body(set: &MaterialSet<'_>, form: Form, target: Target, more: &str) -> Result<String, ShaderError> {
    let buffer = match target {
        Target::GlslEs300 => Buffer::Texture,
        // Arrays of any length would want a table of lengths as one more argument.
        Target::Msl => Buffer::Sized,
        Target::Wgsl | Target::Glsl450 | Target::Hlsl | Target::SpirV => Buffer::Storage,
    };
    let wgsl = compose(set, form, buffer)?;
    Ok(if more.is_empty() { wgsl } else { format!("{wgsl}\n{more}") })
}
