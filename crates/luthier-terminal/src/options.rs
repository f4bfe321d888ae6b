//! Options that many verbs have.

use std::path::PathBuf;
use std::str::FromStr;

use clap::Args;
use clap::builder::{PossibleValuesParser, TypedValueParser};
use luthier_lut::UnknownName;

/// Files to work on.
#[derive(Debug, Clone, Args)]
pub struct Sources {
    /// Material files, or folders of them (their *.toml, not deeper)
    #[arg(value_name = "PATH", default_value = "materials")]
    pub paths: Vec<PathBuf>,
}

/// A value by its name, one of those listed.
pub fn named<T>(names: &'static [&'static str]) -> impl TypedValueParser<Value = T>
where
    T: FromStr<Err = UnknownName> + Clone + Send + Sync + 'static,
{
    PossibleValuesParser::new(names).try_map(|name| name.parse::<T>())
}
