//! Options of `table`.

use std::path::PathBuf;

use clap::builder::{PossibleValuesParser, TypedValueParser};
use clap::{ArgGroup, Args, Subcommand, ValueEnum};
use luthier_shader::Target;
use luthier_table::{EnergyPreset, Preset};

use super::audit::{NodesName, preset, unit};

const EXAMPLES: &str = "\
Every function comes by quadrature. The output says the layout and the error as sampled: bilinear, 8-bit weights. docs/engines.md has the \
presets, and how each engine takes its table.

Examples:
  luthier table dfg --preset bevy -o dfg.ktx2
  luthier table dfg --max-abs 1e-3 -o dfg.ktx2 --report dfg.html
  luthier table energy --preset cycles -o tables
  luthier table film --film 1.33 --base 1.5 -o film.ktx2";

const DFG_EXAMPLES: &str = "\
Bakes the split sum of image-based lighting (DFG, environment BRDF): reflectance is f0 * scale + bias. With --preset in the layout of an \
engine; with --max-abs the smallest table of half floats whose filtered reads hold this error, as KTX2; with --closed the cheapest closed form that \
holds it. Errors are over cosines from --min-cos and alphas from --min-alpha.

Exits with 1 when no table, or no closed form, holds --max-abs, and writes nothing then.

Examples:
  luthier table dfg --preset bevy -o dfg.ktx2
  luthier table dfg --preset three -o DFGLUTData.js --json
  luthier table dfg --preset three -o DFGLUTData.js --report dfg.html --beside theirs.exr
  luthier table dfg --max-abs 1e-3 -o dfg.ktx2 --shader wgsl,hlsl
  luthier table dfg --max-abs 1e-3 --closed -o dfg.wgsl
  luthier table dfg --max-abs 5e-4 --max-bytes 2048 -o dfg.ktx2 --shader wgsl
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
    /// Directional albedo of cloth: Charlie's distribution, which sheen layers scale by
    Cloth(ClothOptions),
    /// Albedos of rough metals and dielectrics, by which energy compensation restores lost light
    Energy(EnergyOptions),
    /// Colour that an interface reflects under a thin film
    Film(FilmOptions),
    /// Fresnel's reflectance of any material over angle, n and k
    Fresnel(FresnelOptions),
    /// Linearly transformed cosines of a rough metal: light of polygons, in closed form
    Ltc(LtcOptions),
    /// Linearly transformed cosines of a layer of fibres, which reflects as sheen does
    Sheen(SheenOptions),
}

#[derive(Debug, Args)]
#[command(after_help = DFG_EXAMPLES, group(ArgGroup::new("aim").required(true).args(["preset", "max_abs"])))]
pub(crate) struct DfgOptions {
    /// The engine whose layout the table has
    #[arg(long, value_name = "NAME", value_parser = preset())]
    pub(crate) preset: Option<&'static Preset>,
    /// Another size than the engine's own table has: three.js, Babylon.js, Bevy and the glTF Sample Viewer read any
    #[arg(long, value_name = "WxH", value_parser = size, requires = "preset")]
    pub(crate) size: Option<[u32; 2]>,
    /// Find the smallest table whose reads err by this at most, absolutely
    #[arg(long, value_name = "X", value_parser = super::positive, allow_hyphen_values = true)]
    pub(crate) max_abs: Option<f64>,
    /// Most bytes of texels: where no table alone fits, the smallest beside a closed form that its look-up computes. The output is KTX2 or, ending in .bin, texels of two bytes
    #[arg(long, value_name = "N", requires = "max_abs", conflicts_with = "closed")]
    pub(crate) max_bytes: Option<usize>,
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
    /// A closed form in place of a table: the shader function itself, in the language of the ending of --output (.wgsl, .450.glsl, .es300.glsl, .hlsl, .metal, .spv)
    #[arg(long, requires = "max_abs")]
    pub(crate) closed: bool,
    /// Write the look-up function too, beside the table, in these languages
    #[arg(long, value_name = "LANGUAGE,...", value_delimiter = ',', value_parser = super::named::<Target>(Target::NAMES))]
    pub(crate) shader: Vec<Target>,
    /// Bind group of the look-up, and the numbers of the texture and the sampler
    #[arg(long, value_name = "GROUP,TEXTURE,SAMPLER", value_parser = numbers, requires = "shader", default_value = "0,0,1")]
    pub(crate) bind: [u32; 3],
    /// A table of another maker in the layout of the preset, whose errors the report shows beside
    #[arg(long, value_name = "FILE", requires = "preset", requires = "report")]
    pub(crate) beside: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) delivery: Delivery,
}

