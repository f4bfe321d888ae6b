//! A reflectance model of a material as a function of two directions, in f64: the values of `luthier eval` and of the Python module.
//!
//! ```
//! use std::sync::Arc;
//!
//! use luthier::function::{Color, Function, Inputs, Kind, Subject};
//!
//! let text = "schema = 1\nname = \"chalk\"\n[[layer]]\ntype = \"diffuse\"\nalbedo = 0.8\n";
//! let chalk = luthier::parse("chalk.toml", text)?;
//! let model = luthier_layers::registry::model("elek").ok_or("no such model")?;
//! let fit = Arc::new(luthier_layers::models::lobes::Varied::of);
//! let subject = Subject::new(model, chalk, None, fit, &Inputs::default(), None)?;
//! let function = Function::new(&Arc::new(subject), &Kind::Color(Color::Spectral));
//!
//! let mut values = [0.0; 3];
//! function.eval_pairs(&[[0.0, 0.0, 1.0]], &[[0.0, 0.6, 0.8]], &mut values);
//! assert!(values.iter().all(|value| (value - 0.8 / std::f64::consts::PI).abs() < 1e-4));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod columns;
mod draws;
mod inputs;
mod live;
mod place;

use std::sync::Arc;

use luthier_bake::{Store, fitted};
use luthier_layers::glam::DVec3;
use luthier_layers::model::{Model, ModelInfo};
use luthier_layers::models::lobes::{Fit, Fitted};
use luthier_layers::twins::shaded::{Growth, Place, Side};
use luthier_manifest::ShadingModel;
use luthier_material::{Effects, Material};
use luthier_optics::color::GRANIER_WAVELENGTHS_NM;
use thiserror::Error;

use self::inputs::shows_weight;
use crate::refusals::of_function;

pub use columns::{Albedo, Function, Kind, parts};
pub use draws::Draws;
pub use inputs::{Inputs, LayerMap, textured};
pub use live::LiveValue;
pub use luthier_optics::color::Color;

/// Why a function cannot be evaluated.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum Refusal {
    /// A live number that the file does not have, that the model does not show, or that is out of its range.
    #[error("{0}")]
    Live(String),
    /// Weights that are not one for each layer.
    #[error("there are {given} weights: give one for each of the {layers} layers, at most {most}, and one of them above 0", most = luthier_layers::model::WEIGHTS_MOST)]
    Weights {
        /// Number of weights.
        given: usize,
        /// Number of layers.
        layers: usize,
    },
    /// A factor on the weight of a coat, of a file without one.
    #[error("{file} has no coat or film with a weight below 1 or in a map: leave the factor on the weight out")]
    NoWeight {
        /// The file.
        file: String,
    },
    /// Factors on a slab or a film, for a coat with a weight and a model that is evaluated with and without it.
    #[error("model `{model}` has no place: leave factors on the slab and the film out for a coat with a weight")]
    NoPlace {
        /// The model.
        model: &'static str,
    },
    /// The material is outside the domain of the model, or a map of it cannot be read.
    #[error("{0}")]
    File(String),
}

/// Subject of an evaluation: a model with its inputs, and a material at a place.
pub struct Subject {
    /// The model.
    pub model: Box<dyn Model>,
    /// The material.
    pub material: Material,
    /// Gives the model `lobes` its lobes.
    fit: Arc<Fit<'static>>,
    /// The place.
    pub place: Place,
    /// Share of the surface that the first layer covers, if that is a coat with a weight and the model shows it.
    pub weight: Option<f64>,
    /// Whether effects of the file are in the place.
    pub has_effects: bool,
}

/// The function that fits lobes, with the results of a store.
pub fn fits(store: &'static dyn Store) -> Arc<Fit<'static>> {
    Arc::new(move |stack, color, varying| fitted(stack, color, varying, store))
}

/// Whether a model is fitted to a simulation of the stack.
pub fn is_fitted(model: &ModelInfo) -> bool {
    model.shading().is_some_and(ShadingModel::is_fitted)
}

impl Subject {
    /// A model of a material at a place. A model that spreads two materials over places may take the other one. `picked` is the normal of a surface at the
    /// place.
    ///
    /// # Errors
    /// [`Refusal`].
    pub fn new(
        mut known: Box<dyn Model>,
        first: Material,
        other: Option<Material>,
        fit: Arc<Fit<'static>>,
        inputs: &Inputs,
        picked: Option<DVec3>,
    ) -> Result<Self, Refusal> {
        let name = known.info().name;
        if is_fitted(&known.info()) {
            known = Box::new(Fitted::by(fit.clone()));
        }
        let (shown, _) = inputs.shown(&first, known.as_ref());
        let (maps, _) = inputs.layer_maps(&first, known.as_ref());
        inputs.check_weights(&first)?;
        let model = inputs.give(known);

        // Without another material, the first is everywhere.
        let material = other.filter(|_| model.stack_index() > 0).unwrap_or(first);
        if let Some(error) = of_function(&material, name) {
            return Err(Refusal::File(format!("{}: {}", error.label, error.message)));
        }
        let mut place = place::place(&material, inputs, &shown)?;
        place::add_layers(&mut place, &material, model.info().shading(), inputs, &maps)?;
        if inputs.weight_factor.is_some() && material.weight().is_none() {
            return Err(Refusal::NoWeight { file: material.source });
        }
        let weight = place::weight(&material, inputs)?.filter(|_| shows_weight(&material, model.as_ref()));
        if let Some(weight) = weight.filter(|_| model.info().shading().is_some()) {
            place.patina = Some(Growth::of_coat(weight));
            let side = if material.weighs_film() { Side::Film } else { Side::Coat };
            place.side = material.has_side().then_some(side);
        } else if weight.is_some() && (place.sample.slab_factor, place.sample.film_factor) != (1.0, 1.0) {
            return Err(Refusal::NoPlace { model: name });
        }
        if let Some(normal) = picked.filter(|normal| inputs.normal.is_none() && normal.z < 1.0) {
            place.sample.normal = normal;
        }
        let has_effects = shown != Effects::default() || !maps.is_empty() || !inputs.live.is_empty();
        let model = textured(place.sample, model);
        Ok(Self { model, material, fit, place, weight, has_effects })
    }
}

/// The channel whose absorption and albedo are those at a wavelength.
pub fn nearest_channel(wavelength_nm: f64) -> usize {
    let distances = GRANIER_WAVELENGTHS_NM.map(|nm| (nm - wavelength_nm).abs());
    (0..3).min_by(|&a, &b| distances[a].total_cmp(&distances[b])).unwrap_or(1)
}
