//! SPIR-V of a composed module, with the names of functions, structures and bindings.

use std::collections::BTreeSet;

use naga::back::spv::{Options, WriterFlags, write_vec};

use crate::validate::module;
use crate::{ShaderError, Target};

/// Numbers of the SPIR-V specification, version 1.3, section 3.
const OP_NAME: u32 = 5;
const OP_FUNCTION: u32 = 54;
const OP_DECORATE: u32 = 71;
/// Types, constants, variables and functions, which follow all decorations.
const DECLARATIONS: std::ops::Range<u32> = 19..OP_DECORATE;
const DECORATION_LINKAGE_ATTRIBUTES: u32 = 41;
const LINKAGE_TYPE_EXPORT: u32 = 0;
/// Words before the first instruction.
const HEADER_WORDS: usize = 5;

/// A library in SPIR-V of any WGSL module, in the form of [`emit_spirv`](crate::emit_spirv).
///
/// # Errors
/// When naga refuses the module.
pub fn library_spirv(wgsl: &str) -> Result<Vec<u8>, ShaderError> {
    Ok(bytes(&with_exports(&spirv_words(wgsl)?)))
}

/// A shader in SPIR-V of a WGSL module with entry points.
pub(crate) fn shader(wgsl: &str) -> Result<Vec<u8>, ShaderError> {
    Ok(bytes(&spirv_words(wgsl)?))
}

/// SPIR-V 1.3 of any WGSL module, in words, for kernels around a snippet.
///
/// # Errors
/// When naga refuses the module.
pub fn spirv_words(wgsl: &str) -> Result<Vec<u32>, ShaderError> {
    let (module, info) = module(wgsl)?;
    let options = Options {
        lang_version: (1, 3),
        // naga's default flags depend on the build profile. With these, the bytes depend on the inputs only.
        flags: WriterFlags::DEBUG | WriterFlags::LABEL_VARYINGS,
        // Descriptor set and binding are those of the WGSL.
        fake_missing_bindings: true,
        ..Options::default()
    };
    write_vec(&module, &info, &options, None).map_err(|e| ShaderError::untranslatable(Target::SpirV, e))
}

/// The module with `OpDecorate FUNCTION LinkageAttributes "NAME" Export` for every function.
fn with_exports(words: &[u32]) -> Vec<u32> {
    let functions: BTreeSet<u32> = instructions(words).filter(|i| i[0] & 0xffff == OP_FUNCTION).map(|i| i[2]).collect();
    let mut exports = Vec::new();
    let mut before_types = HEADER_WORDS;
    for instruction in instructions(words) {
        let code = instruction[0] & 0xffff;
        if DECLARATIONS.contains(&code) {
            break;
        }
        before_types += instruction.len();
        if code == OP_NAME && functions.contains(&instruction[1]) {
            let name = &instruction[2..];
            exports.push(((name.len() as u32 + 4) << 16) | OP_DECORATE);
            exports.extend([instruction[1], DECORATION_LINKAGE_ATTRIBUTES]);
            exports.extend(name);
            exports.push(LINKAGE_TYPE_EXPORT);
        }
    }
    [&words[..before_types], &exports, &words[before_types..]].concat()
}

/// The instructions of a module: the high half of the first word of each is its length.
fn instructions(words: &[u32]) -> impl Iterator<Item = &[u32]> {
    let mut rest = &words[HEADER_WORDS..];
    std::iter::from_fn(move || {
        let length = (*rest.first()? >> 16) as usize;
        let (instruction, tail) = rest.split_at_checked(length.max(1))?;
        rest = tail;
        Some(instruction)
    })
}

fn bytes(words: &[u32]) -> Vec<u8> {
    words.iter().flat_map(|word| word.to_le_bytes()).collect()
}
