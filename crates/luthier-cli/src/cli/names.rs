//! Names of a package in the program that it is linked into.

use clap::Args;
use luthier_manifest::Names;

/// Names in shaders, and places of their resources.
#[derive(Debug, Clone, Args)]
#[command(next_help_heading = "Names in a program with other packages")]
pub(crate) struct NamesOptions {
    /// First word of all names in shaders, in place of `luthier`: packages with different ones link into one program
    #[arg(long, value_name = "WORD", default_value = "luthier", value_parser = prefix, hide_default_value = true)]
    prefix: String,
    /// Bind group of all resources (GLSL 4.50: set, HLSL: space)
    #[arg(long, value_name = "N", default_value_t = 0, value_parser = group)]
    group: u32,
    /// Number of the first of luthier's sixteen bindings in the group
    #[arg(long, value_name = "N", default_value_t = 0, value_parser = first_binding)]
    first_binding: u32,
}

impl NamesOptions {
    /// The names that are asked for.
    pub(crate) fn names(&self) -> Names {
        let Self { prefix, group, first_binding } = self.clone();
        Names { prefix, group, first_binding }
    }
}

fn prefix(word: &str) -> Result<String, String> {
    let names = Names { prefix: word.to_owned(), ..Names::default() };
    names.check().map(|()| names.prefix)
}

fn group(number: &str) -> Result<u32, String> {
    let group = whole(number)?;
    Names { group, ..Names::default() }.check().map(|()| group)
}

fn first_binding(number: &str) -> Result<u32, String> {
    let first_binding = whole(number)?;
    Names { first_binding, ..Names::default() }.check().map(|()| first_binding)
}

fn whole(number: &str) -> Result<u32, String> {
    number.parse().map_err(|_| "expected a whole number from 0 on".to_owned())
}