const CLOTH_EXAMPLES: &str = "\
Bakes the directional albedo of Charlie's distribution (Estevez and Kulla 2017) by quadrature, into KTX2 of half floats. The page and \
the error are over cosines from --min-cos and alphas from --min-alpha.

Examples:
  luthier table cloth --size 64x64 -o cloth.ktx2
  luthier table cloth --visibility estevez-kulla --axes cos_theta^2,roughness --nodes ends --size 32x32 -o sheen.ktx2";

#[derive(Debug, Args)]
#[command(after_help = CLOTH_EXAMPLES)]
pub(crate) struct ClothOptions {
    /// Visibility term
    #[arg(long, value_enum, default_value_t = ClothName::Neubelt)]
    pub(crate) visibility: ClothName,
    #[command(flatten)]
    pub(crate) grid: Grid,
    #[command(flatten)]
    pub(crate) domain: Domain,
    #[command(flatten)]
    pub(crate) delivery: Delivery,
}

/// Visibility terms of cloth.
#[derive(Debug, Clone, Copy, ValueEnum)]
pub(crate) enum ClothName {
    /// 1 / (4 (l + v - l v)) of Ashikhmin and Neubelt: Filament, Godot, Babylon.js, glTF's own
    Neubelt,
    /// Smith's masking with Lambda as Estevez and Kulla fitted it
    EstevezKulla,
}

const ENERGY_EXAMPLES: &str = "\
Bakes the albedo E of rough surfaces after one facet, by quadrature from either side. Kulla and Conty 2017 need E and its average, which \
is the table without the axis of the direction; Turquin 2019 needs the value `compensation`, (1 - E)/E. Slices of a third axis lie one \
below the other. With --preset all tables of a renderer are written into the folder --output. Other files are KTX2 of half floats, or EXR \
of floats where the name ends in .exr.

Examples:
  luthier table energy --preset cycles -o tables
  luthier table energy -o metal.ktx2
  luthier table energy --values loss --max-abs 1e-3 -o metal.ktx2
  luthier table energy --axes roughness --size 32x1 -o metal-average.ktx2
  luthier table energy --values compensation -o turquin.ktx2
  luthier table energy --surface from-denser --axes cos_theta,roughness,sqrt_f0 --size 32x32x16 -o glass-inside.exr";

