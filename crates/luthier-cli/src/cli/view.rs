//! Options of the window.

use std::path::PathBuf;

use clap::{Args, ValueEnum};

use luthier_manifest::Form;

use luthier_terminal::{Sources, named};

use super::{Look, Shading, ShapeName, Side};

const VIEW_EXAMPLES: &str = "\
Drag turns the shape, a drag with the right button the light, the wheel zooms; H lists the keys. Files are read again when they
change; a broken one shows its mistake over the last good picture. Edits stay in the window; Ctrl+Shift+C copies the edited material
as TOML.

The window compares the picture with that of another model, of the other form, or of the simulation, which gathers paths of light as
long as nothing changes. A line that the mouse moves divides the two, or their difference is shown.

The full form has no blurred maps: it asks for the environment in 16 directions per sample, or --environment-samples if that
is more. Without a screen, put `xvfb-run -a` in front.

Examples:
  luthier view materials
  luthier view mine.toml --form full --shape torus
  luthier view mine.toml --against simulated --difference 16
  luthier view mine.toml --screenshot window.png --frames 3";

/// Open a window: turn, light and edit materials, and see them change with their files
#[derive(Debug, Args)]
#[command(after_help = VIEW_EXAMPLES)]
pub(crate) struct ViewOptions {
    #[command(flatten)]
    pub(crate) sources: Sources,
    #[command(flatten)]
    pub(crate) shading: Shading,
    /// Form of the shader: `baked` reads tables, `full` computes all terms
    #[arg(long, value_parser = named::<Form>(Form::NAMES), default_value_t = Form::Baked)]
    pub(crate) form: Form,
    /// Picture to compare with: simulated or simulated/N with N paths of each pixel, a model, a form, or MODEL/FORM
    #[arg(long, value_name = "SIDE")]
    pub(crate) against: Option<Side>,
    /// Show the difference of the two in linear light, times a factor
    #[arg(long, value_name = "FACTOR", requires = "against", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub(crate) difference: Option<u16>,
    /// Shape to show: sphere, torus, plane or model; by default the model, or the sphere beside a simulation
    #[arg(long, value_enum)]
    pub(crate) shape: Option<ShapeName>,
    /// Triangles to show instead: a glTF file
    #[arg(long, value_name = "FILE", conflicts_with = "shape")]
    pub(crate) mesh: Option<PathBuf>,
    /// Inner size of the window
    #[arg(long, value_name = "WIDTHxHEIGHT", default_value = "1120x760", value_parser = window_size)]
    pub(crate) window: WindowSize,
    /// Colours of the window; by default those of the desktop
    #[arg(long, value_enum)]
    pub(crate) theme: Option<ThemeName>,
    /// Write what the window shows once the picture is finished, and exit
    #[arg(long, value_name = "FILE")]
    pub(crate) screenshot: Option<PathBuf>,
    /// Frames to show before each screenshot
    #[arg(long, value_name = "N", default_value_t = 2, requires = "screenshot", value_parser = clap::value_parser!(u32).range(1..=10_000))]
    pub(crate) frames: u32,
    /// Screenshots to write before exiting: FILE, then one after each change on disk, numbered FILE-2, FILE-3 and so on
    #[arg(long, value_name = "N", default_value_t = 1, requires = "screenshot", value_parser = clap::value_parser!(u32).range(1..=1000))]
    pub(crate) shots: u32,
    #[command(flatten)]
    pub(crate) look: Look,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum ThemeName {
    Dark,
    Light,
}

/// Width and height in points.
#[derive(Debug, Clone, Copy)]
pub(crate) struct WindowSize(pub(crate) [u16; 2]);

fn window_size(text: &str) -> Result<WindowSize, String> {
    let sides = text.split_once('x').and_then(|(w, h)| Some([w.parse().ok()?, h.parse().ok()?]));
    match sides {
        Some([w, h]) if (560..=8192).contains(&w) && (360..=8192).contains(&h) => Ok(WindowSize([w, h])),
        _ => Err("expected width and height from 560x360 to 8192x8192, such as 1120x760".to_owned()),
    }
}
