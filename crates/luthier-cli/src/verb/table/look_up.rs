//! Look-up functions of tables, in the languages of shaders.

use std::path::{Path, PathBuf};

use luthier_shader::{Target, library, library_spirv};
use luthier_table::Bindings;
use luthier_terminal::{Failure, Outcome};

/// The bindings of `--bind`: group, texture, sampler.
pub(super) fn bindings([group, texture, sampler]: [u32; 3]) -> Bindings {
    Bindings { group, texture, sampler }
}

/// The function in each language, in files beside the output.
pub(super) fn beside(output: &Path, languages: &[Target], wgsl: &str) -> Outcome<Vec<(PathBuf, Vec<u8>)>> {
    let name = output.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
    // A language's ending may have a point of its own.
    let ending =
        Target::ALL.iter().map(|target| format!(".{}", target.extension())).find(|ending| name.ends_with(ending));
    let stem =
        ending.map_or(output.with_extension(""), |ending| output.with_file_name(&name[..name.len() - ending.len()]));
    let stem = stem.to_string_lossy();
    languages.iter().map(|to| Ok((PathBuf::from(format!("{stem}.{}", to.extension())), text(wgsl, *to)?))).collect()
}

/// The function in a language.
pub(super) fn text(wgsl: &str, target: Target) -> Outcome<Vec<u8>> {
    match target {
        Target::SpirV => library_spirv(wgsl),
        _ => library(wgsl, target).map(String::into_bytes),
    }
    .map_err(Failure::input)
}
