//! Materials of a page, as its maker describes them.

use luthier_lut::Image;
use luthier_manifest::Form;
use luthier_material::CrossSection;

/// A material in a page.
#[derive(Debug, Clone)]
pub struct Exhibit {
    /// Name, which is its address in the page.
    pub name: String,
    /// A sentence about it; may be empty.
    pub description: String,
    /// Text of its file, if available; else the page shows the file's name from the manifest.
    pub text: Option<String>,
    /// The cross-section to draw, of a material or of the records of a bake (`CrossSection::recorded`).
    pub section: Option<CrossSection>,
    /// The looks that can be compared; the first one is shown.
    pub looks: Vec<Look>,
    /// A picture by simulation to compare them with.
    pub simulated: Option<Simulated>,
}

/// A material of a package.
#[derive(Debug, Clone)]
pub struct Look {
    /// Number of the package in the gallery.
    pub package: usize,
    /// Number of the material in the package.
    pub material: u32,
    /// Cycles of its shader, by form, in words such as `150 cycles (rdna2)`.
    pub cycles: Vec<(Form, String)>,
}

/// A picture by simulation: the ball of luthier-gpu's pictures, with their camera, light and studio.
#[derive(Debug, Clone)]
pub struct Simulated {
    /// Linear RGB, square.
    pub image: Image,
    /// Samples of a pixel.
    pub samples: u32,
}

impl Exhibit {
    /// A material with looks and nothing else.
    pub fn new(name: &str, looks: Vec<Look>) -> Self {
        Self { name: name.to_owned(), description: String::new(), text: None, section: None, looks, simulated: None }
    }
}

impl Look {
    /// A material of a package, by their numbers.
    pub fn new(package: usize, material: u32) -> Self {
        Self { package, material, cycles: Vec::new() }
    }
}
