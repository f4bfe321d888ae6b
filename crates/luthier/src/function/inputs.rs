//! Inputs of an evaluation besides a material and two directions, and the effects and maps of the material that a model shows.

use luthier_layers::effects::textured::{TextureSample, Textured};
use luthier_layers::glam::{DVec2, DVec3};
use luthier_layers::model::{Input, Inputs as ModelInputs, Model, WEIGHTS_MOST};
use luthier_manifest::{Feature, Form, MapSlot, ShadingModel};
use luthier_material::{Effects, Material, PictureRef, TexelUse, left_out};
use luthier_optics::Rgb;

use super::{LiveValue, Refusal};

/// Inputs of an evaluation. The default is the first place of a material, with the effects and maps of its file.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Inputs {
    /// Texture coordinate of the place; (0, 0) unless given.
    pub uv: Option<DVec2>,
    /// Distance of the eye, in scene units.
    pub distance: Option<f64>,
    /// Extent of patina, in place of that of the file.
    pub extent: Option<f64>,
    /// Value of the patina's map at the place, in place of that of the map.
    pub map: Option<f64>,
    /// True where effects and maps of the file are left out.
    pub no_effects: bool,
    /// Normal of the inner boundary of the film, unit.
    pub inner_normal: Option<DVec3>,
    /// Weights of the layers from the top in a mixture of densities; none leaves those in proportion to their light.
    pub weights: Vec<f64>,
    /// Random samples per value.
    pub samples: Option<u64>,
    /// Seed of the random numbers.
    pub seed: Option<u64>,
    /// Normal of the place, unit.
    pub normal: Option<DVec3>,
    /// Factor on the slope parameters of all layers.
    pub alpha_factor: Option<f64>,
    /// Factor on the thickness of the slab below the first interface.
    pub slab_factor: Option<f64>,
    /// Factor on the thickness of the films on the first interface.
    pub film_factor: Option<f64>,
    /// Factor on the weight of a coat, or of the film on the first layer.
    pub weight_factor: Option<f64>,
    /// Variance, along either axis, of the slopes of the normals that a pixel sees.
    pub slope_variance: Option<f64>,
    /// Albedo of the diffuse base, in place of that of the file.
    pub base_color: Option<Rgb>,
    /// Live numbers.
    pub live: Vec<LiveValue>,
}

impl Inputs {
    /// Refuses weights that are not one for each layer of a material, or that are all 0.
    pub(super) fn check_weights(&self, material: &Material) -> Result<(), Refusal> {
        let (given, layers) = (self.weights.len(), material.stack.layers.len());
        if given == 0 || given == layers && given <= WEIGHTS_MOST && self.weights.iter().any(|weight| *weight > 0.0) {
            return Ok(());
        }
        Err(Refusal::Weights { given, layers })
    }

    /// An input that neither the model, nor the effects and maps that it shows, nor the choice of a surface take.
    pub fn not_taken(&self, model: &dyn Model, shown: &Effects, has_maps: bool, is_surface: bool) -> Option<Input> {
        let (flakes, patina) = (shown.flakes.is_some(), shown.patina.is_some());
        let given = [
            (Input::Uv, self.uv.is_some()),
            (Input::Distance, self.distance.is_some()),
            (Input::Extent, self.extent.is_some()),
            (Input::Map, self.map.is_some()),
            (Input::InnerNormal, self.inner_normal.is_some()),
            (Input::Weights, !self.weights.is_empty()),
            (Input::Samples, self.samples.is_some()),
            (Input::Seed, self.seed.is_some()),
        ];
        let info = model.info();
        let refused = given.into_iter().find(|(input, is_given)| {
            let by_effects = match input {
                Input::Uv => is_surface || has_maps || flakes || patina || shown.glitter.is_some(),
                Input::Distance => flakes,
                Input::Extent | Input::Map => patina,
                _ => false,
            };
            *is_given && !info.inputs.contains(input) && !by_effects
        });
        refused.map(|(input, _)| input)
    }

    /// The values of the textures at the place.
    pub(super) fn sample(&self) -> TextureSample {
        TextureSample {
            normal: self.normal.unwrap_or(TextureSample::NONE.normal),
            alpha_factor: self.alpha_factor.unwrap_or(1.0),
            slab_factor: self.slab_factor.unwrap_or(1.0),
            film_factor: self.film_factor.unwrap_or(1.0),
            slope_variance: self.slope_variance.unwrap_or(0.0),
        }
    }

