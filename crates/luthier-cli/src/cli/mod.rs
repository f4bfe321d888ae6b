//! The command line: the one definition of verbs, options and their help.

#[cfg(feature = "gpu")]
use std::num::NonZeroU32;
use std::path::PathBuf;

use clap::{ArgGroup, Args, Command, CommandFactory, Parser, Subcommand};
#[cfg(feature = "cost")]
use luthier_cost::Family;
use luthier_lut::{RowLayout, TableKind};
use luthier_manifest::{Form, FunctionGroup, Reflectance, ShadingModel, Target};
use luthier_terminal::{Sources, named};

use crate::directions::Angles;
use crate::model_inputs::ModelInputs;
use crate::numbers::{angle, positive, wavelength};
use crate::store::StoreOptions;

const AFTER_HELP: &str = "\
Exit codes:
  0  success
  1  an input is invalid, or a budget is exceeded or cannot be met
  2  the command line is wrong
  3  a file cannot be read or written
  4  no usable graphics adapter, driver or display, or it failed, or this build has no code for one
  130  interrupted by SIGINT, SIGTERM or SIGHUP; no file is half written

With --json a failure is one JSON object on standard output, besides the sentence on standard error:
  {\"error\": {\"code\": 1, \"kind\": \"input\", \"message\": \"...\", \"diagnostics\": []}}
The kinds are input (1), usage (2), files (3) and device (4); diagnostics are those of `luthier check --json`.

Environment variables:
  LUTHIER_CACHE  folder of the results of earlier runs; empty: none are kept
  NO_COLOR       with a value, nothing is coloured
  TERM           dumb: nothing is coloured, and there are no progress bars

Examples:
  luthier bake materials            tables, manifest and shaders into out/
  luthier report --max-error 1e-3   judge out/ against the full evaluation in f64
  luthier preview materials/red-lacquer.toml -o ball.png
  luthier check my-material.toml
  luthier shader materials/red-lacquer.toml --target glsl450";

/// Bakes layered materials into look-up tables, with a shader that reads them and a report that proves the error.
#[derive(Debug, Parser)]
#[command(name = "luthier", version, after_help = AFTER_HELP, max_term_width = 100)]
pub(crate) struct Cli {
    #[command(subcommand)]
    pub(crate) verb: Verb,
    #[command(flatten)]
    pub(crate) store: StoreOptions,
}

/// Verbs that a cargo feature brings, and the feature.
pub(crate) const OF_FEATURES: [(&str, &str); 5] =
    [("preview", "gpu"), ("compare", "gpu"), ("bench", "gpu"), ("cost", "cost"), ("view", "view")];

#[derive(Debug, Subcommand)]
pub(crate) enum Verb {
    /// Bake materials: textures, manifest and shaders
    Bake(Box<BakeOptions>),
    /// Bake from what the shares of `luthier bake --shard` left in the store
    #[command(after_help = "Examples:\n  luthier merge materials --cache /shared/luthier --out build/luts")]
    Merge(Box<BakeOptions>),
    /// Show, check or empty the store of results
    #[command(
        subcommand,
        after_help = "Examples:\n  luthier cache stats\n  luthier cache verify --cache /shared/luthier\n  luthier cache clear"
    )]
    Cache(CacheVerb),
    /// Write a material file to begin with: of a class of surfaces, or of a real substance
    New(NewOptions),
    /// Validate materials, surfaces and scenes as `bake` would, without baking, and print the class of each surface
    Check(CheckOptions),
    /// Judge a bake: tables and shaders against the full evaluation in f64
    Report(ReportOptions),
    /// Judge a table of another program, and find the mistake in it
    Audit(Box<AuditOptions>),
    /// Bake a table that engines read beside a material: split sums, energy compensation, cloth, thin films
    Table(Box<TableOptions>),
    /// Render a material off screen
    #[cfg(feature = "gpu")]
    Preview(PreviewOptions),
    /// Show many materials: a page for browsers, or a contact sheet
    Gallery(Box<GalleryOptions>),
    /// Render a material with two shaders and compare the pictures
    #[cfg(feature = "gpu")]
    Compare(CompareOptions),
    /// Count the cycles of every shader of every material on gcn5, rdna2 and rdna3, without such a GPU, or predict its cost on another device: a page in Markdown
    #[cfg(feature = "cost")]
    Cost(CostOptions),
    /// Time every shader of every material on the graphics adapter of this machine
    #[cfg(feature = "gpu")]
    Bench(BenchOptions),
    #[cfg(feature = "view")]
    View(ViewOptions),
    /// Print the shader of some materials, or write it to a file
    Shader(ShaderOptions),
    /// Filter a picture of the surroundings beforehand: levels and irradiance as cubes and equirectangular maps
    Environment(EnvironmentOptions),
    /// List the reflectance models
    Models(ModelsOptions),
    /// Evaluate a reflectance model of a material in f64
    Eval(Box<EvalOptions>),
    /// Fit the model granier-heidrich to a lobe that a CSV file gives, and write a material file
    Fit(FitOptions),
    /// Write material files from the materials of other formats: glTF, physicallybased.info
    Import(ImportOptions),
    /// Write materials as parameters of other formats: glTF, OpenPBR, Standard Surface
    Export(ExportOptions),
    /// List the built-in optical constants, or show one set
    Ior(IorOptions),
    /// Print the JSON Schema of material files, of scenes or of surfaces
    #[command(
        after_help = "Examples:\n  luthier schema > material.schema.json\n  luthier schema --scene > scene.schema.json\n  luthier schema --surface > surface.schema.json"
    )]
    Schema {
        /// Print the schema of scene files
        #[arg(long)]
        scene: bool,
        /// Print the schema of surface files
        #[arg(long, conflicts_with = "scene")]
        surface: bool,
    },
    /// Print a script that completes verbs and options in a shell
    Completions(CompletionsOptions),
    /// Print the manual page, write the pages of all verbs, or print the reference of all options
    Man(ManOptions),
}