#[derive(Debug, Args)]
#[command(after_help = ENERGY_EXAMPLES)]
pub(crate) struct EnergyOptions {
    /// The renderer whose tables are baked
    #[arg(long, value_name = "NAME", value_parser = energy_preset(), conflicts_with_all = ["surface", "values", "axes", "size", "nodes", "distribution", "masking", "report"])]
    pub(crate) preset: Option<&'static EnergyPreset>,
    /// Find the smallest table of a metal whose reads err by this at most, absolutely
    #[arg(long, value_name = "X", value_parser = super::positive, conflicts_with_all = ["preset", "axes", "size", "nodes"])]
    pub(crate) max_abs: Option<f64>,
    /// Facets that reflect everything, or an interface between transparent media and the side that light comes from: reflector, from-rarer or from-denser
    #[arg(long, value_name = "NAME", default_value = "reflector")]
    pub(crate) surface: String,
    /// Contents of the channels: albedo, loss, compensation, reflected, unreflected, transmitted
    #[arg(long, value_name = "NAME,...", value_delimiter = ',', default_value = "albedo")]
    pub(crate) values: Vec<String>,
    /// Axes, the fastest first: roughness or alpha, cos_theta unless the average is wanted, and ior, f0, sqrt_f0 or fourth_root_f0 where the surface has an index
    #[arg(long, value_name = "AXIS,...", default_value = "cos_theta,roughness")]
    pub(crate) axes: String,
    /// Nodes along each axis
    #[arg(long, value_name = "WxH[xD]", default_value = "32x32", value_parser = size3)]
    pub(crate) size: [u32; 3],
    /// Where nodes are
    #[arg(long, value_enum, default_value_t = NodesName::Ends)]
    pub(crate) nodes: NodesName,
    /// Slope distribution
    #[arg(long, value_enum, default_value_t = DistributionName::Ggx)]
    pub(crate) distribution: DistributionName,
    /// Smith's masking of both directions: correlated or separable
    #[arg(long, value_name = "NAME", default_value = "correlated")]
    pub(crate) masking: String,
    #[command(flatten)]
    pub(crate) domain: Domain,
    #[command(flatten)]
    pub(crate) delivery: Delivery,
}

const FILM_EXAMPLES: &str = "\
Bakes the colour that a plane reflects under a thin film: the exact sum of all interference, over angle and thickness, as linear Rec.709 \
under D65. For a rough surface the cosine is that against the half vector. Indices are N or N,K.

Examples:
  luthier table film --film 1.33 --base 1.5 -o film.ktx2
  luthier table film --film 1.33 --base 1 --axes cos_theta,thickness_nm=100..1200 --size 32x128 -o soap.ktx2 --report soap.html
  luthier table film --film 2.4 --base 2.5,3.3 -o anodised.exr";

#[derive(Debug, Args)]
#[command(after_help = FILM_EXAMPLES)]
pub(crate) struct FilmOptions {
    /// Index of the film: N or N,K
    #[arg(long, value_name = "N[,K]", value_parser = index)]
    pub(crate) film: [f64; 2],
    /// Index below the film
    #[arg(long, value_name = "N[,K]", value_parser = index)]
    pub(crate) base: [f64; 2],
    /// Index above the film
    #[arg(long, value_name = "N", value_parser = super::positive, default_value_t = 1.0)]
    pub(crate) above: f64,
    /// Axes, the one across first: of the direction and of thickness_nm
    #[arg(long, value_name = "X,Y", default_value = "cos_theta,thickness_nm=0..1000")]
    pub(crate) axes: String,
    /// Texels across and down
    #[arg(long, value_name = "WxH", value_parser = size, default_value = "32x128")]
    pub(crate) size: [u32; 2],
    /// Where nodes are
    #[arg(long, value_enum, default_value_t = NodesName::Ends)]
    pub(crate) nodes: NodesName,
    /// Three wavelengths (680, 550, 440 nm) in place of spectra: no colour leaves 0..1
    #[arg(long)]
    pub(crate) three_wavelengths: bool,
    /// Lowest cosine that counts in the error
    #[arg(long, value_name = "X", default_value_t = 0.01, value_parser = unit)]
    pub(crate) min_cos: f64,
    #[command(flatten)]
    pub(crate) delivery: Delivery,
}

const FRESNEL_EXAMPLES: &str = "\
Bakes the reflectance of a smooth surface of index n + ik in air for unpolarised light, over three axes (Weidlich and Wilkie 2009, section 3.4.1). \
One table serves all materials. Slices of the third axis lie one below the other, so that the look-up reads twice for each channel. The default is the \
layout that the authors propose; the error says how far linear axes carry.

