//! Options of `eval` that only some models take.

use std::path::PathBuf;
use std::str::FromStr;

use clap::Args;
use glam::{DVec2, DVec3};
use luthier_layers::effects::textured::{TextureSample, Textured};
use luthier_layers::model::{Input, Inputs, Model, WEIGHTS_MOST};
use luthier_layers::registry::models;
use luthier_manifest::{Feature, Form, MapSlot, ShadingModel};
use luthier_material::{Effects, Material, PictureRef, TexelUse, left_out};
use luthier_model::Family;
use luthier_optics::Rgb;
use luthier_terminal::{Failure, Outcome};

use crate::directions::Angles;
use crate::numbers::{not_negative, number, share, wavelength};

#[derive(Debug, Args)]
#[command(next_help_heading = "Options of some models")]
pub(crate) struct ModelInputs {
    /// Texture coordinate of the place; 0,0 for effects and maps of layers of the file (flakes, heterogeneous and its kind)
    #[arg(long, value_name = "U,V", allow_hyphen_values = true)]
    uv: Option<Uv>,
    /// Distance of the eye, in scene units; 0 for flakes of the file (flakes)
    #[arg(long, value_name = "X", value_parser = not_negative, allow_hyphen_values = true)]
    pub(crate) distance: Option<f64>,
    /// How far the patina has developed, in place of what the file says: below 0 not at all, above 1 everywhere (patina)
    #[arg(long, value_name = "X", value_parser = number, allow_hyphen_values = true)]
    pub(crate) extent: Option<f64>,
    /// Value of the patina's map at the place in place of the map's, 0 to 1; dark places come first (patina)
    #[arg(long, value_name = "X", value_parser = share, allow_hyphen_values = true)]
    pub(crate) map: Option<f64>,
    /// Leave out what the file says under `effects` and its maps of single layers, as `luthier_eval` of the shaders does without a place
    #[arg(long)]
    no_effects: bool,
    /// Normal of the inner boundary of the film (granier-heidrich)
    #[arg(long, value_name = "THETA,PHI", allow_hyphen_values = true)]
    inner_normal: Option<Angles>,
    /// Weights of the layers from the top in a mixture of their densities, each at least 0, over their sum; in proportion to their light unless given
    /// (density-layers-local)
    #[arg(long, value_name = "W,...", value_delimiter = ',', value_parser = not_negative)]
    pub(crate) weights: Vec<f64>,
    /// A second material; without it both are the same (heterogeneous and its kind)
    #[arg(long, value_name = "FILE")]
    pub(crate) other: Option<PathBuf>,
    /// Re-radiation matrix of the base as a CSV file, see below; --wavelength is the light seen (fluorescence)
    #[arg(long, value_name = "CSV", requires = "excitation")]
    #[arg(conflicts_with_all = ["furnace", "alpha_factor", "slab_factor", "film_factor", "slope_variance"])]
    pub(crate) matrix: Option<PathBuf>,
    /// Wavelength of the light, when it is not the one seen (fluorescence)
    #[arg(long, value_name = "NM", value_parser = wavelength)]
    #[arg(requires = "matrix", requires = "wavelength")]
    pub(crate) excitation: Option<f64>,
    /// Random samples per value (random-walk, layered-mc and its kind); 4096 unless given
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..))]
    samples: Option<u64>,
    /// Which random numbers (random-walk, layered-mc and its kind)
    #[arg(long, value_name = "N")]
    seed: Option<u64>,
    #[command(flatten)]
    textures: Textures,
    /// Value of a number that the file has under `live`, as a program would write it into the place: a factor, or a colour, with the layer counted from 0,
    /// for models with a shader; may be given several times
    #[arg(long, value_name = "KEY=X,...", conflicts_with_all = ["furnace", "environment"])]
    pub(crate) live: Vec<LiveValue>,
}

/// Values of the textures at the place, for any model.
#[derive(Debug, Args)]
#[command(next_help_heading = "Textures at the place, for every model")]
struct Textures {
    /// Normal of the place
    #[arg(long, value_name = "THETA,PHI", allow_hyphen_values = true, conflicts_with_all = ["furnace", "environment"])]
    normal: Option<Angles>,
    /// Factor on the slope parameters of all layers
    #[arg(long, value_name = "X", value_parser = not_negative, allow_hyphen_values = true)]
    alpha_factor: Option<f64>,
    /// Factor on the thickness of the slab below the first interface
    #[arg(long, value_name = "X", value_parser = not_negative, allow_hyphen_values = true)]
    slab_factor: Option<f64>,
    /// Factor on the thickness of the films on the first interface
    #[arg(long, value_name = "X", value_parser = not_negative, allow_hyphen_values = true)]
    film_factor: Option<f64>,
    /// Factor on the weight of the first layer, a coat, or of the film on it
    #[arg(long, value_name = "X", value_parser = not_negative, allow_hyphen_values = true)]
    weight_factor: Option<f64>,
    /// Variance, along either axis, of the slopes of the normals that a pixel sees
    #[arg(long, value_name = "X", value_parser = not_negative, allow_hyphen_values = true)]
    slope_variance: Option<f64>,
    /// Albedo of the diffuse base, in place of that of the file, for models with a shader
    #[arg(long, value_name = "R,G,B", conflicts_with_all = ["furnace", "environment"])]
    base_color: Option<BaseColor>,
}

