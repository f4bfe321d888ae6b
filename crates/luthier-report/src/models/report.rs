//! Figures of the judgement of models, as the JSON has them.

use serde::Serialize;

use super::page;
use super::{ModelSettings, ModelSubject, PHI_DEG, Row, THETAS_DEG};
use crate::error::ReportError;
use crate::text::json;

/// Errors of all models against the reference, on all materials.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ModelsReport {
    /// Paths of the reference per view.
    pub samples: u32,
    /// Family of random numbers.
    pub seed: u64,
    /// Angles of the eye against the normal.
    pub thetas_deg: Vec<f64>,
    /// Azimuth of the eye.
    pub phi_deg: f64,
    /// The materials, in the order of the subjects.
    pub materials: Vec<MaterialModels>,
}

/// Errors of all models against the reference, on one material.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct MaterialModels {
    /// The material.
    pub name: String,
    /// Its wavelengths.
    pub wavelengths_nm: [f64; 3],
    /// The rows: all models, then the reference in other modes. Every material has equal rows.
    pub models: Vec<ModelErrors>,
}

/// Errors of one model against the reference, on one material.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ModelErrors {
    /// Name of the model, or of the other row.
    pub name: &'static str,
    /// Whether the row is a model. The others are the reference in another mode or with other random numbers.
    pub is_model: bool,
    /// Largest albedo error.
    pub albedo: Worst,
    /// Largest lobe error.
    pub lobe: Worst,
    /// All views.
    pub views: Vec<ViewError>,
}

/// An error with its uncertainty.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize)]
pub struct Quantity {
    /// The error, not negative.
    pub error: f64,
    /// Its standard error, from the noise of the reference.
    pub std_err: f64,
    /// Change of the model's quadrature when its points were last doubled.
    pub quadrature_change: f64,
}

impl Quantity {
    /// Half the 95 % interval of the noise, and the whole change of the quadrature.
    pub fn uncertainty(&self) -> f64 {
        1.96 * self.std_err + self.quadrature_change
    }
}

/// The largest error over some views, with the view.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize)]
pub struct Worst {
    /// The error.
    #[serde(flatten)]
    pub quantity: Quantity,
    /// Floor of a lobe error: see [`ViewError::lobe_floor`]. For an albedo error, 0.
    pub floor: f64,
    /// Wavelength of the error.
    pub wavelength_nm: f64,
    /// Angle at which the error is seen.
    pub theta_deg: f64,
}

impl Worst {
    /// The largest error; zeros without views, which does not happen: the list of angles is not empty.
    fn among(all: impl Iterator<Item = Self>) -> Self {
        all.max_by(|a, b| a.quantity.error.total_cmp(&b.quantity.error)).unwrap_or_default()
    }
}

/// Errors of one view: at a wavelength, from a direction.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct ViewError {
    /// Wavelength.
    pub wavelength_nm: f64,
    /// Angle of the eye against the normal.
    pub theta_deg: f64,
    /// Absolute difference of the directional albedos.
    pub albedo: Quantity,
    /// Half the absolute differences of the cells' energies, over the reference's albedo.
    pub lobe: Quantity,
    /// The lobe error that noise alone makes on average, where model and reference agree.
    pub lobe_floor: f64,
    /// Directional albedo of the model.
    pub albedo_model: f64,
    /// Directional albedo of the reference.
    pub albedo_reference: f64,
}

impl ModelsReport {
    /// A report from the views per subject and row.
    pub(super) fn new(
        subjects: &[ModelSubject],
        settings: ModelSettings,
        rows: &[Row],
        judged: Vec<Vec<Vec<ViewError>>>,
    ) -> Self {
        let materials = subjects.iter().zip(judged).map(|(subject, judged)| MaterialModels {
            name: subject.name.clone(),
            wavelengths_nm: subject.wavelengths_nm,
            models: rows.iter().zip(judged).map(|(row, views)| ModelErrors::new(row, views)).collect(),
        });
        Self {
            samples: settings.samples.get(),
            seed: settings.seed,
            thetas_deg: THETAS_DEG.to_vec(),
            phi_deg: PHI_DEG,
            materials: materials.collect(),
        }
    }

    /// The report as JSON. Errors that are infinite, because the reference is black, are null.
    ///
    /// # Errors
    /// [`ReportError::Json`], should serialisation fail.
    pub fn to_json(&self) -> Result<String, ReportError> {
        json::to_string(self)
    }

    /// The report as a page in Markdown; `command` is the command line that made it.
    pub fn to_markdown(&self, command: &str) -> String {
        page::page(self, command)
    }
}

impl ModelErrors {
    pub(super) fn new(row: &Row, views: Vec<ViewError>) -> Self {
        Self {
            name: row.name(),
            is_model: matches!(row, Row::Model(_)),
            albedo: Worst::among(views.iter().map(|view| view.worst(view.albedo, 0.0))),
            lobe: Worst::among(views.iter().map(|view| view.worst(view.lobe, view.lobe_floor))),
            views,
        }
    }
}

impl ViewError {
    fn worst(&self, quantity: Quantity, floor: f64) -> Worst {
        Worst { quantity, floor, wavelength_nm: self.wavelength_nm, theta_deg: self.theta_deg }
    }
}
