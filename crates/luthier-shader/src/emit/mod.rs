//! Snippets and complete shaders, each below its manual.

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

/// A snippet to paste: functions, bindings and constants for the materials of a set, without an entry point. A comment at its top is its
/// manual. naga has parsed and validated it.
///
/// ```
/// use luthier_manifest::{LayerKind, LayerRecord, MaterialEntry};
/// use luthier_shader::{Form, MaterialSet, Target, emit};
///
/// let layer = LayerRecord { kind: LayerKind::Diffuse, albedo: [0.8; 3], ..LayerRecord::default() };
/// let materials = [MaterialEntry { name: "chalk".to_owned(), layers: vec![layer], ..MaterialEntry::default() }];
/// let hlsl = emit(&MaterialSet::new(&materials, Vec::new()), Form::Full, Target::Hlsl)?;
/// assert!(hlsl.contains("float3 luthier_eval(uint material, float3 wi, float3 wo)"));
/// # Ok::<(), luthier_shader::ShaderError>(())
/// ```
///
/// # Errors
/// See [`ShaderError`]: the set has no shader, naga finds a defect, or the target is SPIR-V, which is no text.
pub fn emit(set: &MaterialSet<'_>, form: Form, target: Target) -> Result<String, ShaderError> {
    text(set, form, target, Part::Snippet)
}

/// The snippet for one material, whose numbers are constants of the code. It binds no buffer, and compilers evaluate expressions of these numbers
/// beforehand. Functions keep their signatures, and ignore the number of the material.
///
/// # Errors
/// As [`emit`], and [`ShaderError::NotOne`] for sets of any other length than 1.
pub fn emit_constant(set: &MaterialSet<'_>, form: Form, target: Target) -> Result<String, ShaderError> {
    match set.materials.len() {
        1 => text(set, form, target, Part::Constant),
        count => Err(ShaderError::NotOne(count)),
    }
}

/// The part of a shader that programs around it use: functions of its manual, look-ups, bindings, and the structures of places.
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
    let entry = |glsl| set.names.named(glsl);
    Ok(match target {
        Target::Wgsl | Target::Hlsl | Target::Msl | Target::SpirV => text,
        Target::Glsl450 => format!("#version 450 core\n{text}\n{}", entry(include_str!("../glsl/fragment_450.glsl"))),
        Target::GlslEs300 => {
            let precision = "precision highp float;\nprecision highp int;\n";
            format!("#version 300 es\n{precision}{text}\n{}", entry(include_str!("../glsl/fragment_es300.glsl")))
        }
    })
}

/// A library in SPIR-V 1.3, little endian: capability Linkage, no entry point, every function exported under its name. Drivers accept it
/// only after a linker (`spirv-link`) has joined it to a shader.
///
/// # Errors
/// As [`emit`].
pub fn emit_spirv(set: &MaterialSet<'_>, form: Form) -> Result<Vec<u8>, ShaderError> {
    spirv::library_spirv(&named(set, body(set, form, Target::SpirV, "")?)?)
}

/// A complete fragment shader in SPIR-V 1.3 (Vulkan 1.1), little endian, with the entry point `main`.
///
/// # Errors
/// As [`emit`].
pub fn complete_spirv(set: &MaterialSet<'_>, form: Form) -> Result<Vec<u8>, ShaderError> {
    spirv::shader(&named(set, body(set, form, Target::SpirV, FRAGMENT)?)?)
}

/// A text in a language, below its manual. [`complete`] adds the entry points of GLSL.
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
            let (group, bindings) = (set.names.group, bindings(set, form));
            let text = glsl::from_wgsl(&wgsl, &bindings, group, &calls(set, form), target)?;
            // OpenGL has one list of bindings, and Vulkan sets.
            let is_apart = group > 0 && target == Target::Glsl450;
            if is_apart { text.replace("binding = ", &format!("set = {group}, binding = ")) } else { text }
        }
        Target::Hlsl => hlsl::from_wgsl(&wgsl, &bindings(set, form), set.names.group)?,
        Target::Msl => msl::from_wgsl(&wgsl, &bindings(set, form), set.names.group)?,
        Target::SpirV => return Err(ShaderError::NotText),
    };
    named(set, format!("{}\n{body}", manual(set, form, target, part, &wgsl)?))
}

/// The text with the names of a set.
fn named(set: &MaterialSet<'_>, text: String) -> Result<String, ShaderError> {
    set.names.check().map_err(ShaderError::Names)?;
    match set.names.clash(&text) {
        Some(word) => Err(ShaderError::Prefix { prefix: set.names.prefix.clone(), word: word.to_owned() }),
        None => Ok(set.names.named(&text)),
    }
}

/// The WGSL from which the text of a target is made, followed by `more`.
fn body(set: &MaterialSet<'_>, form: Form, target: Target, more: &str) -> Result<String, ShaderError> {
    let buffer = match target {
        Target::GlslEs300 => Buffer::Texture,
        // For arrays of any length, functions in MSL would take a table of lengths as one more argument.
        Target::Msl => Buffer::Sized,
        Target::Wgsl | Target::Glsl450 | Target::Hlsl | Target::SpirV => Buffer::Storage,
    };
    let wgsl = compose(set, form, buffer)?;
    Ok(if more.is_empty() { wgsl } else { format!("{wgsl}\n{more}") })
}
