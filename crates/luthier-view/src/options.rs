//! How the window opens.

use luthier_gpu::{RenderSettings, Shape, ToneMapping};
use luthier_manifest::{Form, ShadingModel};

use crate::comparison::Comparison;
use crate::shots::Shots;

/// Initial state of the window.
#[derive(Debug, Clone)]
pub struct Options {
    /// Light, environment, samples, exposure. Its size and camera do not count; environment samples of 0 become some in the
    /// full form.
    pub settings: RenderSettings,
    /// Name of the environment of the settings, where it is another than the default.
    pub environment_name: Option<&'static str>,
    /// Tone curve.
    pub tone: ToneMapping,
    /// Shape; the grid becomes a sphere, because a window shows one material.
    pub shape: Shape,
    /// Form.
    pub form: Form,
    /// Model; `None` is the model that each file asks for.
    pub model: Option<ShadingModel>,
    /// True where files that name no model may have one that is fitted to a simulation.
    pub fits: bool,
    /// The second picture.
    pub comparison: Comparison,
    /// Inner size of the window in points.
    pub size: [f32; 2],
    /// Dark theme; `None` follows the desktop, or else is dark.
    pub dark: Option<bool>,
    /// Screenshots to take without being asked again.
    pub shots: Option<Shots>,
}
