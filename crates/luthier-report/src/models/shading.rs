//! The models that shaders evaluate, against the reference.

use luthier_layers::registry::models;
use luthier_manifest::ShadingModel;
use luthier_optics::color_difference::{ciede2000, lab};
use serde::{Deserialize, Serialize};

use super::{ModelErrors, ModelSettings, ModelSubject, Row, THETAS_DEG, ViewError, judge_material};

/// Cap on lobe errors. A model that reflects light off a black reference has an infinite one, which JSON cannot hold.
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
        let albedos: [fn(&ViewError) -> f64; 2] = [|view| view.albedo_model, |view| view.albedo_reference];
        let (mut delta_e, mut by_angle) = (0.0_f64, Vec::new());
        for theta_deg in THETAS_DEG {
            let views = errors.views.iter().filter(|view| view.theta_deg == theta_deg);
            let [found, expected] = albedos.map(|albedo| {
                let mut values = views.clone().map(albedo);
                lab([0; 3].map(|_| values.next().unwrap_or(0.0)))
            });
            delta_e = delta_e.max(ciede2000(found, expected));
            by_angle.push((theta_deg, views.map(|view| view.lobe.error.min(MOST)).fold(0.0, f64::max)));
        }
        Self {
            model,
            albedo_err: errors.albedo.quantity.error,
            albedo_std_err: errors.albedo.quantity.std_err,
            lobe_err: errors.lobe.quantity.error.min(MOST),
            lobe_noise: errors.lobe.floor.min(MOST),
            worst_theta_deg: errors.lobe.theta_deg,
            worst_wavelength_nm: errors.lobe.wavelength_nm,
            delta_e,
            by_angle,
        }
    }
}

/// Judges the models that shaders evaluate on one material, in the order of [`ShadingModel::ALL`]. Equal settings give the figures of
/// [`crate::judge_models`].
pub fn judge_shading_models(subject: &ModelSubject, settings: ModelSettings) -> Vec<AgainstReference> {
    let rows = ShadingModel::ALL.into_iter().filter_map(|shading| {
        let model = models().into_iter().find(|model| model.info().name == shading.name())?;
        Some((shading, Row::Model(model)))
    });
    let (shading, rows): (Vec<ShadingModel>, Vec<Row>) = rows.unzip();
    let judged = judge_material(&rows, subject, settings);
    let errors = rows.iter().zip(judged).map(|(row, views)| ModelErrors::new(row, views));
    shading.into_iter().zip(errors).map(|(model, errors)| AgainstReference::of(model, &errors)).collect()
}
