//! Signals: between files, never within them.

use std::sync::{Mutex, PoisonError};

/// Held while a folder is written to.
static WRITING: Mutex<()> = Mutex::new(());

/// Exit code after SIGINT, SIGTERM or SIGHUP, as shells have it for the first.
const INTERRUPTED: i32 = 130;

/// From here on a signal ends the program as soon as no folder is being written to.
pub(crate) fn watch() {
    // Without a handler the program ends at once, and the next one sweeps what it left.
    let _ = ctrlc::set_handler(|| {
        let _writing = WRITING.lock().unwrap_or_else(PoisonError::into_inner);
        std::process::exit(INTERRUPTED);
    });
}

/// Does some writing that signals wait for.
pub(crate) fn whole<T>(write: impl FnOnce() -> T) -> T {
    let _writing = WRITING.lock().unwrap_or_else(PoisonError::into_inner);
    write()
}
