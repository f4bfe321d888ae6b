//! A simulated picture that gathers samples, order after order, until something changes that it depends on.

use std::sync::Arc;

use luthier_gpu::{GpuError, Package, RenderSettings, Scene, Shown, Simulation, SimulationSettings, ToneMapping};
use luthier_lut::Image;

use crate::work::view::View;

/// Paths that are added at once, at most.
const STEP: u32 = 32;

/// Paths of each pixel, and their noise.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Progress {
    /// Paths so far.
    pub(crate) paths: u32,
    /// Paths at which it ends.
    pub(crate) goal: u32,
    /// Root of the mean square of the standard errors of all channels, in linear radiance.
    pub(crate) noise: f64,
}

/// State on which a simulated picture depends.
#[derive(Debug, Clone)]
struct Key {
    package: Arc<Package>,
    view: View,
    size: u32,
}

impl Key {
    fn of(package: &Arc<Package>, view: &View, size: u32) -> Self {
        // Neither the tone curve nor the quality of the other side is in a sum of samples.
        let look = crate::Look { tone: ToneMapping::None, ..view.look };
        let view = View { look, moving: false, environment_samples: 0, ..*view };
        Self { package: Arc::clone(package), view, size }
    }

    fn serves(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.package, &other.package) && self.view == other.view && self.size == other.size
    }
}

/// The simulation at hand, and its state.
#[derive(Debug, Default)]
pub(crate) struct Gathering {
    simulation: Option<(Key, Simulation)>,
}

impl Gathering {
    /// Whether the simulation at hand is of this state.
    pub(crate) fn serves(&self, package: &Arc<Package>, view: &View, size: u32) -> bool {
        self.simulation.as_ref().is_some_and(|(key, _)| key.serves(&Key::of(package, view, size)))
    }

    /// Begins anew, unless the simulation at hand is of this state.
    pub(crate) fn restart(
        &mut self,
        scene: &Scene,
        package: &Arc<Package>,
        view: &View,
        settings: &RenderSettings,
    ) -> Result<(), GpuError> {
        if !self.serves(package, view, settings.size) {
            self.simulation = None;
            let simulation = scene.simulation(&[Shown::Material(0)], settings, &SimulationSettings::default())?;
            self.simulation = Some((Key::of(package, view, settings.size), simulation));
        }
        Ok(())
    }

    /// Adds paths: as many as there are already, so that the noise falls by equal factors, up to a limit and to `goal`. Returns whether there
    /// is anything new; `stop` is asked on the way.
    pub(crate) fn add(&mut self, goal: u32, stop: &dyn Fn() -> bool) -> Result<bool, GpuError> {
        let Some((_, simulation)) = &mut self.simulation else { return Ok(false) };
        let paths = simulation.samples();
        let more = paths.clamp(1, STEP).min(goal.saturating_sub(paths));
        Ok(more > 0 && simulation.add_unless(more, stop)?)
    }

    /// The picture so far.
    pub(crate) fn picture(&self, goal: u32) -> Option<(Image, Progress)> {
        let (_, simulation) = self.simulation.as_ref().filter(|(_, simulation)| simulation.samples() > 0)?;
        let errors = simulation.noise().data;
        let squares: f64 = errors.iter().map(|error| f64::from(*error) * f64::from(*error)).sum();
        let noise = (squares / errors.len().max(1) as f64).sqrt();
        Some((simulation.image(), Progress { paths: simulation.samples(), goal, noise }))
    }
}
