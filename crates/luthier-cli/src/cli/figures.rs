//! Options of `figures`.

use std::path::PathBuf;

use clap::Args;

const EXAMPLES: &str = "\
Writes the pictures and figures.json into a folder, and a page that explains them beside it: out/figures.md for out/figures.
Pictures of shaders depend on the adapter in their last bits; those in f64 (simulation, curves) are the same everywhere.

Examples:
  luthier figures
  luthier figures --list
  luthier figures elek-5 course-classes -o seen --size 256";

#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct FiguresOptions {
    /// Figures to make; by default all
    #[arg(value_name = "NAME")]
    pub(crate) names: Vec<String>,
    /// Folder to write to
    #[arg(long, short, value_name = "DIR", default_value = "out/figures")]
    pub(crate) output: PathBuf,
    /// Side of each single picture in pixels
    #[arg(long, value_name = "PIXELS", default_value_t = 128, value_parser = clap::value_parser!(u32).range(16..=1024))]
    pub(crate) size: u32,
    /// Samples along each side of a pixel, of shaders
    #[arg(long, value_name = "N", default_value_t = 2, value_parser = clap::value_parser!(u32).range(1..=16))]
    pub(crate) samples: u32,
    /// Paths of the simulation per pixel, light and channel
    #[arg(long, value_name = "N", default_value_t = 128, value_parser = clap::value_parser!(u64).range(2..=1_000_000))]
    pub(crate) paths: u64,
    /// Use the graphics adapter whose name contains this
    #[arg(long, value_name = "NAME")]
    pub(crate) adapter: Option<String>,
    /// Print names and titles instead
    #[arg(long)]
    pub(crate) list: bool,
}
