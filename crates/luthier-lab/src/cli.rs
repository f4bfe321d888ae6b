//! The command line: the one definition of verbs, options and their help.

use std::num::NonZeroU32;
use std::path::PathBuf;

use clap::{Args, Parser, Subcommand, ValueEnum};
use luthier_cost::Family;
use luthier_manifest::ShadingModel;
use luthier_terminal::{Sources, named};

const AFTER_HELP: &str = "\
Exit codes and failures in JSON are those of `luthier --help`. `scripts/pages.sh` makes all pages.

Examples:
  luthier-lab parity materials -o docs/pages/parity.md
  luthier-lab figures elek-5 -o seen";

/// Makes the project's own pages: figures of the papers, measurements, proofs.
#[derive(Debug, Parser)]
#[command(name = "luthier-lab", version, after_help = AFTER_HELP, max_term_width = 100)]
pub(crate) struct Cli {
    #[command(subcommand)]
    pub(crate) verb: Verb,
}

#[derive(Debug, Subcommand)]
pub(crate) enum Verb {
    /// Make the figures of the papers anew
    Figures(FiguresOptions),
    /// Describe every key of the grammar, with pictures of what it does: a page in Markdown
    Grammar(GrammarOptions),
    /// Compare every shader of every material with its f64 twin: a page in Markdown
    Parity(ParityOptions),
    /// Compare shaders at places of surfaces that vary with their f64 twins: a page in Markdown
    Places(PlacesOptions),
    /// Compare textured materials at random places: shaders, rows that ship, simulation: a page in Markdown
    Textured(TexturedOptions),
    /// Run every method on stacks where methods fail, and find the domain of each: a page in Markdown
    Stability(StabilityOptions),
    /// Compare every reflectance model with the layered-mc reference on materials: a page in Markdown
    Judge(JudgeOptions),
    /// Fit lobes to simulated stacks, shipped ones and random ones, and compare them with the papers' models: a page in Markdown
    Lobes(LobesOptions),
    /// Fit lobes to stacks whose roughness or thickness varies, and compare them between their nodes with the simulation: a page in Markdown
    Varying(VaryingOptions),
    /// Fit families of lobes over slope parameters and colours of a base, and compare them with the simulation at random places: a page in Markdown
    Families(FamiliesOptions),
    /// Compare the clear coats of engines with the simulation, and measure their energy and reciprocity: a page in Markdown
    Coats(CoatsOptions),
    /// Show textured coats five ways, simulated and by four models: a picture, and a page in Markdown
    FiveWays(FiveWaysOptions),
    /// Compare what glTF, OpenPBR and Standard Surface leave of materials, as a page
    Formats(FormatsOptions),
    /// Fit lobes to anisotropic stacks, and compare them between the azimuths of their rows with the simulation: a page in Markdown
    Anisotropic(AnisotropicOptions),
    /// Compare the environment that pictures show with sums over all directions: a page in Markdown
    Environment(EnvironmentOptions),
    /// Time the simulation on the device beside models, and compare their pictures with it: a page in Markdown
    Simulation(SimulationOptions),
    /// Measure the tables that searches find against fixed ones: a page in Markdown
    Budgets(BudgetsOptions),
    /// Count the cycles of the papers' shaders on today's chips, without the chips: a page in Markdown
    Papers(PapersOptions),
    /// Time the papers' shaders on the device: a page in Markdown
    Throughput(ThroughputOptions),
    /// Fit costs of operations to kept times and counts: a file for each device, and a page in Markdown
    Devices(DevicesOptions),
    /// Count both layouts of rows of lobes and the coats of engines on chips that are not there, and predict their times: a page in Markdown
    Layouts(LayoutsOptions),
    /// Take materials in `lobes` under several limits on errors, and predict what each costs: a page in Markdown
    Ladder(LadderOptions),
    /// Draw the chart of a page of `ladder` anew
    LadderChart(LadderChartOptions),
    /// Count what the materials of one shader pay for each other, and predict times: a page in Markdown
    Sets(SetsOptions),
    /// Count the cycles of a shader for every shape of stack: the table by which scenes choose models, as JSON
    Shapes(ShapesOptions),
    /// Try files that others wrote with the readers of their kinds: a page in Markdown
    Foreign(ForeignOptions),
    /// Hash what the textures, maps and material buffers below a folder hold, whatever their containers: lines as `sha256sum` has them
    Texels(TexelsOptions),
    /// Make the maps of the materials in `materials/textured`
    Textures(TexturesOptions),
}

