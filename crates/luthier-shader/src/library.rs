//! Translation of any WGSL module of functions.

use std::fmt::Write as _;

use luthier_manifest::BindingEntry;
use naga::{Function, Handle, ImageClass, ImageDimension, Module, Scalar, Type, TypeInner};

use crate::languages::{glsl, hlsl, msl};
use crate::validate::module;
use crate::{ShaderError, Target};

/// A WGSL module of functions, textures and samplers in a language, to be pasted: validated, with its names and `///` comments.
///
/// All bindings are in one group. Their numbers become `binding` in GLSL 4.50, and registers in the space of the group in HLSL; GLSL ES has names
/// alone. GLSL joins textures and samplers: the program sets filters when it binds the texture. In MSL textures and samplers are arguments of the
/// functions. Names of textures must not be reserved words of GLSL. Functions must not loop or write, and their parameters are numbers and
/// vectors: the code that tidies naga's text relies on this.
///
/// ```
/// use luthier_shader::{Target, library};
///
/// let wgsl = "/// Twice x.\nfn twice(x: f32) -> f32 {\n    return 2.0 * x;\n}\n";
/// let glsl = library(wgsl, Target::GlslEs300)?;
/// assert!(glsl.contains("// Twice x.\nfloat twice(float x) {"), "{glsl}");
/// # Ok::<(), luthier_shader::ShaderError>(())
/// ```
///
/// # Errors
/// [`ShaderError::Invalid`] for invalid WGSL, [`ShaderError::Untranslatable`] for modules with other contents, [`ShaderError::NotText`] for
/// SPIR-V, which [`library_spirv`](crate::library_spirv) writes.
pub fn library(wgsl: &str, target: Target) -> Result<String, ShaderError> {
    let (module, _) = module(wgsl)?;
    let (bindings, group) = bindings(&module).map_err(|reason| ShaderError::untranslatable(target, reason))?;
    match target {
        Target::Wgsl => Ok(wgsl.to_owned()),
        Target::Glsl450 | Target::GlslEs300 => {
            let calls = calls(&module).map_err(|reason| ShaderError::untranslatable(target, reason))?;
            glsl::from_wgsl(wgsl, &bindings, group, &calls, target)
        }
        Target::Hlsl => hlsl::from_wgsl(wgsl, &bindings, group),
        Target::Msl => msl::from_wgsl(wgsl, &bindings, group),
        Target::SpirV => Err(ShaderError::NotText),
    }
}

/// The resources of a module, and their group.
fn bindings(module: &Module) -> Result<(Vec<BindingEntry>, u32), &'static str> {
    let mut entries = Vec::new();
    let mut group = None;
    for (_, variable) in module.global_variables.iter() {
        let at = variable.binding.ok_or("a variable that is no binding")?;
        if *group.get_or_insert(at.group) != at.group {
            return Err("bindings in several groups");
        }
        let resource = match module.types[variable.ty].inner {
            TypeInner::Image { dim: ImageDimension::D2, arrayed: false, class: ImageClass::Sampled { .. } } => {
                "texture_2d<f32>"
            }
            TypeInner::Sampler { comparison: false } => "sampler",
            _ => return Err("a binding that is neither a texture nor a sampler"),
        };
        let name = variable.name.clone().unwrap_or_default();
        entries.push(BindingEntry { binding: at.binding, name, resource: resource.to_owned() });
    }
    Ok((entries, group.unwrap_or(0)))
}

/// Calls of all functions of a module, each with zeros.
fn calls(module: &Module) -> Result<String, &'static str> {
    let mut out = String::new();
    for (_, Function { name, arguments, result, .. }) in module.functions.iter() {
        let zeros: Option<Vec<String>> = arguments.iter().map(|argument| zero(module, argument.ty)).collect();
        let zeros = zeros.ok_or("a parameter that is neither a number nor a vector")?.join(", ");
        let name = name.as_deref().unwrap_or_default();
        let discard = if result.is_some() { "_ = " } else { "" };
        let _ = writeln!(out, "    {discard}{name}({zeros});");
    }
    Ok(out)
}

/// The zero of a scalar or a vector.
fn zero(module: &Module, ty: Handle<Type>) -> Option<String> {
    match module.types[ty].inner {
        TypeInner::Scalar(scalar) => Some(format!("{}()", name(scalar)?)),
        TypeInner::Vector { size, scalar } => Some(format!("vec{}<{}>()", size as u8, name(scalar)?)),
        _ => None,
    }
}

/// The type of a scalar.
fn name(scalar: Scalar) -> Option<&'static str> {
    match scalar {
        Scalar::F32 => Some("f32"),
        Scalar::U32 => Some("u32"),
        Scalar::I32 => Some("i32"),
        Scalar::BOOL => Some("bool"),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEXTURE: &str = "@group(1) @binding(2) var image: texture_2d<f32>;\n@group(1) @binding(3) var linear: sampler;\n\n\
        /// The texel that is read.\nfn look(at: vec2<f32>, lod: f32) -> vec4<f32> {\n    let texel = textureSampleLevel(image, linear, at, lod);\n    \
        return texel;\n}\n";

    #[test]
    fn names_numbers_and_comments_stay() {
        for (target, expected) in [
            (Target::Wgsl, &["@group(1) @binding(2) var image", "fn look("][..]),
            (Target::Glsl450, &["layout(binding = 2) uniform sampler2D image;", "vec4 look(vec2 at, float lod) {"]),
            (Target::GlslEs300, &["uniform highp sampler2D image;", "vec4 look(vec2 at, float lod) {"]),
            (Target::Hlsl, &["register(t2, space1)", "register(s3, space1)", "float4 look(float2 at, float lod) {"]),
            (Target::Msl, &["metal::float4 look(", "metal::texture2d<float> image"]),
        ] {
            let text = library(TEXTURE, target).unwrap();
            for part in expected.iter().chain(&["// The texel that is read."]) {
                assert!(text.contains(part), "{target}: no `{part}` in\n{text}");
            }
            assert!(!text.to_lowercase().contains("naga") && !text.contains("luthier_entry"), "{target}:\n{text}");
        }
    }

    #[test]
    fn other_modules_are_refused() {
        let buffer = "@group(0) @binding(0) var<storage> a: array<f32>;\n";
        let apart = TEXTURE.replace("@group(1) @binding(3)", "@group(2) @binding(3)");
        let pointer = "fn f(a: ptr<function, f32>) -> f32 {\n    return *a;\n}\n";
        for (wgsl, reason) in [(buffer, "neither a texture"), (&apart, "several groups"), (pointer, "neither a number")]
        {
            let error = library(wgsl, Target::GlslEs300).unwrap_err();
            assert!(error.to_string().contains(reason), "{error}");
        }
        assert!(matches!(library("fn", Target::Hlsl), Err(ShaderError::Invalid(_))));
        assert!(matches!(library(TEXTURE, Target::SpirV), Err(ShaderError::NotText)));
    }
}
