//! The models that shaders evaluate, against the reference.

use luthier_layers::registry::models;
use luthier_manifest::ShadingModel;
use luthier_optics::color_difference::{ciede2000, lab};
use serde::{Deserialize, Serialize};

use super::{ModelErrors, ModelSettings, ModelSubject, Row, THETAS_DEG, ViewError, judge_material};

/// Stands for the lobe error of a model that reflects light where the reference reflects none, which no JSON holds.
const MOST: f64 = 1e6;

/// A model against the reference of whole stacks: the largest errors over the views of [`crate::judge_models`].
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct AgainstReference {
    /// The model.
    pub model: ShadingModel,
    /// Largest error of the directional albedo, absolute.
    pub albedo_err: f64,
    /// Standard error of the reference there.
    pub albedo_std_err: f64,
    /// Share of the reflected light that has to move, appear or vanish.
    pub lobe_err: f64,
    /// Lobe error that noise alone makes there.
    pub lobe_noise: f64,
    /// Angle of the eye at the largest lobe error, degrees.
    pub worst_theta_deg: f64,
    /// Wavelength there.
    pub worst_wavelength_nm: f64,
    /// Largest CIEDE2000 difference of the albedos at three wavelengths taken as R, G and B, under D65.
    pub delta_e: f64,
    /// Largest lobe error over the wavelengths, by angle of the eye in degrees.
    pub by_angle: Vec<(f64, f64)>,
}

impl AgainstReference {
    fn of(model: ShadingModel, errors: &ModelErrors) -> Self {
        let at = |theta_deg: f64| errors.views.iter().filter(move |view| view.theta_deg == theta_deg);
        let color = |theta_deg: f64, of: fn(&ViewError) -> f64| {
            let mut values = at(theta_deg).map(of);
            lab([0; 3].map(|_| values.next().unwrap_or(0.0)))
        };
        let delta_e = |theta_deg| {
            ciede2000(color(theta_deg, |view| view.albedo_model), color(theta_deg, |view| view.albedo_reference))
        };
        let lobe = |theta_deg| at(theta_deg).map(|view| view.lobe.error.min(MOST)).fold(0.0, f64::max);
        Self {
            model,
            albedo_err: errors.albedo.quantity.error,
            albedo_std_err: errors.albedo.quantity.std_err,
            lobe_err: errors.lobe.quantity.error.min(MOST),
            lobe_noise: errors.lobe.floor.min(MOST),
            worst_theta_deg: errors.lobe.theta_deg,
            worst_wavelength_nm: errors.lobe.wavelength_nm,
            delta_e: THETAS_DEG.into_iter().map(delta_e).fold(0.0, f64::max),
            by_angle: THETAS_DEG.into_iter().map(|theta_deg| (theta_deg, lobe(theta_deg))).collect(),
        }
    }
}

/// Judges the models that shaders evaluate on one material, in the order of [`ShadingModel::ALL`]. With the settings of
/// [`crate::judge_models`], its figures.
pub fn judge_shading_models(subject: &ModelSubject, settings: ModelSettings) -> Vec<AgainstReference> {
    let named = |shading: ShadingModel| {
        let model = models().into_iter().find(|model| model.info().name == shading.name());
        model.map(|model| (shading, Row::Model(model)))
    };
    let (shading, rows): (Vec<ShadingModel>, Vec<Row>) = ShadingModel::ALL.into_iter().filter_map(named).unzip();
    let judged = judge_material(&rows, subject, settings);
    let errors = rows.iter().zip(judged).map(|(row, views)| ModelErrors::new(row, views));
    shading.into_iter().zip(errors).map(|(model, errors)| AgainstReference::of(model, &errors)).collect()
}