Examples:
  luthier table fresnel -o fresnel.ktx2 --shader wgsl
  luthier table fresnel --axes cos_theta,ior_n=0.05..5@log,ior_k=0..10^2 --size 64x64x64 -o fresnel.exr";

#[derive(Debug, Args)]
#[command(after_help = FRESNEL_EXAMPLES)]
pub(crate) struct FresnelOptions {
    /// Axes, the fastest first: of the direction, ior_n and ior_k
    #[arg(long, value_name = "X,Y,Z", default_value = "cos_theta,ior_n,ior_k")]
    pub(crate) axes: String,
    /// Nodes along each axis
    #[arg(long, value_name = "WxHxD", default_value = "128x32x32", value_parser = volume)]
    pub(crate) size: [u32; 3],
    /// Where nodes are
    #[arg(long, value_enum, default_value_t = NodesName::Ends)]
    pub(crate) nodes: NodesName,
    /// Lowest cosine that counts in the error
    #[arg(long, value_name = "X", default_value_t = 0.01, value_parser = unit)]
    pub(crate) min_cos: f64,
    /// Write the look-up function too, beside the table, in these languages
    #[arg(long, value_name = "LANGUAGE,...", value_delimiter = ',', value_parser = super::named::<Target>(Target::NAMES))]
    pub(crate) shader: Vec<Target>,
    /// Bind group of the look-up, and the numbers of the texture and the sampler
    #[arg(long, value_name = "GROUP,TEXTURE,SAMPLER", value_parser = numbers, requires = "shader", default_value = "0,0,1")]
    pub(crate) bind: [u32; 3],
    #[command(flatten)]
    pub(crate) delivery: Delivery,
}

const LTC_EXAMPLES: &str = "\
Fits linearly transformed cosines (Heitz, Dupuy, Hill and Neubelt 2016) and writes two tables into the folder --output: ltc_1.ktx2 has the inverse \
matrices (m11, m31, m13, m33 in the order that engines read), ltc_2.ktx2 the albedo, the bias of the split sum, 0 and the form factor of a sphere \
cut by the horizon. Roughness runs across, the square root of 1 - cos_theta down; nodes are at the ends. The error is half the L1 distance of the \
light that lobe and BRDF reflect, over the albedo. Takes half a minute of one core.

Examples:
  luthier table ltc -o ltc
  luthier table ltc --distribution beckmann -o ltc --no-zstd";

#[derive(Debug, Args)]
#[command(after_help = LTC_EXAMPLES)]
pub(crate) struct LtcOptions {
    /// Slope distribution
    #[arg(long, value_enum, default_value_t = DistributionName::Ggx)]
    pub(crate) distribution: DistributionName,
    /// Smith's masking: correlated or separable
    #[arg(long, value_name = "NAME", default_value = "correlated")]
    pub(crate) masking: String,
    #[command(flatten)]
    pub(crate) delivery: Delivery,
}

const SHEEN_EXAMPLES: &str = "\
Bakes the table of Zeltner, Burley and Chiang 2022: a layer of fibres by adding and doubling, and the linearly transformed cosine nearest to its \
reflection. Channels are a and b of the inverse matrix [a 0 b; 0 a 0; 0 0 1] and the albedo; 32 x 32 texels, the cosine across, the roughness down, \
nodes at the ends.

Examples:
  luthier table sheen -o sheen.ktx2
  luthier table sheen -o sheen.exr";

#[derive(Debug, Args)]
#[command(after_help = SHEEN_EXAMPLES)]
pub(crate) struct SheenOptions {
    #[command(flatten)]
    pub(crate) delivery: Delivery,
}

/// Axes and texels of a table over direction and roughness.
#[derive(Debug, Args)]
pub(crate) struct Grid {
    /// Axes, the one across first, in the words of `luthier audit --axes`
    #[arg(long, value_name = "X,Y", default_value = "cos_theta,roughness")]
    pub(crate) axes: String,
    /// Where nodes are
    #[arg(long, value_enum, default_value_t = NodesName::Centres)]
    pub(crate) nodes: NodesName,
    /// Texels across and down
    #[arg(long, value_name = "WxH", value_parser = size, default_value = "64x64")]
    pub(crate) size: [u32; 2],
}

