//! The validated material, with the places of its values in the file.

use luthier_optics::Rgb;
use luthier_optics::stack::Stack;

use luthier_manifest::{BeamsRecord, Budget, ShadingModel};

use crate::bake_settings::{BakeSettings, Beams};
use crate::class::SurfaceClass;
use crate::diagnostic::{Diagnostic, Severity, Sink};
use crate::effects::{Effects, FlakeSource};
use crate::places::Places;

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
    /// Properties of each layer beyond physics; parallel to `stack.layers`. Only the first has maps, and only a base re-radiates.
    pub layers: Vec<LayerExtras>,
    /// Effects on top of the layered model.
    pub effects: Effects,
    /// Settings that the file asks of its tables.
    pub bake: BakeSettings,
    /// Limits on the error, bytes and cost of its tables.
    pub budget: Budget,
    /// Class of the surface.
    pub class: SurfaceClass,
    /// Where its values stand in the text.
    pub places: Places,
}

/// An image that a material names.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct NamedImage<'m> {
    /// The key that names it, as in [`Places`].
    pub key: &'static str,
    /// Path relative to the material file.
    pub path: &'m str,
}

impl Material {
    /// A diagnostic about a value of the file, by someone who knows more than this crate; see [`Places`] for keys.
    pub fn diagnostic(
        &self,
        severity: Severity,
        key: &str,
        message: impl Into<String>,
        hint: Option<String>,
    ) -> Diagnostic {
        Sink::one(&self.source, &self.text, severity, self.places.span(key), message.into(), hint)
    }

    /// Has the material shaded by a model, without the parts of others that its file chooses: for comparisons of models.
    pub fn shade_by(&mut self, model: ShadingModel) {
        self.bake.model = Some(model);
        self.bake.masking = self.bake.masking.filter(|_| model.has_masking());
        self.bake.reflectance = self.bake.reflectance.filter(|_| model.has_reflectance());
        self.bake.internal_reflection = self.bake.internal_reflection.filter(|_| model.has_internal_reflection());
        if !model.has_beams() {
            self.bake.beams = None;
            self.layers.iter_mut().for_each(|layer| layer.exponents = None);
        }
    }

    /// Numbers of the model `granier-heidrich`, where the file gives some that are not those of every material.
    pub fn beams(&self) -> Option<BeamsRecord> {
        let Beams { specular_weight, diffuse_weight, inner_tilt, inner_azimuth } = self.bake.beams.unwrap_or_default();
        let exponents = self.layers.first().and_then(|first| first.exponents);
        let (sin, cos) = (libm::sin(inner_tilt), libm::cos(inner_tilt));
        let beams = BeamsRecord {
            inner_alpha_ratio: exponents.map_or(1.0, |[outer, inner]| libm::sqrt((outer + 2.0) / (inner + 2.0))),
            specular_weight,
            diffuse_weight,
            inner_normal: [sin * libm::cos(inner_azimuth), sin * libm::sin(inner_azimuth), cos],
        };
        (beams != BeamsRecord::PLAIN).then_some(beams)
    }

    /// File and line of a value: `gilding.toml:8`.
    pub fn place(&self, key: &str) -> String {
        let Diagnostic { label, line, .. } = self.diagnostic(Severity::Error, key, "", None);
        format!("{label}:{line}")
    }

    /// The re-radiation of its base, if that is fluorescent.
    pub fn reradiation(&self) -> Option<[Rgb; 3]> {
        self.layers.last().and_then(|layer| layer.reradiation)
    }

    /// The images that it names: of the first layer, then of effects.
    pub fn images(&self) -> Vec<NamedImage<'_>> {
        let mut found: Vec<(&'static str, Option<&str>)> = Vec::new();
        if let Some(LayerExtras { film_variation, maps, .. }) = self.layers.first() {
            let film = film_variation.as_ref().and_then(|variation| variation.source.image());
            found.extend([
                ("layer.0.maps.normal", maps.normal.as_deref()),
                ("layer.0.maps.roughness", maps.roughness.as_deref()),
                ("layer.0.maps.thickness", maps.thickness.as_deref()),
                ("layer.0.film.0.thickness_nm.map.image", film),
            ]);
        }
        let flakes = self.effects.flakes.as_ref().and_then(|flakes| match &flakes.source {
            FlakeSource::NormalMap { path } => Some(path.as_str()),
            FlakeSource::Cells { .. } => None,
        });
        let patina = self.effects.patina.as_ref().and_then(|patina| patina.map.image());
        found.extend([("effects.flakes.normal_map", flakes), ("effects.patina.map.image", patina)]);
        found.into_iter().filter_map(|(key, path)| Some(NamedImage { key, path: path? })).collect()
    }
}

/// Properties of a layer beyond its physics.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct LayerExtras {
    /// Rows of the matrix from light to light of a fluorescent base, linear Rec.709 under D65 ([`luthier_optics::reradiation::rgb`]). The
    /// albedo in the stack is its colour under white light, within 0..1.
    pub reradiation: Option<[Rgb; 3]>,
    /// How the thickness of the top film varies over the surface.
    pub film_variation: Option<FilmVariation>,
    /// Exponents of the lobes of the outer boundary, whose slope parameter the surface has, and of the inner one.
    pub exponents: Option<[f64; 2]>,
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
        /// Seed of the noise.
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
