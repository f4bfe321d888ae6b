//! WGSL through naga: parsed, and validated for core WebGPU.

use naga::Module;
use naga::valid::{Capabilities, ModuleInfo, ValidationFlags, Validator};

use crate::ShaderError;

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
    let mut validator = Validator::new(ValidationFlags::all(), Capabilities::empty());
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
