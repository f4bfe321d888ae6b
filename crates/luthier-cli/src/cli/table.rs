//! Options of `table`.

use std::path::PathBuf;

use clap::{ArgGroup, Args, Subcommand, ValueEnum};
use luthier_table::Preset;

use super::audit::{preset, unit};

const EXAMPLES: &str = "\
Every function comes by quadrature. The output says the layout and the error as sampled: bilinear, 8-bit weights. docs/engines.md has the \
presets, and how each engine takes its table.

Examples:
  luthier table dfg --preset bevy -o dfg.ktx2
  luthier table dfg --max-abs 1e-3 -o dfg.ktx2 --shader wgsl --report dfg.html";

const DFG_EXAMPLES: &str = "\
Bakes the split sum of image-based lighting (DFG, environment BRDF): reflectance is f0 * scale + bias. With --preset in the layout of an \
engine; with --max-abs the smallest table of half floats whose filtered reads hold this error, as KTX2. Errors are over cosines from \
--min-cos and alphas from --min-alpha.

Exits with 1 when no table holds --max-abs, and writes nothing then.

Examples:
  luthier table dfg --preset bevy -o dfg.ktx2
  luthier table dfg --preset three -o DFGLUTData.js --json
  luthier table dfg --preset three -o DFGLUTData.js --report dfg.html --beside theirs.exr
  luthier table dfg --max-abs 1e-3 -o dfg.ktx2
  luthier table dfg --max-abs 5e-4 --distribution beckmann --masking separable -o dfg.ktx2";

#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct TableOptions {
    /// The function
    #[command(subcommand)]
    pub(crate) function: Function,
}

/// Functions of tables.
#[derive(Debug, Subcommand)]
pub(crate) enum Function {
    /// Split sum of image-based lighting under Schlick's Fresnel
    Dfg(DfgOptions),
}

#[derive(Debug, Args)]
#[command(after_help = DFG_EXAMPLES, group(ArgGroup::new("aim").required(true).args(["preset", "max_abs"])))]
pub(crate) struct DfgOptions {
    /// The engine whose layout the table has
    #[arg(long, value_name = "NAME", value_parser = preset)]
    pub(crate) preset: Option<&'static Preset>,
    /// Another size than the engine's own table has: three.js, Babylon.js, Bevy and the glTF Sample Viewer read any
    #[arg(long, value_name = "WxH", value_parser = size, requires = "preset")]
    pub(crate) size: Option<[u32; 2]>,
    /// Find the smallest table whose reads err by this at most, absolutely
    #[arg(long, value_name = "X", value_parser = super::positive, allow_hyphen_values = true)]
    pub(crate) max_abs: Option<f64>,
    /// Slope distribution
    #[arg(long, value_enum, default_value_t = DistributionName::Ggx, conflicts_with = "preset")]
    pub(crate) distribution: DistributionName,
    /// Masking term: correlated, separable, joint-approx, schlick-half, schlick-karis, schlick, v-cavity, kelemen or implicit
    #[arg(long, value_name = "NAME", default_value = "correlated", conflicts_with = "preset")]
    pub(crate) masking: String,
    /// Lowest cosine that counts in the error, and at which the axis of a searched table begins
    #[arg(long, value_name = "X", default_value_t = 0.01, value_parser = unit)]
    pub(crate) min_cos: f64,
    /// Lowest alpha likewise
    #[arg(long, value_name = "X", default_value_t = 0.01, value_parser = unit)]
    pub(crate) min_alpha: f64,
    /// A table of another maker in the layout of the preset, whose errors the report shows beside
    #[arg(long, value_name = "FILE", requires = "preset", requires = "report")]
    pub(crate) beside: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) delivery: Delivery,
}

/// Where a table goes, and in which company.
#[derive(Debug, Args)]
pub(crate) struct Delivery {
    /// File to write
    #[arg(long, short, value_name = "FILE")]
    pub(crate) output: PathBuf,
    /// Write a page that certifies the table: a map of its errors, the worst place, the statement
    #[arg(long, value_name = "FILE.html")]
    pub(crate) report: Option<PathBuf>,
    /// Leave the texels of KTX2 files uncompressed, for programs that decode no zstd
    #[arg(long)]
    pub(crate) no_zstd: bool,
    /// Print what was made as JSON
    #[arg(long)]
    pub(crate) json: bool,
}

#[derive(Debug, Clone, Copy, ValueEnum)]
pub(crate) enum DistributionName {
    Ggx,
    Beckmann,
}

/// Texels across and down.
fn size(text: &str) -> Result<[u32; 2], String> {
    let wrong = || "expected texels across and down, 4 to 1024 each, such as 64x64".to_owned();
    let (width, height) = text.split_once('x').ok_or_else(wrong)?;
    let side = |text: &str| text.parse::<u32>().ok().filter(|side| (4..=1024).contains(side)).ok_or_else(wrong);
    Ok([side(width)?, side(height)?])
}
