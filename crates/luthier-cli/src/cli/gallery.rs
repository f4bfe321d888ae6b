//! Options of `gallery`.

use std::path::PathBuf;

use clap::{ArgGroup, Args};
use luthier_manifest::ShadingModel;
use luthier_terminal::{Sources, named};

use super::Shading;
#[cfg(feature = "gpu")]
use super::render::SheetOptions;

/// Examples of builds that draw nothing themselves.
#[cfg(not(feature = "gpu"))]
const EXAMPLES: &str = "\
The page needs no program and no network: it draws in any browser with WebGL 2. PATH may be the folder of a bake, too.

Examples:
  luthier gallery --html gallery.html
  luthier gallery --html gallery.html out
  luthier gallery --html gallery.html materials --compare elek,microfacet";

#[cfg(feature = "gpu")]
const EXAMPLES: &str = "\
The page needs no program and no network: it draws in any browser with WebGL 2. PATH may then be the folder of a bake, too.

PATH may be a glTF file: the sheet shows all of it by glTF's formula, by its models, simulated, and the simulation less the models, brightened about \
grey. All four are computed in f64 without an adapter, with the textures of the file, under the surroundings alone, whose shadows are those of the mesh; \
normals of single layers, below a coat, and light from one place of the mesh to another are left out.

Examples:
  luthier gallery -o sheet.png
  luthier gallery car.glb -o ways.png --size 256
  luthier gallery materials mine.toml -o sheet.png --columns 6
  luthier gallery lacquer.toml -o grid.png --grid roughness=0.1..1 layer.1.albedo.0=0.1..0.9
  luthier gallery copper.toml -o grid.png --grid roughness=0..1 metallic=0..1
  luthier gallery --html gallery.html
  luthier gallery --html gallery.html out
  luthier gallery --html gallery.html materials --compare elek,microfacet --simulated 256";

/// Options that a page has no use for.
#[cfg(feature = "gpu")]
const OF_SHEETS: [&str; 16] = [
    "shape",
    "mesh",
    "size",
    "columns",
    "grid",
    "steps",
    "samples",
    "exposure",
    "tone",
    "environment",
    "sky",
    "environment_samples",
    "background",
    "light",
    "light_color",
    "camera",
];

#[derive(Debug, Args)]
#[command(after_help = EXAMPLES, group = ArgGroup::new("to").required(true).args(TO))]
pub(crate) struct GalleryOptions {
    #[command(flatten)]
    pub(crate) sources: Sources,
    #[command(flatten)]
    pub(crate) shading: Shading,
    /// Picture to write: .png or .exr
    #[cfg(feature = "gpu")]
    #[arg(long, short, value_name = "FILE")]
    pub(crate) output: Option<PathBuf>,
    /// Page to write: one HTML file with all materials, to look at and to compare in a browser
    #[arg(long, value_name = "FILE")]
    #[cfg_attr(feature = "gpu", arg(conflicts_with_all = OF_SHEETS, conflicts_with = "point_light"))]
    pub(crate) html: Option<PathBuf>,
    /// Models beside that of each material, to compare in the page. By default `belcour`, and `elek` for materials of that
    #[arg(long, value_name = "NAME,...", value_delimiter = ',', requires = "html", value_parser = named::<ShadingModel>(ShadingModel::NAMES))]
    pub(crate) compare: Vec<ShadingModel>,
    /// Simulate a picture of every material for the page on the graphics adapter, with so many samples of each pixel; of a glTF file, so many paths in place of 256
    #[cfg(feature = "gpu")]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=1 << 20))]
    pub(crate) simulated: Option<u32>,
    #[cfg(feature = "gpu")]
    #[command(flatten)]
    pub(crate) sheet: SheetOptions,
}

/// Files that are written, of which one is asked for.
#[cfg(feature = "gpu")]
const TO: [&str; 2] = ["output", "html"];
#[cfg(not(feature = "gpu"))]
const TO: [&str; 1] = ["html"];