/// Destination of a page.
#[derive(Debug, Args)]
pub(crate) struct Destination {
    /// File to write instead of standard output
    #[arg(long, short, value_name = "FILE")]
    pub(crate) output: Option<PathBuf>,
}

/// The graphics adapter to use.
#[derive(Debug, Args)]
pub(crate) struct Adapter {
    /// Use the graphics adapter whose name contains this
    #[arg(long = "adapter", value_name = "NAME")]
    pub(crate) name: Option<String>,
}

/// Form of a page.
#[derive(Debug, Args)]
pub(crate) struct Format {
    /// JSON instead of Markdown
    #[arg(long)]
    pub(crate) json: bool,
}

const FIGURES_EXAMPLES: &str = "\
Writes the pictures and figures.json into a folder, and a page that explains them beside it: out/figures.md for out/figures.
Figures that an earlier run left in the folder stay on the page.
Pictures of shaders depend on the adapter in their last bits; curves in f64 are the same everywhere.

Examples:
  luthier-lab figures
  luthier-lab figures --list
  luthier-lab figures elek-5 course-classes -o seen --size 256";

/// Paths of the simulation in figures, unless the command line has others.
pub(crate) const PATHS: u32 = 256;

#[derive(Debug, Args)]
#[command(after_help = FIGURES_EXAMPLES)]
pub(crate) struct FiguresOptions {
    /// Figures to make; by default all
    #[arg(value_name = "NAME")]
    pub(crate) names: Vec<String>,
    /// Folder to write to
    #[arg(long, short, value_name = "DIR", default_value = "out/figures")]
    pub(crate) output: PathBuf,
    /// Side of each single picture in pixels; by default that of each figure
    #[arg(long, value_name = "PIXELS", value_parser = clap::value_parser!(u32).range(16..=1024))]
    pub(crate) size: Option<u32>,
    /// Samples along each side of a pixel, of shaders
    #[arg(long, value_name = "N", default_value_t = 2, value_parser = clap::value_parser!(u32).range(1..=16))]
    pub(crate) samples: u32,
    /// Paths of the simulation per pixel and light
    #[arg(long, value_name = "N", default_value_t = PATHS, value_parser = clap::value_parser!(u32).range(2..=1_000_000))]
    pub(crate) paths: u32,
    #[command(flatten)]
    pub(crate) adapter: Adapter,
    /// Print names and titles instead
    #[arg(long)]
    pub(crate) list: bool,
}

#[derive(Debug, Args)]
#[command(
    after_help = "Examples:\n  luthier-lab grammar -o docs/grammar.md\n  luthier-lab grammar -o docs/grammar.md --pictures docs/images/grammar\n  \
                  luthier-lab grammar bake.color --pictures docs/images/grammar -o docs/grammar.md"
)]
pub(crate) struct GrammarOptions {
    /// Keys whose pictures to render, such as dielectric.alpha; by default all
    #[arg(value_name = "KEY", requires = "pictures")]
    pub(crate) keys: Vec<String>,
    #[command(flatten)]
    pub(crate) destination: Destination,
    /// Folder to render pictures into first
    #[arg(long, value_name = "DIR")]
    pub(crate) pictures: Option<PathBuf>,
    /// Side of each ball in pixels
    #[arg(long, value_name = "PIXELS", default_value_t = 96, value_parser = clap::value_parser!(u32).range(16..=1024))]
    pub(crate) size: u32,
    #[command(flatten)]
    pub(crate) adapter: Adapter,
}

/// Pairs of directions in each of the five sets: 100,000 in all.
pub(crate) const PARITY_PAIRS: u32 = 20_000;