    /// The map of the weight of a coat, unless maps of the file are left out.
    pub fn weight_map<'m>(&self, material: &'m Material) -> Option<&'m PictureRef> {
        material.layers.first()?.maps.weight.as_ref().filter(|_| !self.no_effects)
    }

    /// The effects of a file that a model shows, and the names of the other effects.
    pub fn shown(&self, material: &Material, model: &dyn Model) -> (Effects, Vec<&'static str>) {
        if self.no_effects {
            return Default::default();
        }
        // As in the shaders, only some models show effects below the first interface, and any model shows the normal of a particle.
        let effects = &material.effects;
        let shading = model.info().shading();
        let is_path = shading.is_some_and(ShadingModel::is_path);
        let has_lobes = shading.is_some_and(ShadingModel::is_fitted);
        let lacks_patina =
            || left_out(material, ShadingModel::Lobes).iter().any(|part| part.feature == Feature::Patina);
        let has_flakes = is_path || has_lobes;
        let has_patina = is_path || has_lobes && !lacks_patina();
        let below =
            [("flakes", effects.flakes.is_some() && !has_flakes), ("patina", effects.patina.is_some() && !has_patina)];
        let what = if material.weighs_film() { "weight of the film" } else { "weight of the coat" };
        let weight = (what, material.weight().is_some() && !shows_weight(material, model));
        let below = below.into_iter().chain([weight]);
        let dropped = below.filter(|(_, is_dropped)| *is_dropped).map(|(name, _)| name).collect();
        let shown = Effects {
            flakes: effects.flakes.clone().filter(|_| has_flakes),
            patina: effects.patina.clone().filter(|_| has_patina),
            glitter: effects.glitter,
        };
        (shown, dropped)
    }

    /// The maps of single layers that a model shows, each with its layer, and the names of the other maps' features.
    pub fn layer_maps(&self, material: &Material, model: &dyn Model) -> (Vec<LayerMap>, Vec<&'static str>) {
        if self.no_effects {
            return Default::default();
        }
        let maps =
            material.layers.iter().enumerate().flat_map(|(i, layer)| layer.maps.named().map(move |map| (i, map)));
        let shader = ShadingModel::from_name(model.info().name);
        let (mut shown, mut dropped) = (Vec::new(), Vec::new());
        for (layer, map) in maps {
            match map.slot.layer_feature(layer as u32) {
                Some(feature) if shader.is_none_or(|shader| lacks(shader, feature)) => dropped.push(feature.name()),
                Some(_) => {
                    shown.push(LayerMap { layer, slot: map.slot, picture: map.picture.clone(), texels: map.texels() })
                }
                None => {}
            }
        }
        dropped.dedup();
        (shown, dropped)
    }

    /// The model with its inputs.
    pub(super) fn give(&self, model: Box<dyn Model>) -> Box<dyn Model> {
        let inputs = ModelInputs {
            uv: self.uv,
            distance: self.distance,
            extent: self.extent,
            map: self.map,
            inner_normal: self.inner_normal,
            weights: self.layer_weights(),
            samples: self.samples,
            seed: self.seed,
        };
        model.with_inputs(&inputs).unwrap_or(model)
    }

    /// The weights of the layers, if there are any.
    fn layer_weights(&self) -> Option<[f64; WEIGHTS_MOST]> {
        let mut weights = [0.0; WEIGHTS_MOST];
        weights.iter_mut().zip(&self.weights).for_each(|(weight, given)| *weight = *given);
        (!self.weights.is_empty()).then_some(weights)
    }
}

/// Whether a model shows the weight of a coat or a film: some with a shader do, and models without one are evaluated with and without it.
pub(super) fn shows_weight(material: &Material, model: &dyn Model) -> bool {
    let Some(shading) = model.info().shading() else { return true };
    left_out(material, shading).iter().all(|part| !matches!(part.feature, Feature::Weight | Feature::FilmWeight))
}

/// The model with the values of textures at the place.
pub fn textured(sample: TextureSample, model: Box<dyn Model>) -> Box<dyn Model> {
    if sample == TextureSample::NONE { model } else { Box::new(Textured { sample, model }) }
}

/// True where the shader of a model shows a feature in no form.
fn lacks(shader: ShadingModel, feature: Feature) -> bool {
    !Form::ALL.iter().any(|&form| shader.honours(feature, form))
}

/// A map of one layer of a file.
#[derive(Debug)]
pub struct LayerMap {
    /// The layer, from the top.
    pub layer: usize,
    /// Quantity that it varies.
    pub slot: MapSlot,
    /// The picture.
    pub picture: PictureRef,
    /// Meaning of its texels.
    pub texels: TexelUse,
}
