//! Materials of a bake.

use luthier_model::{
    DiffusePart, DiffuseTerm, Feature, Form, InternalReflection, LowerAlpha, LowerCosine, LowerFacets,
    LowerReflectance, Masking, PathParts, Reach, Reflectance, ShadingModel,
};
use serde::{Deserialize, Serialize};

use crate::color::ColorMode;
use crate::constants::{MaterialConstants, SideRecord, VaryingFactor};
use crate::live::{LiveEntry, LiveRange};
use crate::map::{MapEntry, MapSlot};
use crate::record::{LayerKind, LayerRecord};

/// One material.
///
/// ```
/// use luthier_manifest::{LayerRecord, MaterialEntry};
///
/// let mirror = MaterialEntry { layers: vec![LayerRecord::default()], ..MaterialEntry::default() };
/// assert!(!mirror.varies());
/// // A light of a radius of 0.01 gives a mirror a highlight of the slopes of half that radius.
/// assert!((mirror.widened(0.01).layers[0].alpha - 0.005).abs() < 1e-12);
/// ```
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct MaterialEntry {
    /// Name, unique in the bake; letters, digits and hyphens.
    pub name: String,
    /// Its file: a path from the folder of the manifest. Before a package is made for a folder, the path that was given.
    pub source: String,
    /// SHA-256, hex, of that file; of the file and, in the order of their names, the hashes of the files that it names, if any.
    pub source_hash: String,
    /// Surface class a-h of Weidlich and Wilkie 2009, chapter 4; without a coat `metal`, `film`, `matte` or `glass`.
    pub class: String,
    /// The reflectance model that the shaders evaluate.
    pub model: ShadingModel,
    /// How the colour of its tables was made.
    pub color: ColorMode,
    /// The three wavelengths of the full (table-free) shader, RGB order.
    pub wavelengths_nm: [f64; 3],
    /// Constants of the whole surface.
    pub constants: MaterialConstants,
    /// The layers from the top down.
    pub layers: Vec<LayerRecord>,
    /// Textures that vary the surface from place to place.
    pub maps: Vec<MapEntry>,
    /// Numbers that a program sets, of those that the model shows.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub live: Vec<LiveEntry>,
}

impl MaterialEntry {
    /// Whether textures make the surface differ from place to place.
    pub fn varies(&self) -> bool {
        let MaterialConstants { flakes, glitter, .. } = &self.constants;
        let has_effect = flakes.is_some() || self.constants.bare().is_some() || glitter.is_some();
        has_effect || !self.maps.is_empty() || !self.live.is_empty() || self.layers.iter().any(LayerRecord::varies)
    }

    /// Masking and reflectance of the first interface, by which the model goes.
    pub fn parts(&self) -> (Masking, Reflectance) {
        let first = self.layers.iter().find(|layer| layer.kind != LayerKind::Diffuse);
        first.map(|layer| (layer.masking, layer.reflectance)).unwrap_or_default()
    }

    /// Internal reflection of the first interface, by which the model goes.
    pub fn internal_reflection(&self) -> InternalReflection {
        let first = self.layers.iter().find(|layer| layer.kind != LayerKind::Diffuse);
        first.map(|layer| layer.internal_reflection).unwrap_or_default()
    }

    /// Reflectance of the interfaces below the first.
    pub fn lower_reflectance(&self) -> LowerReflectance {
        chosen(self.layers.iter().map(|layer| layer.lower_reflectance))
    }

    /// Cosine of the light on the interfaces below the first.
    pub fn lower_cosine(&self) -> LowerCosine {
        chosen(self.layers.iter().map(|layer| layer.lower_cosine))
    }

    /// The parts of a model that goes down a path.
    pub fn path_parts(&self) -> PathParts {
        PathParts {
            masking: self.parts().0,
            internal_reflection: self.internal_reflection(),
            lower_cosine: self.lower_cosine(),
            lower_facets: self.lower_facets(),
            lower_alpha: self.lower_alpha(),
            diffuse_part: self.diffuse_part(),
        }
    }

    /// Reflection of the interfaces below the first.
    pub fn lower_facets(&self) -> LowerFacets {
        chosen(self.layers.iter().map(|layer| layer.lower_facets))
    }

    /// Slope parameters of the interfaces below the first.
    pub fn lower_alpha(&self) -> LowerAlpha {
        chosen(self.layers.iter().map(|layer| layer.lower_alpha))
    }

    /// Place of the diffuse base.
    pub fn diffuse_part(&self) -> DiffusePart {
        chosen(self.layers.iter().map(|layer| layer.diffuse_part))
    }

    /// Whether `luthier_environment` shows its lobes: the model is fitted, and the first layer is an interface.
    pub fn shows_lobes(&self) -> bool {
        self.model.is_fitted() && self.layers.first().is_some_and(|layer| layer.kind != LayerKind::Diffuse)
    }

