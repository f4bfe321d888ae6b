//! Options of `fit`.

use std::path::PathBuf;
use std::str::FromStr;

use clap::Args;

const EXAMPLES: &str = "\
The lobe is a CSV file as `luthier eval` prints one: a line of names, theta_i,phi_i,theta_o,phi_o,r,g,b, then angles in degrees and f cos theta_i in each. \
Other columns do not count. Values are those of 645, 525 and 445 nm, as --three-wavelengths gives them.

The numbers are the index in three channels, both exponents, the weight of the specular part and the diffuse coefficients; with --film the thickness of \
a film that interferes, with --lean a lean of the inner boundary. Differences count over the mean of a value's channels plus a tenth of the mean of all values. \
The file says how near the lobe is: the root of the mean square of these, and the sum of the absolute differences over the sum of the values. The numbers need \
not be those of the object: thicknesses repeat themselves, and an index and a weight may stand for each other.

Examples:
  luthier fit lobe.csv -o fitted.toml
  luthier fit lobe.csv --film 50,800 --lean -o fitted.toml
  luthier fit - --json";

/// Thinnest and thickest film, nm.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Thicknesses(pub(crate) [f64; 2]);

impl FromStr for Thicknesses {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        match text.split_once(',').map(|(min, max)| [min, max].map(|nm| nm.trim().parse::<f64>())) {
            Some([Ok(min), Ok(max)]) if 1.0 <= min && min < max && max <= 1e4 => Ok(Self([min, max])),
            _ => Err("expected MIN,MAX in nm, 1 to 10000 and ascending, such as 50,800".to_owned()),
        }
    }
}

#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct FitOptions {
    /// The lobe, a CSV file; `-` is standard input
    #[arg(value_name = "LOBE")]
    pub(crate) lobe: PathBuf,
    /// A film that interferes, of a thickness between two, in nm; by default a layer too thick for it
    #[arg(long, value_name = "MIN,MAX")]
    pub(crate) film: Option<Thicknesses>,
    /// The inner boundary may lean
    #[arg(long)]
    pub(crate) lean: bool,
    /// File to write to; by default standard output
    #[arg(short, long, value_name = "FILE")]
    pub(crate) output: Option<PathBuf>,
    /// Print the numbers as JSON in place of a material file
    #[arg(long, conflicts_with = "output")]
    pub(crate) json: bool,
}
