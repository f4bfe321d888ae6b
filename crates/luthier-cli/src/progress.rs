//! Progress of a bake, and the time that each kind of job took.

use std::collections::BTreeMap;
use std::path::Path;
use std::sync::{Mutex, PoisonError};
use std::time::Instant;

use luthier_bake::{JobKind, Observer};
use luthier_export::MANIFEST;
use luthier_terminal::{Bar, tell};
use serde_json::json;

/// Tells that a folder holds a bake.
pub(crate) fn published(folder: &Path) {
    event("published", &folder.join(MANIFEST));
}

/// Tells of a file.
pub(crate) fn event(name: &str, path: &Path) {
    tell(&json!({ "event": name, "path": path.to_string_lossy() }));
}

/// Follows a bake.
pub(crate) struct BakeProgress {
    bar: Bar,
    state: Mutex<State>,
}

#[derive(Default)]
struct State {
    planned: u64,
    finished: u64,
    found: u64,
    running: Option<Instant>,
    seconds: BTreeMap<JobKind, f64>,
    phase: Option<Instant>,
    phases: Vec<(&'static str, f64)>,
}

impl BakeProgress {
    pub(crate) fn new() -> Self {
        let state = State { phase: Some(Instant::now()), ..State::default() };
        Self { bar: Bar::new("baking"), state: Mutex::new(state) }
    }

    /// Number of jobs that have run.
    pub(crate) fn run(&self) -> u64 {
        self.lock().finished
    }

    /// Number of jobs whose results a store had.
    pub(crate) fn had(&self) -> u64 {
        self.lock().found
    }

    /// Wall-clock seconds per kind of job, in the order in which they ran.
    pub(crate) fn seconds(&self) -> Vec<(JobKind, f64)> {
        self.lock().seconds.iter().map(|(kind, seconds)| (*kind, *seconds)).collect()
    }

    /// A phase of the command ends, and the next begins.
    pub(crate) fn ends(&self, phase: &'static str) {
        let mut state = self.lock();
        if let Some(start) = state.phase.replace(Instant::now()) {
            state.phases.push((phase, start.elapsed().as_secs_f64()));
        }
    }

    /// Begins the phase that ends next. The time since the last phase belongs to another package.
    pub(crate) fn resumes(&self) {
        self.lock().phase = Some(Instant::now());
    }

    /// Wall-clock seconds of all phases that have ended.
    pub(crate) fn seconds_all(&self) -> f64 {
        self.lock().phases.iter().map(|(_, seconds)| seconds).sum()
    }

    /// Wall-clock seconds per phase of the command, in their order.
    pub(crate) fn phases(&self) -> Vec<(&'static str, f64)> {
        self.lock().phases.clone()
    }

    fn lock(&self) -> std::sync::MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Observer for BakeProgress {
    fn planned(&self, jobs: usize) {
        let mut state = self.lock();
        state.planned = state.finished + jobs as u64;
        tell(&json!({ "event": "planned", "jobs": jobs }));
    }

    fn found(&self, kind: JobKind, jobs: usize) {
        self.lock().found += jobs as u64;
        tell(&json!({ "event": "found", "kind": kind.name(), "jobs": jobs }));
    }

    fn finished(&self, kind: JobKind) {
        let mut state = self.lock();
        state.finished += 1;
        tell(&json!({ "event": "finished", "kind": kind.name() }));
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
