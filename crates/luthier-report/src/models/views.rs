//! One view of a material, and the judgement of models from views of the caller's choice.

use luthier_layers::layered_mc::{InterfaceMode, LayeredMc};
use luthier_layers::model::Model;
use luthier_layers::monochrome::Monochrome;
use rayon::prelude::*;

use super::cells::Cells;
use super::compare::compare;
use super::energies::Energies;
use super::paths::Histogram;
use super::{ModelSettings, ModelSubject, PHI_DEG, ViewError, direction};

/// A material at one wavelength, seen from one direction.
pub(super) struct View {
    pub(super) wavelength_nm: f64,
    pub(super) stack: Monochrome,
    pub(super) cells: Cells,
}

impl View {
    pub(super) fn new(subject: &ModelSubject, channel: usize, theta_deg: f64) -> Self {
        let wavelength_nm = subject.wavelengths_nm[channel];
        let stack = Monochrome::new(&subject.stack, wavelength_nm, channel);
        Self { wavelength_nm, stack, cells: Cells::new(direction(theta_deg, PHI_DEG)) }
    }

    /// Paths of the simulation. Families are far apart, so that seeds that follow each other share none.
    pub(super) fn trace(&self, mode: InterfaceMode, family: u64, samples: u32, seed: u64) -> Histogram {
        let estimator = LayeredMc { mode, samples: samples.into(), seed: seed.wrapping_add(family << 32) };
        Histogram::trace(estimator, &self.stack, &self.cells)
    }

    /// Even paths of the simulation.
    fn trace_evenly(&self, samples: u32, seed: u64) -> Histogram {
        let estimator = LayeredMc { mode: InterfaceMode::SmithWalk, samples: samples.into(), seed };
        Histogram::trace_evenly(estimator, &self.stack, &self.cells)
    }
}

/// Errors of models on a material, as [`super::judge_models`] has them, seen from other angles against the normal, with a reference of even paths
/// ([`LayeredMc::even_paths`]). `models` are those of a channel of the subject's. By model; views by channel, then by angle.
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
            let view = View::new(subject, channel, theta_deg);
            let reference = view.trace_evenly(settings.samples.get(), settings.seed);
            let error = |model: Box<dyn Model + 'm>| {
                let energies = Energies::of(model.as_ref(), &view.stack, &view.cells);
                compare(&energies, &reference, view.wavelength_nm, theta_deg)
            };
            models(channel).into_iter().map(error).collect()
        })
        .collect();
    let count = judged.first().map_or(0, Vec::len);
    (0..count).map(|model| judged.iter().map(|view| view[model]).collect()).collect()
}
