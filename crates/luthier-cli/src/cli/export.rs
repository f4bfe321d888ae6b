//! Options of `export`.

use std::path::PathBuf;

use clap::Args;
use luthier_formats::Format;
use luthier_terminal::named;

use crate::numbers::positive;

const EXAMPLES: &str = "\
The numbers that the layers decide are taken in closed form; a colour or a roughness that has none is fitted to the simulated light of the layers, from 0, 30, 60 and 80 degrees and in all channels. For each material the numbers are printed, with \
the largest difference of its albedo and the largest lobe error that remain, and what became of each property of its layers: kept; closed form; approximated, with what differs; or dropped. Maps become textures, which multiply the numbers.

Of gltf the formula is that of the specification with height-correlated masking; of openpbr and standard-surface that of the graphs of MaterialX 1.39. Without --output nothing is written. With it FOLDER has one file of all materials, materials.gltf or materials.mtlx, its \
pictures in textures, and export.json, which says all that is printed. All files are written, or none; files that are there already are refused without --force. `luthier import` reads what is written.

Examples:
  luthier export --to gltf materials/red-lacquer.toml
  luthier export --to openpbr materials -o build/openpbr
  luthier export --to standard-surface materials/car-paint.toml -o build/car --json
  luthier export --to gltf materials -o build/gltf --force";

#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct ExportOptions {
    /// Material files, or folders of them (their *.toml, not deeper)
    #[arg(value_name = "FILE", required = true)]
    pub(crate) files: Vec<PathBuf>,
    /// The format
    #[arg(long, value_name = "FORMAT", value_parser = named::<Format>(Format::NAMES))]
    pub(crate) to: Format,
    /// Folder for the file of the format and its textures
    #[arg(short, long, value_name = "FOLDER")]
    pub(crate) output: Option<PathBuf>,
    /// Lobe error that noise of the simulation may cause
    #[arg(long, value_name = "X", value_parser = positive, default_value = "0.01", allow_hyphen_values = true)]
    pub(crate) noise: f64,
    /// Replace files that are there already
    #[arg(long, requires = "output")]
    pub(crate) force: bool,
    /// Print numbers, errors and properties as JSON
    #[arg(long)]
    pub(crate) json: bool,
}
