//! `bake --watch`: again whenever a file changes.

use std::collections::BTreeMap;
use std::path::PathBuf;
use std::thread::sleep;
use std::time::Duration;

use luthier::{find, inner_files};
use luthier_terminal::{Failure, Outcome, complain};

use super::once;
use crate::cli::BakeOptions;
use crate::watched::{self, seen};

/// Time between two looks at the files.
const PERIOD: Duration = Duration::from_millis(200);

/// Files; `None` for those that cannot be read.
type Files = BTreeMap<PathBuf, Option<watched::State>>;

/// The files that matter.
#[derive(PartialEq)]
struct State {
    /// Material files that are found now, and files of folders inside that may be materials.
    found: Files,
    /// Files that the last bake read.
    read: Files,
}

/// Bakes, and bakes again whenever files have changed and then rested for a period, until the process is ended. Files that cannot be used are
/// reported; the next change is awaited.
pub(super) fn run(options: &BakeOptions) -> Outcome {
    let mut read = Vec::new();
    loop {
        let before = state(options, &read);
        match once(options) {
            Ok(files) => read = files,
            Err(failure @ (Failure::Usage(_) | Failure::BrokenPipe)) => return Err(failure),
            Err(failure) => failure.tell(),
        }
        crate::store::close();
        if !options.quiet {
            complain("watching: changed files are baked; end with Ctrl-C");
        }
        settled(options, &read, &before);
    }
}

/// Waits until files have changed and then stayed the same for a period.
fn settled(options: &BakeOptions, read: &[PathBuf], before: &State) {
    let mut last = state(options, read);
    // Files may have changed or been added during the bake.
    let is_known = last.read.iter().all(|(path, state)| before.read.get(path).is_none_or(|then| then == state));
    let mut is_changed = last.found != before.found || !is_known;
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

fn state(options: &BakeOptions, read: &[PathBuf]) -> State {
    let paths = &options.sources.paths;
    let inner = inner_files(paths).unwrap_or_default().into_iter().map(|(_, _, file)| file);
    let found = find(paths).unwrap_or_default().into_iter().chain(inner);
    State { found: found.map(seen).collect(), read: read.iter().cloned().map(seen).collect() }
}
