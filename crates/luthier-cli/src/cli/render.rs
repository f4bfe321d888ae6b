//! Options of the verbs that make pictures.

use std::fmt;
use std::path::PathBuf;
use std::str::FromStr;

use clap::{ArgAction, Args, ValueEnum};
use luthier_gpu::{Scenery, Shape, ToneMapping};
use luthier_lut::UnknownName;
use luthier_manifest::{Form, ShadingModel};

use luthier_terminal::named;

use super::Shading;
use crate::variations::Range;

const PREVIEW_EXAMPLES: &str = "\
MATERIAL is a material file or a surface file, or the name of either in the bake. Directions and positions have +y up and +z to the eye;
the shapes are about 1 in radius. The grid takes no material: it is of `metallic-roughness` surfaces in the colour of copper.

`model` and --mesh shade themselves: they hide lights from each of their places, and light from all around by what they hide of it from there (of
smooth materials, by what their mirrored rays meet). Sphere, torus, plane and grid shade nothing, not themselves either. On a software adapter the
file has a first picture, by one sample of each pixel, until the whole is done.

Examples:
  luthier preview materials/red-lacquer.toml -o ball.png
  luthier preview red-lacquer -o ball.png --size 1024
  luthier preview materials/car-paint.toml -o ring.png --shape torus --environment studio.hdr
  luthier preview materials/surfaces/sunstone.toml -o stone.png
  luthier preview materials/papers/yamaguchi-brushed.toml -o ball.png --simulated 256
  luthier preview materials/polished-gold.toml -o gold.png --sky evening-room --background
  luthier preview materials/soap-film.toml -o cat.png --mesh cat.glb
  luthier preview materials/latex.toml -o low.png --camera 3,0.5,6 --light-color 3,2.4,1.6
  luthier preview --shape grid -o grid.png";

/// How pictures are lit, sampled and written.
#[derive(Debug, Args)]
pub(crate) struct Look {
    /// Samples along each side of a pixel
    #[arg(long, value_name = "N", default_value_t = 4, value_parser = clap::value_parser!(u32).range(1..=16))]
    pub(crate) samples: u32,
    /// Exposure in stops
    #[arg(long, value_name = "EV", default_value_t = 0.0, value_parser = stops, allow_hyphen_values = true)]
    pub(crate) exposure: f32,
    /// Tone curve of PNG files; EXR files are linear without one
    #[arg(long, value_enum, default_value_t = ToneName::Shoulder)]
    pub(crate) tone: ToneName,
    /// Light from all around: an equirectangular EXR or Radiance HDR file, up is its top. By default a built-in studio
    #[arg(long, value_name = "FILE", conflicts_with = "sky")]
    pub(crate) environment: Option<PathBuf>,
    /// Light from all around that luthier makes
    #[arg(long, value_name = "NAME", value_parser = named::<Scenery>(Scenery::NAMES))]
    pub(crate) sky: Option<Scenery>,
    /// Directions per sample and lobe in which the shader is asked for the environment; 0, the default, reads blurred maps and tables
    /// of albedos instead. Of a bake without these tables (`bake --tables fresnel,fgd,film` makes them) 64 is the default
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(0..=4096))]
    pub(crate) environment_samples: Option<u32>,
    /// Show the environment behind
    #[arg(long)]
    pub(crate) background: bool,
    /// A light from this direction. With this, --point-light, --environment or --sky there is no default light
    #[arg(long, value_name = "X,Y,Z", value_parser = triple, allow_hyphen_values = true)]
    pub(crate) light: Vec<Triple>,
    /// A light at this position, as bright at the centre as --light
    #[arg(long, value_name = "X,Y,Z", value_parser = triple, allow_hyphen_values = true)]
    pub(crate) point_light: Vec<Triple>,
    /// Irradiance of the lights on a surface that faces them, linear RGB; that of a light at a position is this at the centre
    #[arg(long, value_name = "R,G,B", default_value = "1.75,1.70,1.62", value_parser = color)]
    pub(crate) light_color: Triple,
    /// Position of the eye, which looks at the centre; +y is up in the picture, and what it shows at the centre stays as large. By default each shape
    /// has its own, 7 away (the grid 16): from the front, or from above where a shape lies flat
    #[arg(long, value_name = "X,Y,Z", value_parser = eye, allow_hyphen_values = true)]
    pub(crate) camera: Option<Triple>,
    /// Use the graphics adapter whose name contains this
    #[arg(long, value_name = "NAME")]
    pub(crate) adapter: Option<String>,
}

