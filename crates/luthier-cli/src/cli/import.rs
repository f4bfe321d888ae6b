//! Options of `import`.

use std::path::PathBuf;

use clap::Args;

const EXAMPLES: &str = "\
Files are glTF 2.0, text or binary, MaterialX of version 1.38 or later, or the JSON of the database physicallybased.info; their content tells which. Every material becomes a file of its own, NAME.toml, with the pictures that it needs in FOLDER/maps, and FOLDER/import.json says of each property what became of it: \
kept; closed form, where a formula leads from one to the other; approximated, with what differs; dropped; or the host's, which are no reflectances, such as opacity and emission. Pictures are copied as they are, or \
computed where luthier's maps mean something else, such as slope parameters in place of roughness.

Coats leave the base as bright as its colour, as their formats do (`darkening = false`); those of OpenPBR darken it. Nothing is read from a network, nor outside of the folder of a file, or of --root. Files that are there already are refused without --force. \
Several files share one folder: their materials have one set of names.

Examples:
  luthier import car.glb -o materials/car
  luthier import chess/*.gltf -o materials/chess --json
  luthier import brass.mtlx --root . -o materials/brass
  luthier import materials.json -o materials/measured
  luthier import car.glb -o materials/car --force && luthier check materials/car";

#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct ImportOptions {
    /// glTF (.gltf, .glb), MaterialX (.mtlx), or JSON of physicallybased.info
    #[arg(value_name = "FILE", required = true)]
    pub(crate) files: Vec<PathBuf>,
    /// Folder for the material files
    #[arg(short, long, value_name = "FOLDER")]
    pub(crate) output: PathBuf,
    /// Folder whose files may be read; by default that of each file
    #[arg(long, value_name = "FOLDER")]
    pub(crate) root: Option<PathBuf>,
    /// Replace files that are there already
    #[arg(long)]
    pub(crate) force: bool,
    /// Write what became of each property as a page for browsers
    #[arg(long, value_name = "FILE")]
    pub(crate) html: Option<PathBuf>,
    /// Print what became of each property as JSON
    #[arg(long)]
    pub(crate) json: bool,
}