/// The command with all verbs whose definition this build has. The window takes long to build, its options do not: they are here without it.
pub(crate) fn with_all_verbs() -> Command {
    let command = Cli::command();
    #[cfg(all(feature = "gpu", not(feature = "view")))]
    let command = command.subcommand(ViewOptions::augment_args(Command::new("view")));
    command
}

/// The model of the shaders, and the tables beside them.
#[derive(Debug, Clone, Default, Args)]
pub(crate) struct Shading {
    /// Reflectance model of the shader. By default the one that each material file asks for; of a stack whose file asks for none `lobes`,
    /// or what shows all of it (docs/materials.md)
    #[arg(long, value_name = "NAME", value_parser = named::<ShadingModel>(ShadingModel::NAMES))]
    pub(crate) model: Option<ShadingModel>,
    /// Simulate nothing: files that ask for no model take a closed form, `elek` for most. Those that ask for `lobes` are refused
    #[arg(long, conflicts_with = "model")]
    pub(crate) no_fit: bool,
    /// How models come by the reflectance of an interface, all but `granier-heidrich`, `phong` and `lobes`, in place of what material files say:
    /// `table` reads rows, `exact` is Fresnel's equations, `approximate` Schlick's form with the F0 of n and k (Elek 2010), `lazanyi` has a
    /// correction of that
    #[arg(long, value_name = "NAME", value_parser = named::<Reflectance>(Reflectance::NAMES))]
    pub(crate) fresnel: Option<Reflectance>,
    /// Kinds of tables to bake and bind for every material, beside those that its shader reads
    #[arg(long, value_name = "KIND,...", value_delimiter = ',', value_parser = named::<TableKind>(TableKind::NAMES))]
    pub(crate) tables: Vec<TableKind>,
}

#[derive(Debug, Clone, Args)]
#[command(
    after_help = "A folder inside a folder among PATH that has material files is a package of its own, unless surfaces of PATH name all of them: it is \
                  baked into the folder of its name in --out. Folders of scenes or surfaces are not; nothing deeper is. All files are read before \
                  anything is made, and all packages are made before one is written. As JSON `packages` has what was made, by name.\n\n\
                  Examples:\n  luthier bake materials\n  luthier bake a.toml b.toml --out build/luts --threads 1 --json\n  \
                  luthier bake a.toml --max-abs 1e-3 --max-cost 200\n  \
                  luthier bake materials --target wgsl,msl --form baked\n  \
                  luthier bake a.toml --tables fgd,fresnel\n  luthier bake a.toml --model elek --fresnel approximate\n  \
                  luthier bake materials/scenes/showroom.toml\n  luthier bake materials/scenes/still-life.toml --budgets 0.3,0.1,0.03"
)]
pub(crate) struct BakeOptions {
    #[command(flatten)]
    pub(crate) sources: Sources,
    #[command(flatten)]
    pub(crate) shading: Shading,
    #[command(flatten)]
    pub(crate) limits: Limits,
    #[command(flatten)]
    pub(crate) emission: Emission,
    #[command(flatten)]
    pub(crate) pipeline: Pipeline,
    #[command(flatten)]
    pub(crate) costs_of: CostsOf,
    /// Of a scene: if no model holds the budget, take the most accurate one
    #[arg(long)]
    pub(crate) allow_miss: bool,
    /// Of scenes: print the choices under each of these limits on the relative error, as a page in Markdown; no bake is written
    #[arg(long, value_name = "X,...", value_delimiter = ',', value_parser = positive, allow_hyphen_values = true)]
    pub(crate) budgets: Vec<f64>,
    /// Folder to write to
    #[arg(long, value_name = "DIR", default_value = "out")]
    pub(crate) out: PathBuf,
    /// Leave the texels of the textures uncompressed, for programs that decode no zstd
    #[arg(long)]
    pub(crate) no_zstd: bool,
    /// Give every file but the manifest a name that contains its hash: replacing the manifest alone then switches from one bake to the next (docs/pipelines.md)
    #[arg(long)]
    pub(crate) hashed_names: bool,
    /// Threads to use; by default all. The bytes do not depend on it
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub(crate) threads: Option<u16>,
    /// Print what was made as JSON
    #[arg(long)]
    pub(crate) json: bool,
    /// Print errors only
    #[arg(long, short)]
    pub(crate) quiet: bool,
}