#[derive(Debug, Args)]
#[command(after_help = PREVIEW_EXAMPLES)]
pub(crate) struct PreviewOptions {
    /// A material file or a surface file, or the name of either in the bake; or a glTF file, whose parts show their own materials as `import` reads them
    #[arg(value_name = "MATERIAL")]
    pub(crate) material: Option<String>,
    #[command(flatten)]
    pub(crate) shading: Shading,
    /// Picture to write: .png or .exr
    #[arg(long, short, value_name = "FILE")]
    pub(crate) output: PathBuf,
    /// Folder of the bake, for materials by name
    #[arg(long, value_name = "DIR", default_value = "out")]
    pub(crate) out: PathBuf,
    /// Shape to render; by default `model`, and `sphere` with --simulated, which knows no triangles
    #[arg(long, value_enum)]
    pub(crate) shape: Option<ShapeName>,
    /// Triangles to render instead: a glTF file. Parts whose glTF material is named `plain` keep its colour
    #[arg(long, value_name = "FILE", conflicts_with = "shape")]
    pub(crate) mesh: Option<PathBuf>,
    /// Side of the picture in pixels
    #[arg(long, value_name = "PIXELS", default_value_t = 512, value_parser = clap::value_parser!(u32).range(1..=4096))]
    pub(crate) size: u32,
    /// Simulate light in the stack on the graphics adapter, with so many samples of each pixel, in place of a model: no fit, no tables. It takes
    /// no films, maps, flakes, patina, glitter and re-radiation. Multiples of the square of --samples cover pixels evenly
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=1 << 20), conflicts_with_all = ["model", "no_fit", "fresnel", "tables", "environment_samples", "mesh"])]
    pub(crate) simulated: Option<u32>,
    #[command(flatten)]
    pub(crate) look: Look,
}

/// A contact sheet: a picture of many.
#[derive(Debug, Args)]
pub(crate) struct SheetOptions {
    /// Shape to render: sphere, torus, plane or model
    #[arg(long, value_enum, default_value_t = ShapeName::Sphere)]
    pub(crate) shape: ShapeName,
    /// Triangles to render instead: a glTF file
    #[arg(long, value_name = "FILE", conflicts_with = "shape")]
    pub(crate) mesh: Option<PathBuf>,
    /// Side of each picture in pixels
    #[arg(long, value_name = "PIXELS", default_value_t = 160, value_parser = clap::value_parser!(u32).range(16..=1024))]
    pub(crate) size: u32,
    /// Pictures in a row; by default about as many as rows
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=64))]
    pub(crate) columns: Option<u32>,
    /// One file with other numbers at two keys: the first grows along the rows, the second down the columns. A key with dots leads from the top of
    /// the file, as in layer.1.albedo.0, and counts from 0; one without is that of the topmost layer that has it
    #[arg(long, action = ArgAction::Set, num_args = 2, value_names = ["KEY=FROM..TO", "KEY=FROM..TO"], conflicts_with = "columns")]
    pub(crate) grid: Vec<Range>,
    /// Numbers of each key of the grid
    #[arg(long, value_name = "N", default_value_t = 5, requires = "grid", value_parser = clap::value_parser!(u32).range(2..=16))]
    pub(crate) steps: u32,
    #[command(flatten)]
    pub(crate) look: Look,
}

const COMPARE_EXAMPLES: &str = "\
Writes a.png, b.png, difference.png (absolute, of what a display shows, brightened as printed) and flip.png (0 black, 1 white)
into a folder. RMSE is of linear radiance over all pixels and channels; FLIP is of the displayed pictures at 67 pixels per
degree. The environment goes through both shaders in 64 directions for each lobe, drawn by each with the same random numbers, unless told otherwise.
`simulated` in place of a shader is what `luthier preview --simulated` shows, and simulated/N that with N samples of each pixel (256 by default).
The noise of its samples is part of the RMSE; it is printed beside it.

Examples:
  luthier compare materials/papers/car-paint.toml --a baked --b full -o comparison
  luthier compare materials/car-paint.toml --a elek --b microfacet/full -o comparison
  luthier compare materials/papers/yamaguchi-brushed.toml --a yamaguchi --b simulated/512 -o seen
  luthier compare red-lacquer --b full -o comparison --json";

#[derive(Debug, Args)]
#[command(after_help = COMPARE_EXAMPLES)]
pub(crate) struct CompareOptions {
    /// A material file, or the name of a material in the bake
    #[arg(value_name = "MATERIAL")]
    pub(crate) material: String,
    /// The first shader: a form as the manifest names it, a model, both as MODEL/FORM, or `simulated`
    #[arg(long, value_name = "SHADER", default_value = "baked")]
    pub(crate) a: Side,
    /// The second shader
    #[arg(long, value_name = "SHADER", default_value = "full")]
    pub(crate) b: Side,
    /// Simulate nothing: a file that asks for no model takes a closed form, which it does as well where a form is `full`
    #[arg(long)]
    pub(crate) no_fit: bool,
    /// Folder to write to
    #[arg(long, short, value_name = "DIR")]
    pub(crate) output: PathBuf,
    /// Folder of the bake, for materials by name
    #[arg(long, value_name = "DIR", default_value = "out")]
    pub(crate) out: PathBuf,
    /// Shape to render: sphere, torus, plane or model
    #[arg(long, value_enum, default_value_t = ShapeName::Sphere)]
    pub(crate) shape: ShapeName,
    /// Triangles to render instead: a glTF file
    #[arg(long, value_name = "FILE", conflicts_with = "shape")]
    pub(crate) mesh: Option<PathBuf>,
    /// Side of the pictures in pixels
    #[arg(long, value_name = "PIXELS", default_value_t = 256, value_parser = clap::value_parser!(u32).range(1..=4096))]
    pub(crate) size: u32,
    /// Print the result as JSON
    #[arg(long)]
    pub(crate) json: bool,
    #[command(flatten)]
    pub(crate) look: Look,
}

