//! Interface to the program around the window: files, bakes, screenshots.

use luthier_gpu::Package;
use luthier_manifest::Form;
use luthier_material::Material;

/// Services that the window asks of the program around it. Called from several threads.
pub trait Host: Send + Sync {
    /// Returns all material files if one of them, or a file that they name, changed since the last call. The first call always does.
    fn changed(&self) -> Option<Vec<MaterialFile>>;

    /// The package that the renderer needs for one material in one form.
    ///
    /// # Errors
    /// A message for people.
    fn bake(&self, material: &Material, form: Form) -> Result<Package, String>;

    /// Writes a screenshot. `number` counts from 1; `asked` says that it is one of those that the command line asks for, not
    /// one that somebody took by hand. Gives the path.
    ///
    /// # Errors
    /// A message for people.
    fn save(&self, screenshot: &Screenshot, number: u32, asked: bool) -> Result<String, String>;
}

/// A material file as it is now.
#[derive(Debug, Clone, PartialEq)]
pub struct MaterialFile {
    /// The file, as messages name it.
    pub label: String,
    /// The material; or what is wrong with it, with file, line and hint.
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