/// Options for build pipelines.
#[derive(Debug, Clone, Args)]
#[command(next_help_heading = "Build pipelines")]
pub(crate) struct Pipeline {
    /// Write nothing: exit with 1 and list what is stale where a bake would change the folder
    #[arg(long, conflicts_with_all = ["dry_run", "watch", "shard", "relock", "depfile"])]
    pub(crate) check: bool,
    /// Write nothing: count the jobs that would run
    #[arg(long, conflicts_with_all = ["watch", "shard", "relock", "depfile"])]
    pub(crate) dry_run: bool,
    /// Write the files that the bake depends on to FILE, as a rule of Make that Ninja reads, too
    #[arg(long, value_name = "FILE", conflicts_with = "shard")]
    pub(crate) depfile: Option<PathBuf>,
    /// Bake again whenever a file changes
    #[arg(long, conflicts_with = "shard")]
    pub(crate) watch: bool,
    /// Compute share I of N of the jobs into the store and publish nothing; `luthier merge` bakes from the shares
    #[arg(long, value_name = "I/N", value_parser = share)]
    pub(crate) shard: Option<luthier_bake::Share>,
    /// Search sizes, axes and formats anew, and write them to luthier.lock beside the materials: later bakes keep them until a budget breaks
    #[arg(long, conflicts_with_all = ["shard", "no_search"])]
    pub(crate) relock: bool,
    /// Print what happens as lines of JSON on standard error
    #[arg(long)]
    pub(crate) events: bool,
}

fn share(text: &str) -> Result<luthier_bake::Share, String> {
    let numbers = text.split_once('/').and_then(|(i, n)| Some((i.parse().ok()?, n.parse().ok()?)));
    match numbers {
        Some((index, count)) if 1 <= index && index <= count => Ok(luthier_bake::Share { index, count }),
        _ => Err("expected a share such as 2/8: a number from 1 on, and the number of shares".to_owned()),
    }
}

/// The shaders to write.
#[derive(Debug, Clone, Args)]
pub(crate) struct Emission {
    /// Languages of the shaders; by default wgsl, glsl450 and glsl-es300
    #[arg(long, value_parser = named::<Target>(Target::NAMES), value_name = "NAME,...", value_delimiter = ',')]
    pub(crate) target: Vec<Target>,
    /// Forms of the shaders; by default both
    #[arg(long, value_parser = named::<Form>(Form::NAMES), value_name = "NAME,...", value_delimiter = ',')]
    pub(crate) form: Vec<Form>,
    /// Groups of functions beside luthier_eval: `light` (two steps for many lights), `sample` (drawn directions), `propose` (a direction for each lobe), `albedo`, `environment` (prefiltered, of materials of lobes; `environment-4` with four reads a lobe, as -2 and -1, in place of eight), `surface` (normals of a renderer's own)
    #[arg(long, value_parser = named::<FunctionGroup>(FunctionGroup::NAMES), value_name = "NAME,...", value_delimiter = ',')]
    pub(crate) functions: Vec<FunctionGroup>,
    #[command(flatten)]
    pub(crate) names: NamesOptions,
}

/// Limits on tables. Each replaces that of the files' `[budget]`; the bake takes the cheapest tables that hold them (docs/pages/budgets.md).
#[derive(Debug, Clone, Args)]
pub(crate) struct Limits {
    /// Largest absolute error of a sampled table; of D, relative to its peak
    #[arg(long, value_name = "X", value_parser = positive, allow_hyphen_values = true)]
    pub(crate) max_abs: Option<f64>,
    /// Largest error relative to the value, or to 0.01 where that is larger
    #[arg(long, value_name = "X", value_parser = positive, allow_hyphen_values = true)]
    pub(crate) max_rel: Option<f64>,
    /// Largest CIEDE2000 difference of tabulated reflectances under D65
    #[arg(long, value_name = "X", value_parser = positive, allow_hyphen_values = true)]
    pub(crate) delta_e: Option<f64>,
    /// Bytes of the texels of all tables
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..), allow_hyphen_values = true)]
    pub(crate) max_bytes: Option<u64>,
    /// Estimated cost of one read of every table, in operations of no device
    #[arg(long, value_name = "X", value_parser = positive, allow_hyphen_values = true)]
    pub(crate) max_cost: Option<f64>,
    /// Largest lobe error of fitted lobes against the simulated stack, noise of the judge included
    #[arg(long, value_name = "X", value_parser = positive, allow_hyphen_values = true)]
    pub(crate) max_lobe_err: Option<f64>,
    /// Largest error of the directional albedo of fitted lobes
    #[arg(long, value_name = "X", value_parser = positive, allow_hyphen_values = true)]
    pub(crate) max_albedo_err: Option<f64>,
    /// Layout of rows of lobes: `filtered`, a texture for a sampler, or `steps`, a storage buffer that gives both ends of an interval at once, for twice the bytes. By default the one that was cheaper on an NVIDIA H200, and `filtered` with glsl-es300, which has no buffers (docs/bindings.md)
    #[arg(long, value_name = "NAME", value_parser = named::<RowLayout>(RowLayout::NAMES))]
    pub(crate) layout: Option<RowLayout>,
    /// Take fixed sizes, mappings and formats, whatever the budget
    #[arg(long, conflicts_with_all = ["max_abs", "max_rel", "delta_e", "max_bytes", "max_cost", "max_lobe_err", "max_albedo_err"])]
    pub(crate) no_search: bool,
}

