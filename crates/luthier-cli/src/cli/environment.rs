//! Options of `environment`.

use std::path::PathBuf;

use clap::{ArgGroup, Args, ValueEnum};
use luthier_environment::{Layout, Scenery};
use luthier_terminal::named;

const EXAMPLES: &str = "\
Writes environment.json and, for each layout, two KTX2 files of half floats: environment-LAYOUT.ktx2, whose levels are blurred by lobes
exp((cos - 1) / width^2), and irradiance-LAYOUT.ktx2, irradiance over pi. environment.json lists the width of each level, the alpha and
roughness of the mirror that blurs as much at normal incidence, the orientation, and the hashes of all files.

The picture is equirectangular, twice as wide as high, linear RGB; it is averaged down to 512 rows if it has more. Radiance that is NaN or
infinite is refused. Negative values, which resampling leaves in many pictures, count as 0. In the files values end at 65504, the largest
half float; blurs know the whole. A line says how many texels that concerns.

Examples:
  luthier environment studio.hdr --out studio
  luthier environment studio.exr --out studio --layout cube --no-zstd
  luthier environment --sky night-street --out night --json";

#[derive(Debug, Args)]
#[command(after_help = EXAMPLES, group(ArgGroup::new("source").required(true).args(["picture", "sky"])))]
pub(crate) struct EnvironmentOptions {
    /// The picture: Radiance HDR or OpenEXR
    #[arg(value_name = "FILE")]
    pub(crate) picture: Option<PathBuf>,
    /// Surroundings by formulas instead
    #[arg(long, value_name = "NAME", value_parser = named::<Scenery>(Scenery::NAMES))]
    pub(crate) sky: Option<Scenery>,
    /// Folder to write to
    #[arg(long, value_name = "DIR")]
    pub(crate) out: PathBuf,
    /// Layouts to write; by default both
    #[arg(long, value_name = "NAME,...", value_enum, value_delimiter = ',')]
    pub(crate) layout: Vec<LayoutName>,
    /// Texels along a side of a face, or rows, of the first level: a power of two from 32 to 1024; by default twice the rows of the picture, from 32 to 512
    #[arg(long, value_name = "N")]
    pub(crate) size: Option<u32>,
    /// Leave the texels uncompressed, for programs that decode no zstd
    #[arg(long)]
    pub(crate) no_zstd: bool,
    /// Print environment.json to standard output as well
    #[arg(long)]
    pub(crate) json: bool,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, ValueEnum)]
pub(crate) enum LayoutName {
    /// Six faces: +x, -x, +y, -y, +z, -z
    Cube,
    /// One map, twice as wide as high
    Equirect,
}

impl LayoutName {
    pub(crate) const ALL: [Self; 2] = [Self::Cube, Self::Equirect];

    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Cube => "cube",
            Self::Equirect => "equirect",
        }
    }
}

impl From<LayoutName> for Layout {
    fn from(name: LayoutName) -> Self {
        match name {
            LayoutName::Cube => Self::Cube,
            LayoutName::Equirect => Self::Equirect,
        }
    }
}