/// One side of a comparison.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) enum Side {
    Shader(ShaderChoice),
    /// The simulation on the device, with so many samples of each pixel.
    Simulated(u32),
}

/// Samples of a simulated pixel where none are asked for.
const SIMULATED_SAMPLES: u32 = 256;

impl Side {
    /// The shader, if it is one.
    pub(crate) fn shader(&self) -> Option<&ShaderChoice> {
        if let Self::Shader(choice) = self { Some(choice) } else { None }
    }
}

impl FromStr for Side {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let Some(rest) = text.strip_prefix("simulated") else { return Ok(Self::Shader(text.parse()?)) };
        let samples = match rest.strip_prefix('/') {
            None if rest.is_empty() => Some(SIMULATED_SAMPLES),
            number => number.and_then(|n| n.parse().ok()).filter(|samples| (1..=1 << 20).contains(samples)),
        };
        samples
            .map(Self::Simulated)
            .ok_or_else(|| "expected simulated, or simulated/N with 1 to 1048576 samples".to_owned())
    }
}

impl fmt::Display for Side {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Shader(choice) => choice.fmt(f),
            Self::Simulated(samples) => write!(f, "simulated/{samples}"),
        }
    }
}

/// A shader to compare: what is left out is the material's model, or the baked form.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct ShaderChoice {
    pub(crate) model: Option<ShadingModel>,
    pub(crate) form: Form,
}

impl FromStr for ShaderChoice {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        if let Some(model) = ShadingModel::from_name(text) {
            return Ok(Self { model: Some(model), form: Form::Baked });
        }
        let Some((name, form)) = text.split_once('/') else {
            return Ok(Self { model: None, form: form(text)? });
        };
        match ShadingModel::from_name(name) {
            Some(model) => Ok(Self { model: Some(model), form: self::form(form)? }),
            None => Err(format!("no model `{name}`; known: {}", ShadingModel::NAMES.join(", "))),
        }
    }
}

fn form(name: &str) -> Result<Form, String> {
    name.parse().map_err(|unknown: UnknownName| unknown.to_string())
}

impl fmt::Display for ShaderChoice {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.model {
            Some(model) => write!(f, "{model}/{}", self.form),
            None => f.write_str(self.form.name()),
        }
    }
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum ShapeName {
    Sphere,
    Torus,
    Plane,
    /// Five by five spheres, metallic against roughness
    Grid,
    /// A ball with a cut on a stand, over a floor
    Model,
}

impl From<ShapeName> for Shape {
    fn from(name: ShapeName) -> Self {
        match name {
            ShapeName::Sphere => Self::Sphere,
            ShapeName::Torus => Self::Torus,
            ShapeName::Plane => Self::Plane,
            ShapeName::Grid => Self::Grid,
            ShapeName::Model => Self::Mesh,
        }
    }
}

#[derive(Debug, Clone, Copy, ValueEnum)]
pub(crate) enum ToneName {
    /// Clipped at 1
    None,
    /// Unchanged to 0.8, then bent towards 1
    Shoulder,
    /// x / (1 + x)
    Reinhard,
    /// Narkowicz's fit to the ACES film curve
    Aces,
}

impl From<ToneName> for ToneMapping {
    fn from(name: ToneName) -> Self {
        match name {
            ToneName::None => Self::None,
            ToneName::Shoulder => Self::Shoulder,
            ToneName::Reinhard => Self::Reinhard,
            ToneName::Aces => Self::Aces,
        }
    }
}

/// Three numbers.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Triple(pub(crate) [f32; 3]);

fn triple(text: &str) -> Result<Triple, String> {
    let numbers: Option<Vec<f32>> = text.split(',').map(|part| part.trim().parse().ok()).collect();
    match numbers.as_deref() {
        Some(&[x, y, z]) if [x, y, z].iter().all(|v| v.is_finite()) && [x, y, z] != [0.0; 3] => Ok(Triple([x, y, z])),
        _ => Err("expected three numbers that are not all 0, such as 1,2,3".to_owned()),
    }
}

fn eye(text: &str) -> Result<Triple, String> {
    match triple(text)? {
        Triple([x, _, z]) if libm::hypotf(x, z) < 1e-6 => {
            Err("expected an eye that is neither above nor below the centre, such as 0,2,7".to_owned())
        }
        eye => Ok(eye),
    }
}

fn color(text: &str) -> Result<Triple, String> {
    match triple(text) {
        Ok(Triple(rgb)) if rgb.iter().all(|v| *v >= 0.0) => Ok(Triple(rgb)),
        _ => Err("expected three numbers that are not negative and not all 0, such as 1.75,1.70,1.62".to_owned()),
    }
}

fn stops(text: &str) -> Result<f32, String> {
    match text.parse::<f32>() {
        Ok(value) if value.abs() <= 20.0 => Ok(value),
        _ => Err("expected stops from -20 to 20".to_owned()),
    }
}