impl Limits {
    /// The options of the baker under these limits.
    pub(crate) fn options(&self) -> luthier_bake::Options<'static> {
        let &Self { max_abs, max_rel, delta_e, max_bytes, max_cost, max_lobe_err, max_albedo_err, layout, no_search } =
            self;
        let budget =
            luthier_manifest::Budget { max_abs, max_rel, delta_e, max_bytes, max_cost, max_lobe_err, max_albedo_err };
        luthier_bake::Options { budget, layout, search: !no_search, ..luthier_bake::Options::default() }
    }
}

/// Work on the store of results.
#[derive(Debug, Subcommand)]
pub(crate) enum CacheVerb {
    /// Print the folder, the number of results and their bytes
    #[command(after_help = "Examples:\n  luthier cache stats\n  luthier cache stats --json")]
    Stats {
        /// Print as JSON
        #[arg(long)]
        json: bool,
    },
    /// Read all results, remove those that are damaged, and exit with 1 if there were any
    #[command(after_help = "Examples:\n  luthier cache verify --cache /shared/luthier")]
    Verify,
    /// Remove all results
    #[command(after_help = "Examples:\n  luthier cache clear")]
    Clear,
}

#[derive(Debug, Args)]
#[command(after_help = "Examples:\n  luthier check materials\n  luthier check mine.toml --json")]
pub(crate) struct CheckOptions {
    #[command(flatten)]
    pub(crate) sources: Sources,
    #[command(flatten)]
    pub(crate) shading: Shading,
    /// Print the diagnostics as JSON
    #[arg(long)]
    pub(crate) json: bool,
}

/// Options of reports on bakes.
#[cfg(feature = "gpu")]
const OF_BAKES: [&str; 15] = [
    "out",
    "max_error",
    "max_abs",
    "max_delta_e",
    "max_bytes",
    "max_lobe",
    "cost",
    "stability",
    "gallery",
    "pairs",
    "no_device",
    "max_flip",
    "picture_size",
    "times",
    "adapter",
];
#[cfg(not(feature = "gpu"))]
const OF_BAKES: [&str; 11] = [
    "out",
    "max_error",
    "max_abs",
    "max_delta_e",
    "max_bytes",
    "max_lobe",
    "cost",
    "stability",
    "gallery",
    "pairs",
    "no_device",
];

#[derive(Debug, Args)]
#[command(after_help = "Exits with 1 when a limit is broken: of the command line, or a budget of a material file.\n\n\
                  Of a scene, albedos are means over places of the material's triangles, against the normal there. The formula is that of glTF 2.0, appendix B, \
                  with KHR_materials_clearcoat, _ior, _specular and _anisotropy.\n\nExamples:\n  luthier report\n  \
                  luthier report --out build/luts --max-error 1e-3 --max-delta-e 1\n  luthier report --no-device --json\n  luthier report \
                  --reference --cost cost.json --stability suite.json\n  luthier report car.glb\n  luthier report car.glb --reference=100000 --json")]
pub(crate) struct ReportOptions {
    /// A glTF file in place of a bake: for each of its materials the albedo in a white furnace by glTF's formula, by the simulation of the layers that it means, and by its model. Nothing is written
    #[arg(value_name = "SCENE", conflicts_with_all = OF_BAKES)]
    pub(crate) scene: Option<PathBuf>,
    /// Folder of the bake; the report goes into its folder report/
    #[arg(long, value_name = "DIR", default_value = "out")]
    pub(crate) out: PathBuf,
    /// Exit with 1 when the largest relative error of a shader exceeds this, or the error of a table that misses what its bake aimed at
    #[arg(long, value_name = "X", value_parser = positive, allow_hyphen_values = true)]
    pub(crate) max_error: Option<f64>,
    /// Exit with 1 when the absolute error of a table, as the report measures it or the manifest states it, exceeds this
    #[arg(long, value_name = "X", value_parser = positive, allow_hyphen_values = true)]
    pub(crate) max_abs: Option<f64>,
    /// Exit with 1 when a colour difference (CIEDE2000, daylight) of a shader exceeds this
    #[arg(long, value_name = "X", value_parser = positive, allow_hyphen_values = true)]
    pub(crate) max_delta_e: Option<f64>,
    /// Exit with 1 when the mean FLIP of a material's pictures exceeds this
    #[cfg(feature = "gpu")]
    #[arg(long, value_name = "X", value_parser = positive, allow_hyphen_values = true, conflicts_with = "no_device")]
    pub(crate) max_flip: Option<f64>,
    /// Exit with 1 when the texels of all tables take more bytes than this
    #[arg(long, value_name = "N")]
    pub(crate) max_bytes: Option<u64>,
    /// Exit with 1 when the lobe error of a model of the bake, against the reference, exceeds this
    #[arg(long, value_name = "X", value_parser = positive, allow_hyphen_values = true, requires = "reference")]
    pub(crate) max_lobe: Option<f64>,
    /// Compare the models with a simulation of this many paths per view; of a scene 16384 unless given
    #[arg(long, value_name = "PATHS", num_args = 0..=1, default_missing_value = "1000", require_equals = true)]
    pub(crate) reference: Option<std::num::NonZeroU32>,
    /// Costs of shaders on gcn5, rdna2 and rdna3: the output of `luthier cost --json` for these materials
    #[arg(long, value_name = "FILE")]
    pub(crate) cost: Option<PathBuf>,
    /// Results of the stability suite: the output of `luthier-lab stability --json`
    #[arg(long, value_name = "FILE")]
    pub(crate) stability: Option<PathBuf>,
    /// Address of a page of `luthier gallery --html`, as seen from the page of the report: each material links to its picture there
    #[arg(long, value_name = "URL")]
    pub(crate) gallery: Option<String>,
    /// Side of the pictures in pixels; 0 makes none
    #[cfg(feature = "gpu")]
    #[arg(long, value_name = "N", default_value_t = 144, value_parser = clap::value_parser!(u32).range(0..=512))]
    pub(crate) picture_size: u32,
    /// Time the shaders on the adapter, too; reports of the same bake then differ from run to run
    #[cfg(feature = "gpu")]
    #[arg(long, conflicts_with = "no_device")]
    pub(crate) times: bool,
    /// Pairs of directions in every set of every material
    #[arg(long, value_name = "N", default_value_t = 4096, value_parser = clap::value_parser!(u32).range(1..=1_000_000))]
    pub(crate) pairs: u32,
    /// Judge the tables only, without running the shaders
    #[arg(long)]
    pub(crate) no_device: bool,
    /// Use the graphics adapter whose name contains this
    #[cfg(feature = "gpu")]
    #[arg(long, value_name = "NAME", conflicts_with = "no_device")]
    pub(crate) adapter: Option<String>,
    /// Print report.json to standard output as well
    #[arg(long)]
    pub(crate) json: bool,
}