#[derive(Debug, Args)]
#[command(
    after_help = "Exits with 1 when an error exceeds its tolerance and the reason is not listed.\n\nExamples:\n  \
                  luthier-lab parity materials -o docs/pages/parity.md\n  \
                  luthier-lab parity mine.toml --model elek --model phong --pairs 1000 --json"
)]
pub(crate) struct ParityOptions {
    #[command(flatten)]
    pub(crate) sources: Sources,
    /// Model to compare; may be given again. By default all that have a twin
    #[arg(long, value_name = "NAME", value_parser = named::<ShadingModel>(ShadingModel::NAMES))]
    pub(crate) model: Vec<ShadingModel>,
    /// Pairs of directions in each of the five sets of every material
    #[arg(long, value_name = "N", default_value_t = PARITY_PAIRS, value_parser = clap::value_parser!(u32).range(1..=1_000_000))]
    pub(crate) pairs: u32,
    #[command(flatten)]
    pub(crate) adapter: Adapter,
    #[command(flatten)]
    pub(crate) destination: Destination,
    #[command(flatten)]
    pub(crate) format: Format,
}

#[derive(Debug, Args)]
#[command(
    after_help = "Exits with 1 when an error exceeds what the page allows.\n\nExamples:\n  luthier-lab places -o docs/pages/places.md"
)]
pub(crate) struct PlacesOptions {
    /// Model to compare; may be given again. By default all
    #[arg(long, value_name = "NAME", value_parser = named::<ShadingModel>(ShadingModel::NAMES))]
    pub(crate) model: Vec<ShadingModel>,
    /// Pairs of directions at each place
    #[arg(long, value_name = "N", default_value_t = 2000, value_parser = clap::value_parser!(u32).range(2..=1_000_000))]
    pub(crate) pairs: u32,
    #[command(flatten)]
    pub(crate) adapter: Adapter,
    #[command(flatten)]
    pub(crate) destination: Destination,
}

#[derive(Debug, Args)]
#[command(
    after_help = "Exits with 1 when a shader is NaN or infinite somewhere, or when the error of a method has no explanation.\n\n\
                  Examples:\n  luthier-lab stability\n  luthier-lab stability -o docs/pages/stability.md\n  luthier-lab stability --json"
)]
pub(crate) struct StabilityOptions {
    #[command(flatten)]
    pub(crate) adapter: Adapter,
    #[command(flatten)]
    pub(crate) destination: Destination,
    #[command(flatten)]
    pub(crate) format: Format,
}

/// Standard errors of albedos are then at most 1e-3: 0.5 over the root.
pub(crate) const JUDGE_SAMPLES: NonZeroU32 = NonZeroU32::new(1 << 18).expect("not zero");

#[derive(Debug, Args)]
#[command(after_help = "Examples:\n  luthier-lab judge materials > docs/pages/models.md")]
pub(crate) struct JudgeOptions {
    #[command(flatten)]
    pub(crate) sources: Sources,
    /// Paths of the reference for each wavelength and direction; by default minutes of work
    #[arg(long, value_name = "N", default_value_t = JUDGE_SAMPLES)]
    pub(crate) samples: NonZeroU32,
    #[command(flatten)]
    pub(crate) format: Format,
}

/// The most paths of a view of the judge.
pub(crate) const LOBES_SAMPLES: NonZeroU32 = NonZeroU32::new(1 << 24).expect("not zero");

/// How exact the judge of fits is.
#[derive(Debug, Args)]
pub(crate) struct Precision {
    /// Lobe error that the random numbers of the judge may make
    #[arg(long, value_name = "SHARE", default_value_t = 0.005, value_parser = share)]
    pub(crate) noise: f64,
    /// The most paths of the judge for each direction, whatever the noise
    #[arg(long, value_name = "N", default_value_t = LOBES_SAMPLES)]
    pub(crate) samples: NonZeroU32,
}

#[derive(Debug, Args)]
#[command(after_help = "Examples:\n  luthier-lab lobes materials --random 200 -o docs/pages/lobes.md\n  \
                  luthier-lab lobes materials/gold-paint.toml --noise 0.01")]
pub(crate) struct LobesOptions {
    #[command(flatten)]
    pub(crate) sources: Sources,
    /// Random stacks besides
    #[arg(long, value_name = "N", default_value_t = 0)]
    pub(crate) random: u32,
    #[command(flatten)]
    pub(crate) precision: Precision,
    /// Paths of the fit for each row; by default those of a bake
    #[arg(long = "paths", value_name = "N", default_value = "32768")]
    pub(crate) paths_per_row: NonZeroU32,
    /// Rows over the view; by default those of a bake
    #[arg(long, value_name = "N", default_value_t = 19, value_parser = clap::value_parser!(u32).range(4..=64))]
    pub(crate) rows: u32,
    #[command(flatten)]
    pub(crate) destination: Destination,
}

