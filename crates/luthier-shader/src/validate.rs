//! WGSL through naga: parsed, and validated for core WebGPU.

use luthier_manifest::Check;
use naga::Module;
use naga::valid::{Capabilities, ModuleInfo, ValidationFlags, Validator};

use crate::{ShaderError, Target};

/// naga and its version, as the lock file of this repository has it.
const NAGA: &str = "naga 30.0.1";

/// Capabilities of core WebGPU that naga counts apart: half floats in words of 32 bits. Shaders use none beyond.
const CORE: Capabilities = Capabilities::SHADER_FLOAT16_IN_FLOAT32;

/// The judges that each shader in a language has passed once it is emitted. naga reads WGSL alone here: of a shader in another language it has validated
/// the module from which the shader was translated. The lint reads the texts of HLSL and MSL themselves. No judge has read GLSL and SPIR-V.
///
/// ```
/// use luthier_shader::{Target, checks};
///
/// let [naga, lint] = &checks(Target::Hlsl)[..] else { panic!("two judges") };
/// assert!(naga.by.starts_with("naga ") && naga.read == Target::Wgsl && lint.read == Target::Hlsl);
/// ```
pub fn checks(target: Target) -> Vec<Check> {
    let naga = Check { by: NAGA.to_owned(), read: Target::Wgsl, capabilities: Some(Vec::new()) };
    let lint = concat!("lint of luthier-shader ", env!("CARGO_PKG_VERSION"));
    let lint = Check { by: lint.to_owned(), read: target, capabilities: None };
    match target {
        Target::Hlsl | Target::Msl => vec![naga, lint],
        Target::Wgsl | Target::Glsl450 | Target::GlslEs300 | Target::SpirV => vec![naga],
    }
}

/// Parses WGSL and validates it for core WebGPU.
///
/// ```
/// use luthier_shader::validate;
///
/// assert!(validate("fn one() -> f32 {\n    return 1.0;\n}\n").is_ok());
/// let error = validate("fn one() -> f32 {\n    return 1u;\n}\n").unwrap_err();
/// assert!(error.to_string().contains("1u"));
/// ```
///
/// # Errors
/// [`ShaderError::Invalid`] with the place in the source.
pub fn validate(wgsl: &str) -> Result<(), ShaderError> {
    module(wgsl).map(|_| ())
}

/// The module of a WGSL text, validated for core WebGPU.
pub(crate) fn module(wgsl: &str) -> Result<(Module, ModuleInfo), ShaderError> {
    let module = naga::front::wgsl::parse_str(wgsl).map_err(|e| ShaderError::Invalid(e.emit_to_string(wgsl)))?;
    let mut validator = Validator::new(ValidationFlags::all(), CORE);
    let info = validator.validate(&module).map_err(|e| ShaderError::Invalid(e.emit_to_string(wgsl)))?;
    Ok((module, info))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn errors_show_the_source() {
        for (line, found) in
            [("    return 1.0", "wgsl:3:1"), ("    return nothing;", "return nothing;"), ("    return 1u;", "1u")]
        {
            let message = validate(&format!("fn f() -> f32 {{\n{line}\n}}\n")).unwrap_err().to_string();
            assert!(message.contains(found), "{message}");
        }
        validate("fn f() -> f32 {\n    return 1.0;\n}\n").unwrap();
    }
}