mod device;
pub(crate) use device::CostsOf;

mod manual;
pub(crate) use manual::{CompletionsOptions, ManOptions};

mod names;
pub(crate) use names::NamesOptions;

mod environment;
mod export;
pub(crate) use environment::{EnvironmentOptions, LayoutName};

mod fit;
pub(crate) use fit::{FitOptions, Thicknesses};

mod gallery;
pub(crate) use gallery::GalleryOptions;

mod import;
pub(crate) use export::ExportOptions;
pub(crate) use import::ImportOptions;

mod new;
pub(crate) use new::NewOptions;

mod audit;
mod destinations;
pub(crate) use audit::{AuditOptions, NodesName, SamplesName};

mod table;
pub(crate) use table::{
    ClothName, ClothOptions, Delivery, DfgOptions, DistributionName, EnergyOptions, FilmOptions, FresnelOptions,
    Function, LtcOptions, SheenOptions, TableOptions,
};

#[cfg(feature = "gpu")]
mod render;
#[cfg(feature = "gpu")]
pub(crate) use render::{CompareOptions, Look, PreviewOptions, ShapeName, Side};

#[cfg(feature = "cost")]
const COST_EXAMPLES: &str = "\
Mesa's RADV driver compiles for gcn5, rdna2 and rdna3 without such a GPU; where it is missing, the exit code is 4. Costs on h100, llvmpipe or a device of --costs \
are predicted from counts of the texts, and need no driver. What making directions \
and writing the value costs is subtracted. Every shader comes with its material in a buffer and as constants of the code, and the \
form `baked` with D from its table and in closed form, unless named.

Examples:
  luthier cost materials -o docs/pages/cost.md
  luthier cost mine.toml --model elek --model phong --family rdna2 --json
  luthier cost materials --set --form baked
  luthier cost mine.toml --device h100
  luthier cost mine.toml --model elek --form baked --closed --constant --family rdna2 --assembly";

#[cfg(feature = "cost")]
#[derive(Debug, Args)]
#[command(after_help = COST_EXAMPLES)]
pub(crate) struct CostOptions {
    #[command(flatten)]
    pub(crate) sources: Sources,
    /// Model to compile; may be given again. By default all
    #[arg(long, value_name = "NAME", value_parser = named::<ShadingModel>(ShadingModel::NAMES))]
    pub(crate) model: Vec<ShadingModel>,
    /// Leave out `lobes`, whose shader takes a simulation of each material
    #[arg(long, conflicts_with = "model")]
    pub(crate) no_fit: bool,
    /// How models come by the reflectance of an interface, where they have a choice: table, exact, approximate or lazanyi
    #[arg(long, value_name = "NAME", value_parser = named::<Reflectance>(Reflectance::NAMES))]
    pub(crate) fresnel: Option<Reflectance>,
    /// Layout of rows of lobes: `filtered`, the default, or `steps`
    #[arg(long, value_name = "NAME", value_parser = named::<RowLayout>(RowLayout::NAMES))]
    pub(crate) layout: Option<RowLayout>,
    /// Form to compile; may be given again. By default both
    #[arg(long, value_parser = named::<Form>(Form::NAMES), value_name = "FORM")]
    pub(crate) form: Vec<Form>,
    /// Instruction set: gcn5, rdna2 or rdna3; may be given again. By default all
    #[arg(long, value_name = "NAME", value_parser = named::<Family>(Family::NAMES), conflicts_with_all = ["device", "costs"])]
    pub(crate) family: Vec<Family>,
    #[command(flatten)]
    pub(crate) costs_of: CostsOf,
    /// All materials in one shader, as a bake of them has it, instead of each in its own
    #[arg(long)]
    pub(crate) set: bool,
    /// Only shaders whose D is a closed form
    #[arg(long)]
    pub(crate) closed: bool,
    /// Only shaders whose material is constants of the code
    #[arg(long, conflicts_with = "set")]
    pub(crate) constant: bool,
    /// Print the machine code of one kernel
    #[arg(long, conflicts_with_all = ["json", "output", "costs"])]
    pub(crate) assembly: bool,
    /// JSON instead of Markdown
    #[arg(long)]
    pub(crate) json: bool,
    /// File to write instead of standard output
    #[arg(long, short, value_name = "FILE")]
    pub(crate) output: Option<PathBuf>,
}