    /// The material with slopes widened by a light of an angular radius in radians, so that highlights of smooth surfaces have a size. Squares
    /// of slope parameters grow by the square of half the radius, because the half vector turns half as far as the light.
    pub fn widened(&self, angular_radius: f64) -> Self {
        let mut entry = self.clone();
        let MaterialEntry { layers, constants, .. } = &mut entry;
        for layer in layers.iter_mut().chain(constants.bare_mut()) {
            layer.alpha = wider(layer.alpha, angular_radius);
            layer.alpha_xy = layer.alpha_xy.map(|alpha| wider(alpha, angular_radius));
        }
        if let Some(patina) = &mut constants.patina {
            patina.base_alpha = patina.base_alpha.map(|alpha| wider(alpha, angular_radius));
        }
        entry
    }

    /// The layers, then the bare layer below a patina or a coat: what the material buffer holds.
    pub fn records(&self) -> impl Iterator<Item = &LayerRecord> {
        self.layers.iter().chain(self.constants.bare())
    }

    /// The layers below a coat with a weight, or those without a film with one, as a material of its own, where they have lobes apart from those of all layers. Its maps are those of these
    /// layers, and those of the whole surface that turn or scale them.
    pub fn side(&self) -> Option<Self> {
        let coat = self.constants.coat.as_ref().filter(|_| self.model.is_fitted())?;
        let SideRecord { lobes, without_film } = coat.side?;
        let kept = if without_film { 1 } else { 2 };
        let layers = std::iter::once(&coat.bare).chain(self.layers.iter().skip(kept)).cloned().collect();
        let below = |slot: MapSlot, layer: Option<u32>| match (slot, layer) {
            (MapSlot::Normal | MapSlot::Roughness, layer) => Some(layer),
            (MapSlot::FlakeNormal | MapSlot::Weight, _) | (_, None) => None,
            (MapSlot::Bumps, Some(layer)) if !self.tilts_lobes(layer) => None,
            (_, layer) if without_film => Some(layer),
            (_, Some(layer)) => Some(Some(layer.checked_sub(1)?)),
        };
        let maps =
            self.maps.iter().filter_map(|map| Some(MapEntry { layer: below(map.slot, map.layer)?, ..map.clone() }));
        let live = self.live.iter().filter_map(|live| {
            let layer = below(live.slot, Some(live.layer))??;
            Some(LiveEntry { layer, member: LiveEntry::member_of(live.slot, layer), ..live.clone() })
        });
        let constants = MaterialConstants { lobes, ..MaterialConstants::default() };
        Some(Self { layers, maps: maps.collect(), live: live.collect(), constants, ..self.clone() })
    }

    /// Whether its shader shows the weight of a coat as it shows an amount of patina, and not by a [`Self::side`].
    pub fn is_covered_by_amount(&self) -> bool {
        let varying = self.constants.lobes.and_then(|lobes| lobes.varying);
        let shows_ends = self.model.is_path() || varying.is_some_and(|varying| varying.factor.is_cover());
        let is_apart = |side: SideRecord| side.lobes.is_some() || self.model.is_fitted();
        self.constants.coat.as_ref().is_some_and(|coat| !coat.side.is_some_and(is_apart)) && shows_ends
    }

    /// Whether its weight is that of a film, in a model of paths: where that is not, its first layer is [`CoatRecord::bare`](crate::CoatRecord::bare), above the
    /// same layers.
    pub fn weighs_film_of_path(&self) -> bool {
        let side = self.constants.coat.as_ref().and_then(|coat| coat.side);
        self.model.is_path() && side.is_some_and(|side| side.without_film)
    }

    /// Number of blocks of [`LAYER_WORDS`](crate::LAYER_WORDS) words that the material buffer has of the material, beside its header: one for each of
    /// [`Self::records`]; and where it has a [`Self::side`], one for the header of that and one for each of its layers.
    pub fn blocks(&self) -> usize {
        self.records().count() + self.side().map_or(0, |side| 1 + side.layers.len())
    }

    /// Whether the model `lobes` shows the own normal of a layer: that of the first one, of the lowest interface and of a diffuse base. Rows of both ends of a
    /// patina or a coat share one frame: they have no own normals.
    fn tilts_lobes(&self, layer: u32) -> bool {
        let layers = &self.layers;
        let lowest = layers.iter().rposition(|layer| layer.kind != LayerKind::Diffuse);
        let ends = [Some(0), lowest, layers.len().checked_sub(1)];
        let has_side = self.constants.coat.as_ref().is_some_and(|coat| coat.side.is_some());
        (self.constants.bare().is_none() || has_side) && ends.contains(&Some(layer as usize))
    }

