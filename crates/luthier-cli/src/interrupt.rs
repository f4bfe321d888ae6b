//! Signals end the program between files, never while one is written.

use std::path::Path;
use std::sync::{Mutex, PoisonError};

/// Held while a folder is written to.
static WRITING: Mutex<()> = Mutex::new(());

/// Exit code after SIGINT, SIGTERM or SIGHUP, as shells have it for the first.
const INTERRUPTED: i32 = 130;

/// Installs a handler: a signal ends the program as soon as it writes to no folder. Signals that the parent process made it ignore, as `nohup` does,
/// stay ignored.
pub(crate) fn watch() {
    // Without a handler the program ends at once, and the next one sweeps the files that it left.
    let _ = handle(|| {
        let _writing = WRITING.lock().unwrap_or_else(PoisonError::into_inner);
        std::process::exit(INTERRUPTED);
    });
}

/// Writes into a folder while signals wait. It waits for another program that publishes there before this, so that signals need not wait for that
/// program.
pub(crate) fn whole<T>(folder: &Path, write: impl FnOnce() -> T) -> T {
    luthier_export::wait(folder);
    let _writing = WRITING.lock().unwrap_or_else(PoisonError::into_inner);
    write()
}

#[cfg(unix)]
fn handle(end: impl Fn() + Send + 'static) -> std::io::Result<()> {
    use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM};
    use signal_hook::iterator::Signals;

    let ignored = ignored();
    let mut signals =
        Signals::new([SIGHUP, SIGINT, SIGTERM].iter().filter(|signal| ignored >> (**signal - 1) & 1 == 0))?;
    std::thread::Builder::new().name("signals".to_owned()).spawn(move || {
        if signals.forever().next().is_some() {
            end();
        }
    })?;
    Ok(())
}

/// The signals that are ignored, a bit each, where the system tells (Linux).
#[cfg(unix)]
fn ignored() -> u64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let mask = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    mask.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok()).unwrap_or(0)
}

#[cfg(not(unix))]
fn handle(end: impl Fn() + Send + 'static) -> Result<(), ctrlc::Error> {
    ctrlc::set_handler(end)
}