/// A share above 0 and below 1.
fn share(text: &str) -> Result<f64, String> {
    let share: f64 = text.parse().map_err(|error| format!("{error}"))?;
    if share > 0.0 && share < 1.0 { Ok(share) } else { Err("a number between 0 and 1".to_owned()) }
}

#[derive(Debug, Args)]
#[command(after_help = "Examples:\n  luthier-lab varying --random 8 -o docs/pages/varying.md")]
pub(crate) struct VaryingOptions {
    /// Random stacks: those of `lobes` with two layers or more
    #[arg(long, value_name = "N", default_value_t = 8)]
    pub(crate) random: u32,
    #[command(flatten)]
    pub(crate) precision: Precision,
    #[command(flatten)]
    pub(crate) destination: Destination,
}

#[derive(Debug, Args)]
#[command(
    after_help = "Examples:\n  luthier-lab families -o docs/pages/families.md\n  luthier-lab families --group metal --places 20 --noise 0.01"
)]
pub(crate) struct FamiliesOptions {
    /// Group of stacks; may be given again. By default all
    #[arg(long, value_name = "NAME")]
    pub(crate) group: Vec<FamilyGroup>,
    /// Random places of each group
    #[arg(long, value_name = "N", default_value_t = 200)]
    pub(crate) places: u32,
    /// Rows over the view
    #[arg(long, value_name = "N", default_value_t = 10, value_parser = clap::value_parser!(u32).range(4..=64))]
    pub(crate) rows: u32,
    #[command(flatten)]
    pub(crate) precision: Precision,
    #[command(flatten)]
    pub(crate) destination: Destination,
}

#[derive(Debug, Args)]
#[command(after_help = "Examples:\n  luthier-lab coats --noise 0.005 -o docs/pages/coats.md")]
pub(crate) struct CoatsOptions {
    #[command(flatten)]
    pub(crate) precision: Precision,
    #[command(flatten)]
    pub(crate) destination: Destination,
}

#[derive(Debug, Args)]
#[command(after_help = "Examples:\n  luthier-lab five-ways -o docs/pages/five-ways.md")]
pub(crate) struct FiveWaysOptions {
    /// Material files: a coat over a base of maps of base colour or metal
    #[arg(default_values = ["materials/textured/board/varnished-oak.toml", "materials/textured/board/worn-brass.toml"])]
    pub(crate) paths: Vec<PathBuf>,
    /// Side of each ball in pixels
    #[arg(long, value_name = "N", default_value_t = 112, value_parser = clap::value_parser!(u32).range(16..=1024))]
    pub(crate) size: u32,
    /// Picture to write
    #[arg(long, value_name = "FILE", default_value = "docs/images/five-ways.png")]
    pub(crate) picture: PathBuf,
    #[command(flatten)]
    pub(crate) destination: Destination,
}

#[derive(Debug, Args)]
#[command(
    after_help = "Examples:\n  luthier-lab formats materials -o docs/pages/formats.md\n  luthier-lab formats mine.toml --noise 0.005"
)]
pub(crate) struct FormatsOptions {
    #[command(flatten)]
    pub(crate) sources: Sources,
    /// Lobe error that noise of the simulation may cause
    #[arg(long, value_name = "X", default_value_t = 0.01)]
    pub(crate) noise: f64,
    #[command(flatten)]
    pub(crate) destination: Destination,
}

/// Stacks of one family.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum FamilyGroup {
    /// A coat over metal of any colour
    Metal,
    /// A coat over metal of any colour, both with Beckmann's distribution
    MetalBeckmann,
    /// A coat over plastic of any colour
    Plastic,
    /// A coat over one interface half way from plastic to metal
    Mixture,
    /// A tinted coat over metal or plastic of any colour
    Tinted,
    /// Two coats over metal of a complex index
    TwoCoats,
    /// A coat over metal of a complex index
    Copper,
    /// Metal or plastic of any colour without a coat
    Bare,
    /// A coat over anisotropic metal of any colour
    Brushed,
}

/// Places of every textured material with a pair of directions each.
pub(crate) const TEXTURED_PAIRS: u32 = 10_000;