#[cfg(feature = "gpu")]
#[derive(Debug, Args)]
#[command(
    after_help = "Shaders are timed in turns, beside yardsticks: the surface of glTF (gltf), its extension for coats (gltf-clearcoat) and the coat of Filament (filament-clearcoat), with numbers taken from the material. The output has nanoseconds per evaluation; an evaluation is of one light. A software adapter is timed too, and the output says so.\n\nExamples:\n  luthier bench materials/car-paint.toml\n  luthier bench mine.toml --model elek --lights 1 --repeats 100 --json -o bench.json\n  luthier bench materials/papers --model lobes --per-pixel 1,8,16"
)]
pub(crate) struct BenchOptions {
    #[command(flatten)]
    pub(crate) sources: Sources,
    /// Model to time besides Phong's; may be given again. By default all
    #[arg(long, value_name = "NAME", value_parser = named::<ShadingModel>(ShadingModel::NAMES))]
    pub(crate) model: Vec<ShadingModel>,
    /// Leave out `lobes`, whose tables take a simulation of each material
    #[arg(long, conflicts_with = "model")]
    pub(crate) no_fit: bool,
    /// How models come by the reflectance of an interface, where they have a choice: table, exact, approximate or lazanyi
    #[arg(long, value_name = "NAME", value_parser = named::<Reflectance>(Reflectance::NAMES))]
    pub(crate) fresnel: Option<Reflectance>,
    /// Layout of rows of lobes, as for `luthier bake`. By default all
    #[arg(long, value_name = "NAME", value_parser = named::<RowLayout>(RowLayout::NAMES))]
    pub(crate) layout: Option<RowLayout>,
    /// Lights on a prepared view, a divisor of 16; may list several. One light is an evaluation of both directions
    #[arg(long, value_name = "N", value_delimiter = ',', default_value = "1,4,16", value_parser = lights)]
    pub(crate) lights: Vec<u32>,
    /// Time sets of the first N materials instead, each thread with a material of its own, in the models of their files or of `--model`; may list several
    #[arg(long, value_name = "N", value_delimiter = ',', value_parser = clap::value_parser!(u32).range(1..=100_000))]
    pub(crate) per_pixel: Vec<u32>,
    /// Least number of evaluations in one run
    #[arg(long, value_name = "N", default_value_t = 1 << 20, value_parser = clap::value_parser!(u32).range(1..=60_000_000))]
    pub(crate) evaluations: u32,
    /// Runs of each shader before the timed ones
    #[arg(long, value_name = "N", default_value_t = 3, value_parser = clap::value_parser!(u32).range(0..=1000))]
    pub(crate) warm_up: u32,
    /// Timed runs of each shader
    #[arg(long, value_name = "N", default_value_t = BENCH_REPEATS)]
    pub(crate) repeats: NonZeroU32,
    /// Use the graphics adapter whose name contains this
    #[arg(long, value_name = "NAME")]
    pub(crate) adapter: Option<String>,
    /// Fit costs of operations to the times, print them and write them to FILE, which `--costs` reads. Without FILE they are printed alone
    #[arg(long, value_name = "FILE", num_args = 0..=1, default_missing_value = "-", conflicts_with = "per_pixel")]
    pub(crate) fit: Option<PathBuf>,
    /// JSON instead of a table
    #[arg(long)]
    pub(crate) json: bool,
    /// File to write instead of standard output
    #[arg(long, short, value_name = "FILE")]
    pub(crate) output: Option<PathBuf>,
}

/// A number of lights that divides the evaluations of a thread.
#[cfg(feature = "gpu")]
fn lights(text: &str) -> Result<u32, String> {
    let number = text.parse().ok().filter(|&number| matches!(number, 1 | 2 | 4 | 8 | 16));
    number.ok_or_else(|| "a number of lights is 1, 2, 4, 8 or 16".to_owned())
}

/// Runs that count: the median is then safe from fourteen outliers.
#[cfg(feature = "gpu")]
const BENCH_REPEATS: NonZeroU32 = NonZeroU32::new(30).expect("not zero");

