//! Effects of a material: glitter, flakes, patina.

use luthier_optics::Rgb;

use crate::picture::{PictureRef, VariationSource};

/// Effects that modify the layered model.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Effects {
    /// Glints of flakes in the coat.
    pub flakes: Option<Flakes>,
    /// Growth of the first layer over the rest.
    pub patina: Option<Patina>,
    /// Particles of the surface that are tilted.
    pub glitter: Option<Glitter>,
}

/// Glitter: a share of the Voronoi cells of the surface, each tilted its own way (Weidlich and Wilkie 2009, section 5.2.1).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Glitter {
    /// Seed of the cells.
    pub seed: u32,
    /// Cells per unit of texture coordinate.
    pub frequency: f64,
    /// Share of the cells that glitter, 0..=1.
    pub filled: f64,
    /// Largest tilt, in radians.
    pub tilt: f64,
}

/// Metal flakes: normals that are perturbed below the first interface only (Elek 2010, section 4.1).
#[derive(Debug, Clone, PartialEq)]
pub struct Flakes {
    /// Source of the normals.
    pub source: FlakeSource,
    /// Repeats of the map per unit of texture coordinate.
    pub tiling: f64,
    /// Weight of the flakes' normal against the surface's.
    pub scale: f64,
    /// Distance from the eye, in scene units, up to which the flakes keep their full weight.
    pub fade_start: f64,
}

/// Source of the normals of flakes.
#[derive(Debug, Clone, PartialEq)]
pub enum FlakeSource {
    /// A tangent-space normal map, sampled without filtering.
    NormalMap(PictureRef),
    /// Heights, which finite differences turn into normals.
    HeightMap {
        /// The picture.
        picture: PictureRef,
        /// Height of white above black, as a share of the width of the picture.
        height: f64,
    },
    /// One random normal per cell of a grid.
    Cells {
        /// Seed of the cells.
        seed: u32,
        /// Cells along one repeat.
        count: u32,
        /// Standard deviation of the flakes' slope angle, in radians.
        spread: f64,
    },
}

/// Patina: where the map says so, the first layer has grown over the others (Elek 2010, section 4.2).
///
/// The amount of patina is `clamp(1/2 + (extent - map) / (2 transition), 0, 1)`, a step at `transition = 0`; the model
/// is evaluated with and without the first layer, and blended by that amount.
#[derive(Debug, Clone, PartialEq)]
pub struct Patina {
    /// How far it has developed, in `-transition..=1 + transition`.
    pub extent: f64,
    /// Softness of the boundary, 0..=1.
    pub transition: f64,
    /// Order of development: dark places come first.
    pub map: VariationSource,
    /// Diffuse reflectance that stands for scattering in the patina.
    pub diffuse_albedo: Rgb,
    /// Slope parameter of the layer below where patina has grown; `None` leaves it alone.
    pub base_alpha: Option<f64>,
    /// Factor on the reflection of the layer below where patina has grown.
    pub tarnish: Rgb,
}