#[derive(Debug, Args)]
#[command(
    after_help = "Exits with 1 when a shader is not what its tables are.\n\nExamples:\n  luthier-lab textured materials -o docs/pages/textured.md\n  \
                  luthier-lab textured mine.toml --no-generated --places 4 --noise 0.02"
)]
pub(crate) struct TexturedOptions {
    /// Material files, and folders of them; materials that are the same everywhere are left out
    #[arg(value_name = "PATH")]
    pub(crate) paths: Vec<PathBuf>,
    /// Leave out the materials that are made for each map and for pairs of maps
    #[arg(long)]
    pub(crate) no_generated: bool,
    /// Judge only the material of this name
    #[arg(long, value_name = "NAME")]
    pub(crate) only: Option<String>,
    /// Random places of each shader, with a pair of directions each
    #[arg(long, value_name = "N", default_value_t = TEXTURED_PAIRS, value_parser = clap::value_parser!(u32).range(2..=1_000_000))]
    pub(crate) pairs: u32,
    /// Random places at which rows are compared with the simulation
    #[arg(long, value_name = "N", default_value_t = 20, value_parser = clap::value_parser!(u64).range(1..=1000))]
    pub(crate) places: u64,
    #[command(flatten)]
    pub(crate) precision: Precision,
    #[command(flatten)]
    pub(crate) adapter: Adapter,
    #[command(flatten)]
    pub(crate) destination: Destination,
}

#[derive(Debug, Args)]
#[command(after_help = "Examples:\n  luthier-lab anisotropic materials --random 10 -o docs/pages/anisotropic.md")]
pub(crate) struct AnisotropicOptions {
    #[command(flatten)]
    pub(crate) sources: Sources,
    /// Random stacks besides
    #[arg(long, value_name = "N", default_value_t = 10)]
    pub(crate) random: u32,
    #[command(flatten)]
    pub(crate) precision: Precision,
    /// Show the seconds that each fit takes, too
    #[arg(long)]
    pub(crate) times: bool,
    #[command(flatten)]
    pub(crate) destination: Destination,
}

#[derive(Debug, Args)]
#[command(
    after_help = "Examples:\n  luthier-lab environment materials/papers/silver-paint.toml -o docs/pages/environment.md"
)]
pub(crate) struct EnvironmentOptions {
    #[command(flatten)]
    pub(crate) sources: Sources,
    /// Places along a side of a grid over the picture of a ball
    #[arg(long, value_name = "N", default_value_t = 16, value_parser = clap::value_parser!(u32).range(4..=64))]
    pub(crate) size: u32,
    /// Rows of the maps
    #[arg(long, value_name = "N", default_value_t = 256, value_parser = clap::value_parser!(u32).range(32..=512))]
    pub(crate) rows: u32,
    /// Random stacks of two interfaces besides
    #[arg(long, value_name = "N", default_value_t = 0)]
    pub(crate) random: u32,
    #[command(flatten)]
    pub(crate) adapter: Adapter,
    #[command(flatten)]
    pub(crate) destination: Destination,
}

#[derive(Debug, Args)]
#[command(
    after_help = "Examples:\n  luthier-lab simulation materials/papers/yamaguchi-brushed.toml -o docs/pages/simulation.md"
)]
pub(crate) struct SimulationOptions {
    #[command(flatten)]
    pub(crate) sources: Sources,
    /// Side of the pictures that are compared, in pixels
    #[arg(long, value_name = "PIXELS", default_value_t = 64, value_parser = clap::value_parser!(u32).range(8..=1024))]
    pub(crate) size: u32,
    /// Samples of each of their pixels
    #[arg(long, value_name = "N", default_value = "1024")]
    pub(crate) samples: NonZeroU32,
    /// Side of the pictures that are timed, in pixels
    #[arg(long, value_name = "PIXELS", default_value_t = 32, value_parser = clap::value_parser!(u32).range(8..=1024))]
    pub(crate) time_size: u32,
    /// Times that each of these is made
    #[arg(long, value_name = "N", default_value = "3")]
    pub(crate) repeats: NonZeroU32,
    /// File to write the numbers to, as JSON
    #[arg(long, value_name = "FILE")]
    pub(crate) data: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) adapter: Adapter,
    #[command(flatten)]
    pub(crate) destination: Destination,
}