#[cfg(feature = "gpu")]
#[cfg_attr(not(feature = "view"), expect(dead_code, reason = "the reference lists these options without a window too"))]
mod view;
#[cfg(feature = "view")]
pub(crate) use view::ThemeName;
#[cfg(feature = "gpu")]
pub(crate) use view::ViewOptions;

#[derive(Debug, Args)]
#[command(
    after_help = "Examples:\n  luthier shader materials\n  luthier shader mine.toml --target glsl-es300 --form full --complete\n  luthier shader mine.toml --functions sample,albedo\n  luthier shader mine.toml --target spirv --complete -o mine.spv"
)]
pub(crate) struct ShaderOptions {
    #[command(flatten)]
    pub(crate) sources: Sources,
    #[command(flatten)]
    pub(crate) shading: Shading,
    /// Language of the shader
    #[arg(long, value_parser = named::<Target>(Target::NAMES), default_value_t = Target::Wgsl)]
    pub(crate) target: Target,
    /// Form of the shader: `baked` reads tables, `full` computes all terms
    #[arg(long, value_parser = named::<Form>(Form::NAMES), default_value_t = Form::Baked)]
    pub(crate) form: Form,
    /// Groups of functions beside luthier_eval: `light` (two steps for many lights), `sample` (drawn directions), `propose` (a direction for each lobe), `albedo`, `environment` (prefiltered, of materials of lobes; `environment-4` with four reads a lobe, as -2 and -1, in place of eight), `surface` (normals of a renderer's own)
    #[arg(long, value_parser = named::<FunctionGroup>(FunctionGroup::NAMES), value_name = "NAME,...", value_delimiter = ',')]
    pub(crate) functions: Vec<FunctionGroup>,
    /// Layout of rows of lobes, as for `luthier bake`
    #[arg(long, value_name = "NAME", value_parser = named::<RowLayout>(RowLayout::NAMES))]
    pub(crate) layout: Option<RowLayout>,
    /// D in closed form instead of from its table
    #[arg(long)]
    pub(crate) closed: bool,
    /// The numbers of one material as constants of the code instead of a buffer
    #[arg(long, conflicts_with = "complete")]
    pub(crate) constant: bool,
    /// A complete small fragment shader instead of functions to paste (SPIR-V: instead of a library to link)
    #[arg(long)]
    pub(crate) complete: bool,
    /// File to write instead of standard output
    #[arg(long, short, value_name = "FILE")]
    pub(crate) output: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) names: NamesOptions,
}

#[derive(Debug, Args)]
#[command(after_help = "Examples:\n  luthier models\n  luthier models --json")]
pub(crate) struct ModelsOptions {
    /// Print as JSON
    #[arg(long)]
    pub(crate) json: bool,
}

const EVAL_EXAMPLES: &str = "\
Prints f cos theta_i in linear Rec.709, in the colour of the file: spectral, or that of three wavelengths where [bake] says so. \
Models with a shader (elek, weidlich-wilkie, granier-heidrich, belcour, \
yamaguchi, phong, microfacet) are its f64 twin: one index at 589.3 nm bends the directions of all channels, colours are those of \
each term. The colour of the file stands for the `baked` form, --three-wavelengths for the `full` one.

Effects of the file count at the place of --uv and --distance: flakes and patina for elek, weidlich-wilkie and lobes, glitter for all; JSON says \
what is there. That is `luthier_eval_at`; --no-effects is `luthier_eval`. Of a surface file, the material at that place is evaluated, with the normal there. Maps of single layers, of albedo, base colour and metal count there, too; those of the whole surface (normal, roughness, thickness of the first slab) do not: the options on textures \
say what they hold.

The model lobes is fitted anew, to the stack at the place. --out FOLDER reads the tables that a bake ships instead, as the shader reads them at the place, of any \
model that has a shader.

Estimates come with their standard error. It is `not-settled`, in JSON null beside `settled` false, where rare paths carry the light and too \
few of them were met to know it; more --samples settle it.

Furnace: the surface without loss (no absorption, conductors and diffuse bases that reflect everything, a white base below a \
last medium; for models of one interface a mirror below it) under light of radiance 1 from everywhere. What a model shows \
of it is 1 where it keeps all energy.

Matrix: CSV. The first row has the wavelengths of the light in nm after a first field that is free; each row below has a \
wavelength that comes out, the same ones, and the shares of the power of each wavelength of the light that come out there.

Examples:
  luthier eval materials/red-lacquer.toml --model belcour --wi 30,0 --wo 45,180
  luthier eval materials/red-lacquer.toml --model layered-mc --wi 30,0 --wo 45,180 --wavelength 550
  luthier eval materials/car-paint.toml --model elek --directions pairs.csv --three-wavelengths
  luthier eval materials/car-paint.toml --model elek --directions - --json
  luthier eval materials/car-paint.toml --model elek --albedo
  luthier eval materials/car-paint.toml --model elek --albedo --angles 0,60 --normal 10,0
  luthier eval materials/copper-patina.toml --model elek --uv 0.2,0.7 --wi 30,0 --wo 45,180
  luthier eval materials/varnished-brass.toml --model lobes --out out --wi 30,0 --wo 45,180
  luthier eval materials/surfaces/sunstone.toml --model elek --uv 0.2,0.7 --wi 30,0 --wo 45,180
  luthier eval film.toml --polarised --angles 0,60 --wavelength 550
  luthier eval materials/car-paint.toml --model weidlich-wilkie --furnace
  luthier eval materials/car-paint.toml --model flakes --uv 0.2,0.7 --wi 30,0 --wo 45,180
  luthier eval a.toml --model fluorescence --matrix m.csv --excitation 530 --wavelength 600 --albedo";