impl ModelInputs {
    pub(crate) fn uv(&self) -> Option<DVec2> {
        self.uv.map(|Uv(uv)| uv)
    }

    pub(crate) fn inner_normal(&self) -> Option<DVec3> {
        self.inner_normal.map(Angles::direction)
    }

    /// The weights of the layers, if there are any.
    fn layer_weights(&self) -> Option<[f64; WEIGHTS_MOST]> {
        let mut weights = [0.0; WEIGHTS_MOST];
        weights.iter_mut().zip(&self.weights).for_each(|(weight, given)| *weight = *given);
        (!self.weights.is_empty()).then_some(weights)
    }

    /// Refuses weights that are not one for each layer of a material, or that are all 0.
    pub(crate) fn check_weights(&self, material: &Material) -> Outcome {
        let (given, layers) = (self.weights.len(), material.stack.layers.len());
        if given == 0 || given == layers && given <= WEIGHTS_MOST && self.weights.iter().any(|weight| *weight > 0.0) {
            return Ok(());
        }
        Err(Failure::Usage(anyhow::anyhow!(
            "--weights has {given} numbers: give one for each of the {layers} layers, at most {WEIGHTS_MOST}, and one of them above 0"
        )))
    }

    pub(crate) fn has_normal(&self) -> bool {
        self.textures.normal.is_some()
    }

    /// The albedo of the diffuse base at the place.
    pub(crate) fn base_color(&self) -> Option<Rgb> {
        self.textures.base_color.map(|BaseColor(rgb)| rgb)
    }

    /// The values of the textures at the place.
    pub(crate) fn sample(&self) -> TextureSample {
        let Textures { normal, alpha_factor, slab_factor, film_factor, slope_variance, .. } = self.textures;
        TextureSample {
            normal: normal.map_or(TextureSample::NONE.normal, Angles::direction),
            alpha_factor: alpha_factor.unwrap_or(1.0),
            slab_factor: slab_factor.unwrap_or(1.0),
            film_factor: film_factor.unwrap_or(1.0),
            slope_variance: slope_variance.unwrap_or(0.0),
        }
    }

    /// The factor on the weight of a coat at the place.
    pub(crate) fn has_weight_factor(&self) -> bool {
        self.textures.weight_factor.is_some()
    }

    pub(crate) fn weight_factor(&self) -> f64 {
        self.textures.weight_factor.unwrap_or(1.0)
    }