#[derive(Debug, Args)]
#[command(after_help = "Examples:\n  luthier-lab throughput materials -o docs/pages/throughput.md")]
pub(crate) struct ThroughputOptions {
    #[command(flatten)]
    pub(crate) sources: Sources,
    /// Least number of evaluations in one run
    #[arg(long, value_name = "N", default_value_t = 1 << 20, value_parser = clap::value_parser!(u32).range(1..=60_000_000))]
    pub(crate) evaluations: u32,
    /// Timed runs of each shader
    #[arg(long, value_name = "N", default_value = "30")]
    pub(crate) repeats: NonZeroU32,
    /// File to write the numbers to, as JSON
    #[arg(long, value_name = "FILE")]
    pub(crate) data: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) adapter: Adapter,
    #[command(flatten)]
    pub(crate) destination: Destination,
}

#[derive(Debug, Args)]
#[command(after_help = "Examples:\n  luthier-lab budgets materials -o docs/pages/budgets.md")]
pub(crate) struct BudgetsOptions {
    #[command(flatten)]
    pub(crate) sources: Sources,
    #[command(flatten)]
    pub(crate) destination: Destination,
}

#[derive(Debug, Args)]
#[command(
    after_help = "Needs Mesa's RADV driver, as `luthier cost` does. Errors are measured on the graphics adapter of this machine, if there is one.\n\n\
                  Examples:\n  luthier-lab papers materials -o docs/pages/papers-cost.md\n  luthier-lab papers mine.toml --family rdna2"
)]
pub(crate) struct PapersOptions {
    #[command(flatten)]
    pub(crate) sources: Sources,
    /// Instruction set; may be given again. By default all
    #[arg(long, value_name = "NAME", value_parser = named::<Family>(Family::NAMES))]
    pub(crate) family: Vec<Family>,
    #[command(flatten)]
    pub(crate) destination: Destination,
}

#[derive(Debug, Args)]
#[command(
    after_help = "Every material is fitted with the model lobes. Needs Mesa's RADV driver, as `luthier cost` does.\n\n\
                  Examples:\n  luthier-lab layouts materials/papers/car-paint.toml materials/red-lacquer.toml -o docs/pages/layouts.md"
)]
pub(crate) struct LayoutsOptions {
    #[command(flatten)]
    pub(crate) sources: Sources,
    #[command(flatten)]
    pub(crate) destination: Destination,
}

#[derive(Debug, Args)]
#[command(after_help = "Costs come from counts of the texts: no driver is needed.\n\n\
                  Examples:\n  luthier-lab ladder materials/papers materials/varnished-brass.toml -o docs/pages/ladder.md\n  \
                  luthier-lab ladder materials/papers --stacks 20 --chart ladder.svg -o ladder.md")]
pub(crate) struct LadderOptions {
    #[command(flatten)]
    pub(crate) sources: Sources,
    /// Random stacks besides: those of `lobes` with two interfaces or more
    #[arg(long, value_name = "N", default_value_t = 0)]
    pub(crate) stacks: u32,
    /// Chart of error against time to write beside the page, as SVG. Judges coats of engines and the random stacks, with published models beside
    #[arg(long, value_name = "FILE")]
    pub(crate) chart: Option<PathBuf>,
    /// Coats of engines to judge for the chart, the first of `coats`; by default all
    #[arg(long, value_name = "N", requires = "chart")]
    pub(crate) coats: Option<usize>,
    #[command(flatten)]
    pub(crate) precision: Precision,
    #[command(flatten)]
    pub(crate) destination: Destination,
}

#[derive(Debug, Args)]
#[command(after_help = "Examples:\n  luthier-lab ladder-chart docs/pages/ladder.md -o docs/pages/ladder.svg")]
pub(crate) struct LadderChartOptions {
    /// A page that `ladder --chart` wrote
    #[arg(value_name = "PAGE")]
    pub(crate) page: PathBuf,
    #[command(flatten)]
    pub(crate) destination: Destination,
}

#[derive(Debug, Args)]
#[command(after_help = "Costs come from counts of the texts: no driver is needed.\n\n\
                  Examples:\n  luthier-lab sets materials/papers materials/soap-film.toml -o docs/pages/sets.md")]
pub(crate) struct SetsOptions {
    #[command(flatten)]
    pub(crate) sources: Sources,
    #[command(flatten)]
    pub(crate) destination: Destination,
}