#[derive(Debug, Args)]
#[command(after_help = EVAL_EXAMPLES)]
#[command(group = ArgGroup::new("what").required(true).args(["wi", "directions", "albedo", "furnace", "environment", "polarised"]))]
#[command(group = ArgGroup::new("against_angle").args(["albedo", "furnace", "environment", "polarised"]))]
pub(crate) struct EvalOptions {
    /// A material file
    #[arg(value_name = "FILE")]
    pub(crate) file: PathBuf,
    /// Name of a model; `luthier models` lists them
    #[arg(long, value_name = "NAME", required_unless_present = "polarised")]
    pub(crate) model: Option<String>,
    /// Direction to the light, in degrees: theta from the normal (0 to 90), phi around it
    #[arg(long, value_name = "THETA,PHI", allow_hyphen_values = true, requires = "wo")]
    pub(crate) wi: Option<Angles>,
    /// Direction to the eye
    #[arg(long, value_name = "THETA,PHI", allow_hyphen_values = true, requires = "wi")]
    pub(crate) wo: Option<Angles>,
    /// CSV file of lines theta_i,phi_i,theta_o,phi_o in degrees; `-` is standard input. Lines that begin with # are comments
    #[arg(long, value_name = "CSV")]
    pub(crate) directions: Option<PathBuf>,
    /// Directional albedo against angle instead of values: at 550 nm unless another wavelength is given
    #[arg(long)]
    pub(crate) albedo: bool,
    /// White furnace against angle: radiance of the lossless surface under light of radiance 1, and its deviation from 1
    #[arg(long)]
    pub(crate) furnace: bool,
    /// Share of a uniform environment that the first interface mirrors, against angle (elek)
    #[arg(long)]
    pub(crate) environment: bool,
    /// Reflectance of light polarised normal to the plane of incidence (s) and in it (p), against angle: one smooth interface, bare or
    /// under films
    #[arg(long, conflicts_with = "model")]
    pub(crate) polarised: bool,
    /// Folder of a bake whose tables to read, as its shader reads them, in place of exact terms: the model is that of the material in the
    /// bake, and colours are those of its tables
    #[arg(long, value_name = "DIR", conflicts_with_all = ["against_angle", "rgb", "wavelength", "three_wavelengths"])]
    pub(crate) out: Option<PathBuf>,
    /// Angles from the normal instead of 0 to 85 degrees in steps of 5
    #[arg(long, value_name = "DEG,...", value_delimiter = ',', value_parser = angle, requires = "against_angle")]
    pub(crate) angles: Vec<f64>,
    /// Azimuth of the eye, in degrees, in output against angle
    #[arg(long, value_name = "DEG", default_value_t = 0.0, allow_hyphen_values = true, requires = "against_angle")]
    pub(crate) azimuth: f64,
    /// Spectral colour, whatever the file has; in output against angle in place of one wavelength
    #[arg(long, conflicts_with_all = ["furnace", "environment"])]
    pub(crate) rgb: bool,
    /// One wavelength, 360 to 830 nm. Absorption, diffuse albedo and `f0` are those of the channel nearest to it (645, 525, 445 nm)
    #[arg(long, value_name = "NM", value_parser = wavelength, conflicts_with_all = ["rgb", "three_wavelengths"])]
    pub(crate) wavelength: Option<f64>,
    /// The material's three wavelengths taken as R, G, B, whatever colour the file has
    #[arg(long, conflicts_with_all = ["rgb", "furnace", "environment"])]
    pub(crate) three_wavelengths: bool,
    /// Print as JSON
    #[arg(long)]
    pub(crate) json: bool,
    #[command(flatten)]
    pub(crate) inputs: ModelInputs,
}

#[derive(Debug, Args)]
#[command(
    after_help = "Examples:\n  luthier ior\n  luthier ior au\n  luthier ior tio2_film --json\n  luthier ior --f0"
)]
pub(crate) struct IorOptions {
    /// Id of a data set; without it, all are listed
    #[arg(value_name = "NAME")]
    pub(crate) name: Option<String>,
    /// Compare published tables of reflectance at normal incidence with the data sets
    #[arg(long, conflicts_with = "name")]
    pub(crate) f0: bool,
    /// Print as JSON
    #[arg(long)]
    pub(crate) json: bool,
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The table of features and the attributes of the verbs say the same.
    #[test]
    fn a_verb_is_there_where_its_feature_is() {
        let command = Cli::command();
        for (verb, feature) in OF_FEATURES {
            let is_on = match feature {
                "cost" => cfg!(feature = "cost"),
                "gpu" => cfg!(feature = "gpu"),
                "view" => cfg!(feature = "view"),
                other => panic!("no feature `{other}`"),
            };
            assert_eq!(command.find_subcommand(verb).is_some(), is_on, "{verb}");
        }
    }
}
