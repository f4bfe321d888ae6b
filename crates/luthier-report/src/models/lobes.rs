//! Judgement at angles of the caller's choice, of models that hold the stack themselves.

use luthier_layers::layered_mc::{InterfaceMode, LayeredMc};
use luthier_layers::model::Model;
use luthier_layers::monochrome::Monochrome;
use rayon::prelude::*;

use super::cells::Cells;
use super::compare::compare;
use super::energies::Energies;
use super::paths::Histogram;
use super::{ModelSettings, ModelSubject, PHI_DEG, ViewError, direction};

/// Errors of models on a material, as [`super::judge_models`] has them, seen from other angles against the normal. `models` are those of a
/// channel of the subject's. By model; views by channel, then by angle.
pub fn judge_views<'m>(
    subject: &ModelSubject,
    models: impl Fn(usize) -> Vec<Box<dyn Model + 'm>> + Sync,
    thetas_deg: &[f64],
    settings: ModelSettings,
) -> Vec<Vec<ViewError>> {
    let views: Vec<(usize, f64)> =
        (0..3).flat_map(|channel| thetas_deg.iter().map(move |theta| (channel, *theta))).collect();
    let judged: Vec<Vec<ViewError>> = views
        .into_par_iter()
        .map(|(channel, theta_deg)| {
            let wavelength_nm = subject.wavelengths_nm[channel];
            let stack = Monochrome::new(&subject.stack, wavelength_nm, channel);
            let cells = Cells::new(direction(theta_deg, PHI_DEG));
            let samples = settings.samples.get().into();
            let estimator = LayeredMc { mode: InterfaceMode::SmithWalk, samples, seed: settings.seed };
            let reference = Histogram::trace(estimator, &stack, &cells);
            let error = |model: Box<dyn Model + 'm>| {
                compare(&Energies::of(model.as_ref(), &stack, &cells), &reference, wavelength_nm, theta_deg)
            };
            models(channel).into_iter().map(error).collect()
        })
        .collect();
    let count = judged.first().map_or(0, Vec::len);
    (0..count).map(|model| judged.iter().map(|view| view[model]).collect()).collect()
}