    /// The map of the weight of a coat, unless maps of the file are left out.
    pub(crate) fn weight_map<'m>(&self, material: &'m Material) -> Option<&'m PictureRef> {
        material.layers.first()?.maps.weight.as_ref().filter(|_| !self.no_effects)
    }

    /// Whether a model shows the weight of a coat or a film: some with a shader do, and models without one are evaluated with and without it.
    pub(crate) fn shows_weight(material: &Material, model: &dyn Model) -> bool {
        let Some(shading) = model.info().shading() else { return true };
        left_out(material, shading).iter().all(|part| !matches!(part.feature, Feature::Weight | Feature::FilmWeight))
    }

    /// The effects of a file that a model shows, and the names of the other effects.
    pub(crate) fn shown(&self, material: &Material, model: &dyn Model) -> (Effects, Vec<&'static str>) {
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
        let weight = (what, material.weight().is_some() && !Self::shows_weight(material, model));
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
    pub(crate) fn layer_maps(&self, material: &Material, model: &dyn Model) -> (Vec<LayerMap>, Vec<&'static str>) {
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

    /// Refuses options that neither the model, nor the effects that it shows, nor the choice of a surface take.
    pub(crate) fn check(
        &self,
        model: &dyn Model,
        shown: &Effects,
        has_maps: bool,
        is_surface: bool,
        environment: bool,
    ) -> Outcome {
        let (flakes, patina) = (shown.flakes.is_some(), shown.patina.is_some());
        let given = [
            (Input::Uv, self.uv.is_some()),
            (Input::Distance, self.distance.is_some()),
            (Input::Extent, self.extent.is_some()),
            (Input::Map, self.map.is_some()),
            (Input::InnerNormal, self.inner_normal.is_some()),
            (Input::Weights, !self.weights.is_empty()),
            (Input::OtherStack, self.other.is_some()),
            (Input::Environment, environment),
            (Input::Matrix, self.matrix.is_some()),
            (Input::Excitation, self.excitation.is_some()),
            (Input::Samples, self.samples.is_some()),
            (Input::Seed, self.seed.is_some()),
        ];
        let info = model.info();
        if self.base_color().is_some() && !info.shading().is_some_and(takes_base_color) {
            let takers = ShadingModel::ALL.into_iter().filter(|model| takes_base_color(*model)).map(ShadingModel::name);
            let takers: Vec<&str> = takers.collect();
            return Err(Failure::Usage(anyhow::anyhow!(
                "model `{}` does not take --base-color; those that do: {}",
                info.name,
                takers.join(", ")
            )));
        }
        let refused = given.into_iter().find(|(input, is_given)| {
            let by_effects = match input {
                Input::Uv => is_surface || has_maps || flakes || patina || shown.glitter.is_some(),
                Input::Distance => flakes,
                Input::Extent | Input::Map => patina,
                _ => false,
            };
            *is_given && !info.inputs.contains(input) && !by_effects
        });
        let Some((input, _)) = refused else { return Ok(()) };
        let infos = models().into_iter().map(|model| model.info());
        let takers: Vec<&str> = infos.filter(|i| i.inputs.contains(&input)).map(|i| i.name).collect();
        let effects = match input {
            Input::Uv => {
                "; and `elek`, `weidlich-wilkie` and `lobes` for a file with flakes or patina, any model for one with glitter and for a surface; and models that show the maps of layers of a file"
            }
            Input::Distance => "; and `elek`, `weidlich-wilkie` and `lobes` for a file with flakes",
            Input::Extent | Input::Map => "; and `elek`, `weidlich-wilkie` and `lobes` for a file with patina",
            _ => "",
        };
        Err(Failure::Usage(anyhow::anyhow!(
            "model `{}` does not take --{}; those that do: {}{effects}",
            info.name,
            input.name(),
            takers.join(", ")
        )))
    }

    /// The model with its inputs.
    pub(crate) fn give(&self, model: Box<dyn Model>) -> Box<dyn Model> {
        let inputs = Inputs {
            uv: self.uv(),
            distance: self.distance,
            extent: self.extent,
            map: self.map,
            inner_normal: self.inner_normal(),
            weights: self.layer_weights(),
            samples: self.samples,
            seed: self.seed,
        };
        model.with_inputs(&inputs).unwrap_or(model)
    }

    /// The model with the values of textures at the place.
    pub(crate) fn textured(sample: TextureSample, model: Box<dyn Model>) -> Box<dyn Model> {
        if sample == TextureSample::NONE { model } else { Box::new(Textured { sample, model }) }
    }
}

/// A map of one layer of a file.
#[derive(Debug)]
pub(crate) struct LayerMap {
    /// The layer, from the top.
    pub(crate) layer: usize,
    /// Quantity that it varies.
    pub(crate) slot: MapSlot,
    /// The picture.
    pub(crate) picture: PictureRef,
    /// Meaning of its texels.
    pub(crate) texels: TexelUse,
}

#[derive(Debug, Clone, Copy)]
struct Uv(DVec2);

impl FromStr for Uv {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        match text.split_once(',').map(|(u, v)| [u, v].map(|text| number(text.trim()))) {
            Some([Ok(u), Ok(v)]) => Ok(Self(DVec2::new(u, v))),
            _ => Err("expected a texture coordinate u,v, such as 0.25,0.5".to_owned()),
        }
    }
}

#[derive(Debug, Clone, Copy)]
struct BaseColor(Rgb);

impl FromStr for BaseColor {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let values: Result<Vec<f64>, String> = text.split(',').map(|part| share(part.trim())).collect();
        let rgb = values.ok().and_then(|values| Rgb::try_from(values).ok());
        rgb.map(Self).ok_or_else(|| "expected three numbers from 0 to 1, such as 0.8,0.3,0.1".to_owned())
    }
}

/// A live number, and the value that it gets.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct LiveValue {
    pub(crate) layer: usize,
    pub(crate) name: String,
    pub(crate) values: Vec<f64>,
}

impl FromStr for LiveValue {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let parsed = text.split_once('=').and_then(|(key, values)| {
            let (layer, name) = key.trim().strip_prefix("layer.")?.split_once('.')?;
            let values: Option<Vec<f64>> = values.split(',').map(|value| number(value.trim()).ok()).collect();
            Some(Self { layer: layer.parse().ok()?, name: name.to_owned(), values: values? })
        });
        let expected = "expected a key and numbers, such as layer.1.base_color=0.8,0.3,0.1";
        parsed.filter(|live| live.values.len() <= 3).ok_or_else(|| expected.to_owned())
    }
}

/// True where the shader of a model shows a feature in no form.
fn lacks(shader: ShadingModel, feature: Feature) -> bool {
    !Form::ALL.iter().any(|&form| shader.honours(feature, form))
}

fn takes_base_color(model: ShadingModel) -> bool {
    model.facts().family != Family::Coefficients
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keys_are_those_of_layers() {
        let live: LiveValue = "layer.1.base_color=0.8, 0.3,0.1".parse().unwrap();
        assert_eq!((live.layer, live.name.as_str(), live.values.as_slice()), (1, "base_color", &[0.8, 0.3, 0.1][..]));
        for wrong in ["base_color=1", "layer.x.alpha=1", "layer.0.alpha", "layer.0.alpha=", "layer.0.alpha=1,1,1,1"] {
            assert!(wrong.parse::<LiveValue>().is_err(), "{wrong}");
        }
    }
}
