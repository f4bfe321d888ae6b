//! Progress of a bake, and the time that each kind of job took.

use std::collections::BTreeMap;
use std::sync::{Mutex, PoisonError};
use std::time::Instant;

use luthier_bake::{JobKind, Observer};
use luthier_terminal::Bar;

/// Follows a bake.
pub(crate) struct BakeProgress {
    bar: Bar,
    state: Mutex<State>,
}

#[derive(Default)]
struct State {
    planned: u64,
    finished: u64,
    running: Option<Instant>,
    seconds: BTreeMap<JobKind, f64>,
}

impl BakeProgress {
    pub(crate) fn new() -> Self {
        Self { bar: Bar::new("baking"), state: Mutex::default() }
    }

    /// Wall-clock seconds per kind of job, in the order in which they ran.
    pub(crate) fn seconds(&self) -> Vec<(JobKind, f64)> {
        self.lock().seconds.iter().map(|(kind, seconds)| (*kind, *seconds)).collect()
    }

    fn lock(&self) -> std::sync::MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Observer for BakeProgress {
    fn planned(&self, jobs: usize) {
        self.lock().planned = jobs as u64;
    }

    fn finished(&self, _: JobKind) {
        let mut state = self.lock();
        state.finished += 1;
        self.bar.set(state.finished, state.planned);
    }

    fn batch(&self, kind: JobKind, running: bool) {
        let mut state = self.lock();
        if running {
            state.running = Some(Instant::now());
        } else if let Some(start) = state.running.take() {
            *state.seconds.entry(kind).or_default() += start.elapsed().as_secs_f64();
        }
    }
}
