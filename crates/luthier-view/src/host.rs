//! Interface to the program around the window: files, bakes, screenshots.

use luthier_gpu::{Package, ToneMapping};
use luthier_lut::Image;
use luthier_manifest::Form;
use luthier_material::Material;

/// Services that the program around the window provides. Several threads call them.
pub trait Host: Send + Sync {
    /// Returns all material files if one of them, or a file that they name, changed since the last call, and rested for a call. The first call always does.
    fn changed(&self) -> Option<Vec<MaterialFile>>;

    /// The package that the renderer needs for one material in one form.
    ///
    /// # Errors
    /// A message for people.
    fn bake(&self, material: &Material, form: Form) -> Result<Package, String>;

    /// The package with the layers of one material, for the simulation on the device.
    ///
    /// # Errors
    /// A message for people: the parts of the material that the simulation does not take.
    fn simulated(&self, material: &Material) -> Result<Package, String>;

    /// The material that a file of this label would hold with another text.
    ///
    /// # Errors
    /// A message for people.
    fn parsed(&self, label: &str, text: &str) -> Result<Material, String>;

    /// Distance of two linear RGB pictures of one size; FLIP sees them behind the tone curve. `None` if they cannot be compared.
    fn compare(&self, a: &Image, b: &Image, tone: ToneMapping) -> Option<Differences>;

    /// Writes a screenshot and returns its path. `number` counts from 1. `asked` is true if the command line asks for it, false if a user took it.
    ///
    /// # Errors
    /// A message for people.
    fn save(&self, screenshot: &Screenshot, number: u32, asked: bool) -> Result<String, String>;
}

/// Distance of two pictures.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Differences {
    /// Root of the mean squared difference over all pixels and channels, in linear radiance.
    pub rms_err: f64,
    /// Mean of the FLIP map, 0 to 1.
    pub flip_mean: f64,
}

/// A material file as it is now.
#[derive(Debug, Clone, PartialEq)]
pub struct MaterialFile {
    /// The file, as messages name it.
    pub label: String,
    /// The material; or its faults, with file, line and hint.
    pub material: Result<Material, String>,
    /// Another number when a file that the material names changed.
    pub revision: u64,
}

/// Contents of a window.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Screenshot {
    /// Pixels across.
    pub width: u32,
    /// Pixels down.
    pub height: u32,
    /// sRGB, three bytes per pixel, row by row from the top.
    pub rgb8: Vec<u8>,
}
