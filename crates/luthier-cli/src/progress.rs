//! Progress on a terminal, and the time that each kind of job took.

use std::collections::BTreeMap;
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use luthier_bake::{JobKind, Observer};

use crate::output::has_cursor;

/// Work shorter than this shows no bar.
const PATIENCE: Duration = Duration::from_secs(1);

/// A bar on standard error that appears when work takes longer than a second, and never when that is no terminal, or one that cannot move its cursor.
pub(crate) struct Bar {
    bar: ProgressBar,
    started: Instant,
}

impl Bar {
    pub(crate) fn new(what: &str) -> Self {
        let bar = ProgressBar::with_draw_target(None, ProgressDrawTarget::hidden());
        if let Ok(style) = ProgressStyle::with_template("{msg} [{bar:32}] {pos}/{len} {elapsed}") {
            bar.set_style(style.progress_chars("=> "));
        }
        bar.set_message(what.to_owned());
        Self { bar, started: Instant::now() }
    }

    pub(crate) fn set(&self, done: u64, total: u64) {
        self.bar.set_length(total);
        self.bar.set_position(done);
        if self.bar.is_hidden() && self.started.elapsed() > PATIENCE && has_cursor() {
            self.bar.set_draw_target(ProgressDrawTarget::stderr());
        }
    }
}

impl Drop for Bar {
    fn drop(&mut self) {
        self.bar.finish_and_clear();
    }
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
