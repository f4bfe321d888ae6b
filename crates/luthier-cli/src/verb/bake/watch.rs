//! `bake --watch`: again whenever a file changes.

use std::collections::BTreeMap;
use std::path::PathBuf;
use std::thread::sleep;
use std::time::{Duration, SystemTime};

use luthier_export::find;
use luthier_terminal::{Failure, Outcome, complain};

use super::once;
use crate::cli::BakeOptions;

/// Time between two looks at the files.
const PERIOD: Duration = Duration::from_millis(200);

/// Time of the last change and length of each file; `None` where it cannot be read.
type State = BTreeMap<PathBuf, Option<(SystemTime, u64)>>;

/// Bakes, and again whenever files have changed and then rested for a while, until the process is ended. Files that cannot be used are named, and waited for.
pub(super) fn run(options: &BakeOptions) -> Outcome {
    let mut read = Vec::new();
    loop {
        let before = state(options, &read);
        match once(options) {
            Ok(files) => read = files,
            Err(failure @ (Failure::Usage(_) | Failure::BrokenPipe)) => return Err(failure),
            Err(failure) => complain(&format!("error: {}", failure.sentence())),
        }
        crate::store::close();
        if !options.quiet {
            complain("watching: changed files are baked; end with Ctrl-C");
        }
        settled(options, &read, &before);
    }
}

/// Waits until files are others than before, and stay so for a period.
fn settled(options: &BakeOptions, read: &[PathBuf], before: &State) {
    let mut last = state(options, read);
    // The bake may have taken so long that files changed meanwhile.
    let is_known = |(path, state): (&PathBuf, &Option<_>)| before.get(path).is_none_or(|then| then == state);
    let mut is_changed = !last.iter().all(is_known);
    loop {
        sleep(PERIOD);
        let now = state(options, read);
        if now != last {
            (last, is_changed) = (now, true);
        } else if is_changed {
            return;
        }
    }
}

/// The files that matter: those that are found now, and those that were read last.
fn state(options: &BakeOptions, read: &[PathBuf]) -> State {
    let found = find(&options.sources.paths).unwrap_or_default();
    let metadata = |path: PathBuf| {
        let state = std::fs::metadata(&path).and_then(|m| Ok((m.modified()?, m.len()))).ok();
        (path, state)
    };
    found.into_iter().chain(read.iter().cloned()).map(metadata).collect()
}
