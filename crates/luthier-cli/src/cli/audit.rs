//! Options of `audit`.

use std::path::PathBuf;

use clap::builder::{PossibleValuesParser, TypedValueParser};
use clap::{Args, ValueEnum};
use luthier_table::Preset;

const AUDIT_EXAMPLES: &str = "\
Judges a table of another program: DDS, KTX2, EXR, PNG, Radiance HDR, or raw values with --size. The verdict says whether it is as \
stated, or which mistakes explain it better: flips, swapped axes or channels, half a texel, alpha for roughness, another masking \
term, an encoding. docs/audit.md has the models, axes and presets.

Exits with 1 when the table is not as stated or its largest error as sampled exceeds --max-error.

Examples:
  luthier audit dfg.ktx2 --model ggx-correlated --axes \"cos_theta,roughness\"
  luthier audit dfg.dds --preset filament --json
  luthier audit lut.png --model ggx-schlick-half --axes \"cos_theta,-roughness\" --channel r,g
  luthier audit dfg.bin --size 64x64 --channels 2 --samples half --model ggx-separable
  luthier audit out/tables/fresnel.ktx2 --model fresnel --ior au --axes cos_theta^2 --nodes ends";

/// Largest error that is forgiven: tables of 64 x 64 over the cosine reach it at grazing angles.
pub(crate) const MAX_ERROR: f64 = 0.05;

#[derive(Debug, Args)]
#[command(after_help = AUDIT_EXAMPLES)]
pub(crate) struct AuditOptions {
    /// The table
    #[arg(value_name = "FILE")]
    pub(crate) file: PathBuf,
    /// Function that the table should hold: ggx- or beckmann- with a masking term, ndf or all-bounces; or fresnel
    #[arg(long, value_name = "NAME")]
    pub(crate) model: Option<String>,
    /// Axes of the table, the one across first: [-]QUANTITY[=MIN..MAX][^EXPONENT|@log]; - is a falling axis
    #[arg(long, value_name = "X[,Y]", allow_hyphen_values = true)]
    pub(crate) axes: Option<String>,
    /// Position of the nodes: at texel centres of 0..1, or from 0 at the first texel to 1 at the last
    #[arg(long, value_enum)]
    pub(crate) nodes: Option<NodesName>,
    /// Content of each channel: scale, bias, albedo; red, green, blue; scaled-d, d
    #[arg(long, value_name = "TERM,..", value_delimiter = ',')]
    pub(crate) values: Option<Vec<String>>,
    /// Channels to read, in the order of --values
    #[arg(long, value_name = "r,g,b,a", value_enum, value_delimiter = ',')]
    pub(crate) channel: Option<Vec<ChannelName>>,
    /// Model, axes, nodes and values of an engine; other options override it
    #[arg(long, value_name = "NAME", value_parser = preset())]
    pub(crate) preset: Option<&'static Preset>,
    /// Index of the medium below: a data set of `luthier ior`, N, or N,K
    #[arg(long, value_name = "NAME|N[,K]")]
    pub(crate) ior: Option<String>,
    /// The part of the image that is the table, in texels: a tile of an atlas
    #[arg(long, value_name = "X,Y,W,H", value_delimiter = ',', num_args = 1)]
    pub(crate) crop: Option<Vec<u32>>,
    /// Size of a file of raw values, which has no header
    #[arg(long, value_name = "WxH")]
    pub(crate) size: Option<String>,
    /// Channels of raw values
    #[arg(long, value_name = "N", requires = "size", default_value_t = 2, value_parser = clap::value_parser!(u32).range(1..=4))]
    pub(crate) channels: u32,
    /// Type of raw values, little-endian
    #[arg(long, value_enum, requires = "size", default_value_t = SamplesName::Float)]
    pub(crate) samples: SamplesName,
    /// Ignore errors at lower cosines
    #[arg(long, value_name = "X", default_value_t = 0.01, value_parser = unit)]
    pub(crate) min_cos: f64,
    /// Ignore errors at lower alphas
    #[arg(long, value_name = "X", default_value_t = 0.0025, value_parser = unit)]
    pub(crate) min_alpha: f64,
    /// Exit with 1 when the largest absolute error of filtered reads exceeds this
    #[arg(long, value_name = "X", default_value_t = MAX_ERROR, value_parser = super::positive, allow_hyphen_values = true)]
    pub(crate) max_error: f64,
    /// Print as JSON
    #[arg(long)]
    pub(crate) json: bool,
}

#[derive(Debug, Clone, Copy, ValueEnum)]
pub(crate) enum NodesName {
    Centres,
    Ends,
}

#[derive(Debug, Clone, Copy, ValueEnum)]
pub(crate) enum ChannelName {
    R,
    G,
    B,
    A,
}

#[derive(Debug, Clone, Copy, ValueEnum)]
pub(crate) enum SamplesName {
    Unorm8,
    Unorm16,
    Half,
    Float,
}

pub(super) fn unit(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(value) if (0.0..1.0).contains(&value) => Ok(value),
        _ => Err("expected a number from 0 up to 1, such as 0.01".to_owned()),
    }
}

/// A preset by its name, one of those listed.
pub(super) fn preset() -> impl TypedValueParser<Value = &'static Preset> {
    let names = Preset::ALL.iter().map(|preset| preset.name);
    PossibleValuesParser::new(names).map(|name| Preset::named(&name).expect("only names of presets come here"))
}