    /// Maps and live numbers of single layers that the model shows, in order: number of the layer, and quantity. `LuthierPlace` has their values; the value of
    /// an albedo map is its `base_color`.
    pub fn shown_layer_maps(&self, form: Form) -> impl Iterator<Item = (u32, MapSlot)> {
        let maps = self.maps.iter().filter_map(|map| Some((map.layer?, map.slot)));
        let live = self.live.iter().map(|live| (live.layer, live.slot));
        maps.chain(live).filter(move |&(layer, slot)| self.shows_of_layer(layer, slot, form) == Some(true))
    }

    /// Whether the model shows a quantity of a single layer that varies; `None` for quantities of the whole surface.
    fn shows_of_layer(&self, layer: u32, slot: MapSlot, form: Form) -> Option<bool> {
        let feature = slot.layer_feature(layer)?;
        let reads_all = self.model.facts().reach == Reach::All;
        // Models of the first interface may have the base, which is the last layer.
        let has_base = self.model.honours(Feature::Base, form) || self.constants.diffuse_term == DiffuseTerm::Added;
        let is_base = slot == MapSlot::Albedo && has_base;
        let is_read = match slot {
            MapSlot::Bumps if self.model.is_fitted() => self.tilts_lobes(layer),
            _ if self.model.is_fitted()
                && matches!(feature, Feature::LayerAlpha | Feature::Tangents | Feature::MetallicMap) =>
            {
                self.has_axis_of(layer)
            }
            MapSlot::Absorption if self.model.is_fitted() => layer == 0 && self.tints_lobes(),
            _ => layer == 0 || reads_all || is_base,
        };
        Some(is_read && self.model.honours(feature, form))
    }

    /// Keeps the live numbers that the model shows in some form, and bounds them by the rows that have them.
    #[must_use]
    pub fn with_live(mut self, live: Vec<LiveEntry>) -> Self {
        let varying = self.constants.lobes.filter(|_| self.model.is_fitted()).and_then(|lobes| lobes.varying);
        let shows = |live: &LiveEntry| {
            let shown = Form::ALL.map(|form| self.shows_of_layer(live.layer, live.slot, form));
            let of_surface = match live.slot {
                MapSlot::Thickness => Feature::ThicknessMap,
                MapSlot::Roughness => Feature::RoughnessMap,
                MapSlot::Weight => Feature::Weight,
                _ => Feature::NormalMap,
            };
            // Rows are over one factor alone, but those of a family have roughnesses in their axes, and thicknesses in closed form.
            let has_rows = match live.slot {
                MapSlot::Thickness => self.tints_lobes(),
                MapSlot::Roughness => varying.is_some_and(|varying| {
                    matches!(varying.factor, VaryingFactor::AlphaFactor | VaryingFactor::Family)
                }),
                _ => true,
            } || !self.model.is_fitted();
            let is_honoured = Form::ALL.into_iter().any(|form| self.model.honours(of_surface, form));
            if shown == [None; 2] { is_honoured && has_rows } else { shown.contains(&Some(true)) }
        };
        let over_slab = varying.is_some_and(|varying| varying.factor == VaryingFactor::SlabFactor);
        let kept = live.into_iter().filter(shows).map(|live| match (live.slot, live.range) {
            (MapSlot::Thickness | MapSlot::Absorption, Some(range)) if over_slab && live.layer == 0 => {
                LiveEntry { range: Some(LiveRange { most: Some(1.0), ..range }), ..live }
            }
            _ => live,
        });
        self.live = kept.collect();
        self
    }

    /// Whether rows of lobes know what the first slab absorbs at a place: they are over its thickness, or have it in closed form.
    fn tints_lobes(&self) -> bool {
        let varying = self.constants.lobes.and_then(|lobes| lobes.varying);
        varying.is_some_and(|varying| {
            varying.factor == VaryingFactor::SlabFactor
                || varying.family.is_some_and(|family| family.is_metallic || family.has_lengths)
        })
    }

    /// Whether rows of lobes are those of a family whose coat or base is this layer.
    fn has_axis_of(&self, layer: u32) -> bool {
        let family = self.constants.lobes.and_then(|lobes| lobes.family());
        family.is_some_and(|family| layer == 0 || layer == family.interface)
    }
}

/// The choice of a material, of those of its layers: the first that is not the default.
fn chosen<T: Default + PartialEq>(mut choices: impl Iterator<Item = T>) -> T {
    choices.find(|choice| *choice != T::default()).unwrap_or_default()
}

/// A slope parameter under a light of an angular radius: see [`MaterialEntry::widened`].
fn wider(alpha: f64, angular_radius: f64) -> f64 {
    let spread = 0.5 * angular_radius;
    libm::sqrt(alpha * alpha + spread * spread).min(1.0)
}