#[derive(Debug, Args)]
#[command(
    after_help = "Counts every shape of the materials, whole and without some of their parts, on RDNA2. Needs Mesa's RADV driver, as `luthier cost` does.\n\n\
                  Examples:\n  luthier-lab shapes materials/papers materials/scenes/still-life -o cost.json"
)]
pub(crate) struct ShapesOptions {
    #[command(flatten)]
    pub(crate) sources: Sources,
    #[command(flatten)]
    pub(crate) destination: Destination,
}

#[derive(Debug, Args)]
#[command(
    after_help = "Reads gpu-cost.json, bench-gpu.json, throughput-gpu.json and bench-llvmpipe.json, and counts the shaders that their rows name. No device and no driver is needed.\n\n\
                  Examples:\n  luthier-lab devices materials/papers -o docs/pages/devices.md"
)]
pub(crate) struct DevicesOptions {
    #[command(flatten)]
    pub(crate) sources: Sources,
    /// Folder of the measurements
    #[arg(long, value_name = "DIR", default_value = "docs/measurements")]
    pub(crate) measurements: PathBuf,
    /// Folder to write the files of the devices to
    #[arg(long, value_name = "DIR", default_value = "crates/luthier-cost/data")]
    pub(crate) folder: PathBuf,
    #[command(flatten)]
    pub(crate) destination: Destination,
}

#[derive(Debug, Args)]
#[command(
    after_help = "`scripts/golden.sh` compares these lines with those of earlier bakes.\n\nExamples:\n  luthier-lab texels out"
)]
pub(crate) struct TexelsOptions {
    /// Folder of one bake or of many
    #[arg(value_name = "DIR")]
    pub(crate) folder: PathBuf,
}

#[derive(Debug, Args)]
#[command(
    after_help = "The maps are functions of the texture coordinates, and repeat. The same program gives the same bytes on every platform.\n\n\
                  Examples:\n  luthier-lab textures -o materials/textured/maps"
)]
pub(crate) struct TexturesOptions {
    /// Folder to write them into
    #[arg(short, long, value_name = "DIR")]
    pub(crate) output: PathBuf,
}

/// A kind of file that others wrote.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum ForeignKind {
    /// glTF
    Mesh,
    /// Radiance HDR and OpenEXR
    Sky,
    /// PNG, JPEG and WebP
    Picture,
    /// Tables of indices: CSV, and the YAML of refractiveindex.info
    Index,
    /// Materials of glTF and MaterialX: imported, checked and baked
    Material,
}

#[derive(Debug, Args)]
#[command(
    after_help = "Folders are fetched by hand: the page says where from. Outcomes of a collection take the place of earlier ones in --data, so that a page is made of many runs. \
                  Without --collection the page is made of --data alone.\n\n\
                  Examples:\n  luthier-lab foreign --collection mine --from mine.org --licence CC0 --data foreign.json mine\n  luthier-lab foreign --collection mine --kind mesh --data foreign.json mine/meshes\n  luthier-lab foreign --data foreign.json --page foreign.md"
)]
pub(crate) struct ForeignOptions {
    /// Folders of the collection; folders inside count
    #[arg(value_name = "FOLDER", requires = "collection")]
    pub(crate) folders: Vec<PathBuf>,
    /// Kind of file to try; may be given again. By default all
    #[arg(long, value_name = "KIND", value_enum, requires = "collection")]
    pub(crate) kind: Vec<ForeignKind>,
    /// Name of the collection on the page
    #[arg(long, value_name = "NAME", requires = "folders")]
    pub(crate) collection: Option<String>,
    /// Where to fetch it, of a collection that --data does not have
    #[arg(long, value_name = "TEXT", requires = "collection")]
    pub(crate) from: Option<String>,
    /// Its licence, likewise
    #[arg(long, value_name = "TEXT", requires = "collection")]
    pub(crate) licence: Option<String>,
    /// File of all outcomes, as JSON: it is read, and written again
    #[arg(long, value_name = "FILE")]
    pub(crate) data: Option<PathBuf>,
    /// File to write the page to instead of standard output
    #[arg(long, value_name = "FILE")]
    pub(crate) page: Option<PathBuf>,
}

/// The call of a verb for some files, as pages state it, without options.
pub(crate) fn call(verb: &str, paths: &[PathBuf]) -> String {
    let paths = paths.iter().map(|path| format!(" {}", path.display()));
    std::iter::once(format!("luthier-lab {verb}")).chain(paths).collect()
}
