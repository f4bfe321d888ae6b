//! Options of `new`.

use std::path::PathBuf;

use clap::Args;
use clap::builder::PossibleValuesParser;
use luthier_material::Template;

const EXAMPLES: &str = "\
Without a NAME, all classes and presets are listed with a line each. A class says which layers the surface has, with numbers that were chosen by eye: \
docs/classes.md leads from a sample in your hand to its class. A preset is a real substance, with the sources of its optical constants. Every file says \
in comments which number does what. No file is replaced.

Examples:
  luthier new
  luthier new mug
  luthier new my-gold --preset gold
  luthier new roof --class patina -o materials/roof.toml
  luthier new mug -o - | less";

#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct NewOptions {
    /// Name of the material: letters, digits and hyphens. Without it, all classes and presets are listed
    #[arg(value_name = "NAME")]
    pub(crate) name: Option<String>,
    /// Class of its surface
    #[arg(long, value_name = "CLASS", default_value = Template::CLASSES[0].name, value_parser = names(Template::CLASSES), requires = "name")]
    pub(crate) class: String,
    /// Real substance in place of a class
    #[arg(long, value_name = "PRESET", value_parser = names(Template::PRESETS), conflicts_with = "class", requires = "name")]
    pub(crate) preset: Option<String>,
    /// File to write, `-` is standard output; by default NAME.toml
    #[arg(long, short, value_name = "FILE", requires = "name")]
    pub(crate) output: Option<PathBuf>,
}

fn names(templates: &'static [Template]) -> PossibleValuesParser {
    templates.iter().map(|template| template.name).collect::<Vec<_>>().into()
}
