use luthier_optics::stack::Stack;

use crate::bake_settings::{BakeSettings, BudgetSettings};
use crate::class::SurfaceClass;
use crate::effects::Effects;

/// A validated material.
#[derive(Debug, Clone, PartialEq)]
pub struct Material {
    /// Name: letters, digits and hyphens.
    pub name: String,
    /// Label of the file that it was read from.
    pub source: String,
    /// Text of that file.
    pub text: String,
    /// The files that it names, by their paths relative to itself: indices and images, each once, sorted.
    pub files: Vec<String>,
    /// One or two sentences; empty when the file has none.
    pub description: String,
    /// Sources of the numbers.
    pub references: Vec<String>,
    /// The physics: interfaces from the top down.
    pub stack: Stack,
    /// What each layer has beyond physics; parallel to `stack.layers`.
    pub layers: Vec<LayerExtras>,
    /// Effects on top of the layered model.
    pub effects: Effects,
    /// What the file asks of its tables.
    pub bake: BakeSettings,
    /// What its tables may err, weigh and cost.
    pub budget: BudgetSettings,
    /// Class of the surface.
    pub class: SurfaceClass,
}

/// What a layer has beyond its physics.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct LayerExtras {
    /// How the thickness of the top film varies over the surface.
    pub film_variation: Option<FilmVariation>,
    /// Texture slots.
    pub maps: Maps,
}

/// Paths of the textures that modulate a layer, relative to the material file.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Maps {
    /// Tangent-space normal map.
    pub normal: Option<String>,
    /// Multiplies the layer's roughness.
    pub roughness: Option<String>,
    /// Multiplies the slab's thickness.
    pub thickness: Option<String>,
}

impl LayerExtras {
    /// The images that it names.
    pub(crate) fn images(&self) -> impl Iterator<Item = &str> {
        let Maps { normal, roughness, thickness } = &self.maps;
        let film = self.film_variation.as_ref().and_then(|variation| variation.source.image());
        [normal, roughness, thickness].into_iter().flatten().map(String::as_str).chain(film)
    }
}

/// How the thickness of a film varies between its extremes.
#[derive(Debug, Clone, PartialEq)]
pub struct FilmVariation {
    /// Where the variation comes from; 0 is the thinnest, 1 the thickest.
    pub source: VariationSource,
    /// Width of one repeat of the map on the surface.
    pub extent_um: f64,
}

/// A scalar map with values in 0..=1.
#[derive(Debug, Clone, PartialEq)]
pub enum VariationSource {
    /// Fractal gradient noise that repeats.
    Noise {
        /// Seed.
        seed: u32,
        /// Lattice cells of the first octave along one repeat.
        frequency: f64,
        /// Octaves, each of twice the frequency and half the weight.
        octaves: u32,
    },
    /// An image; its red channel is read as linear.
    Image {
        /// Path relative to the material file.
        path: String,
    },
}

impl VariationSource {
    /// The image that it names, if it is one.
    pub(crate) fn image(&self) -> Option<&str> {
        match self {
            Self::Image { path } => Some(path),
            Self::Noise { .. } => None,
        }
    }
}