/// Where errors count.
#[derive(Debug, Args)]
pub(crate) struct Domain {
    /// Lowest cosine that counts in the error
    #[arg(long, value_name = "X", default_value_t = 0.01, value_parser = unit)]
    pub(crate) min_cos: f64,
    /// Lowest alpha likewise
    #[arg(long, value_name = "X", default_value_t = 0.01, value_parser = unit)]
    pub(crate) min_alpha: f64,
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
    match text.split_once('x').map(|(width, height)| [width, height].map(str::parse::<u32>)) {
        Some([Ok(width @ 4..=1024), Ok(height @ 4..=1024)]) => Ok([width, height]),
        _ => Err("expected texels across and down, 4 to 1024 each, such as 64x64".to_owned()),
    }
}

/// Most rows of all slices together: what every device takes as a side of a texture.
const ROWS_MAX: u32 = 8192;

/// Nodes along three axes.
fn volume(text: &str) -> Result<[u32; 3], String> {
    let sides: Vec<u32> = text.split('x').map_while(|side| side.parse().ok()).collect();
    match *sides.as_slice() {
        [x, y, z] if text.split('x').count() == 3 && sides.iter().all(|side| (2..=1024).contains(side)) => {
            if y * z <= ROWS_MAX {
                Ok([x, y, z])
            } else {
                Err(format!("{y} x {z} rows lie one below the other, and a texture has {ROWS_MAX} at most"))
            }
        }
        _ => Err("expected nodes along three axes, 2 to 1024 each, such as 128x32x32".to_owned()),
    }
}

/// Nodes along one to three axes.
fn size3(text: &str) -> Result<[u32; 3], String> {
    let sides: Option<Vec<u32>> = text.split('x').map(|side| side.parse().ok()).collect();
    let mut size = [1; 3];
    match sides.as_deref() {
        Some(sides @ ([_] | [_, _] | [_, _, _])) if sides.iter().all(|side| (1..=1024).contains(side)) => {
            size[..sides.len()].copy_from_slice(sides);
            Ok(size)
        }
        _ => Err("expected nodes along each axis, 1 to 1024 each, such as 32x32 or 16x16x16".to_owned()),
    }
}

/// An index of refraction, n or n,k.
fn index(text: &str) -> Result<[f64; 2], String> {
    let numbers: Option<Vec<f64>> = text.split(',').map(|part| part.trim().parse().ok()).collect();
    let [n, k] = match numbers.as_deref() {
        Some([n]) => [*n, 0.0],
        Some([n, k]) => [*n, *k],
        _ => [0.0; 2],
    };
    let is_index = n > 0.0 && n <= 100.0 && (0.0..=100.0).contains(&k);
    if is_index {
        Ok([n, k])
    } else {
        Err("expected an index of refraction, N or N,K, such as 1.5 or 0.27,2.9".to_owned())
    }
}

/// Tables of energy by their name, one of those listed.
fn energy_preset() -> impl TypedValueParser<Value = &'static EnergyPreset> {
    let names = EnergyPreset::ALL.iter().map(|preset| preset.name);
    PossibleValuesParser::new(names).map(|name| EnergyPreset::named(&name).expect("only names of presets come here"))
}

/// Three numbers.
fn numbers(text: &str) -> Result<[u32; 3], String> {
    let numbers: Option<Vec<u32>> = text.split(',').map(|part| part.trim().parse().ok()).collect();
    let three = numbers.and_then(|numbers| <[u32; 3]>::try_from(numbers).ok());
    three.ok_or_else(|| "expected three numbers, such as 0,0,1".to_owned())
}
