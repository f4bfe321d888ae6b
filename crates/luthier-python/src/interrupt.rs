//! Ctrl-C while a function computes.
//!
//! Only the thread that Python was started on runs handlers of signals, and only with the interpreter's lock. So the work is done by another thread, and the
//! calling one asks for signals until the work is done.

use std::panic::resume_unwind;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};
use std::thread::{self, Builder};
use std::time::Duration;

use pyo3::prelude::*;

use crate::fault::file;

/// Time between two questions for signals: short for a person, long for the lock.
const PAUSE: Duration = Duration::from_millis(50);

/// Stack of the thread that works, bytes: what the first thread of a program has on most systems. Threads have a quarter of it.
const STACK: usize = 8 << 20;

/// Set once the caller no longer waits for the result. Work asks before each of its parts.
#[derive(Debug, Default)]
pub(crate) struct Interrupt(AtomicBool);

impl Interrupt {
    /// Whether the rest of the work can be left out.
    pub(crate) fn is_raised(&self) -> bool {
        self.0.load(Ordering::Relaxed)
    }

    fn raise(&self) {
        self.0.store(true, Ordering::Relaxed);
    }
}

/// The result of work whose parts are short. Where a handler of a signal raises, this waits for the parts that run.
///
/// # Errors
/// What the handler raised.
pub(crate) fn in_parts<T: Send>(py: Python<'_>, work: impl FnOnce(&Interrupt) -> T + Send) -> PyResult<T> {
    let interrupt = Interrupt::default();
    py.detach(|| {
        thread::scope(|scope| {
            let (sender, receiver) = channel();
            let its = &interrupt;
            let job = move || drop(sender.send(work(its)));
            let worker = Builder::new().stack_size(STACK).spawn_scoped(scope, job).map_err(file)?;
            wait(&receiver, &interrupt).unwrap_or_else(|| panicked(worker.join()))
        })
    })
}

/// The result of work that may have long parts. Where a handler of a signal raises, this returns at once: the work ends after the parts that run, and what
/// it puts into a store by then is kept.
///
/// # Errors
/// What the handler raised.
pub(crate) fn at_once<T: Send + 'static>(
    py: Python<'_>,
    work: impl FnOnce(&Interrupt) -> T + Send + 'static,
) -> PyResult<T> {
    let interrupt = Arc::new(Interrupt::default());
    py.detach(|| {
        let (sender, receiver) = channel();
        let its = Arc::clone(&interrupt);
        // After an interrupt there is no receiver.
        let job = move || drop(sender.send(work(&its)));
        let worker = Builder::new().stack_size(STACK).spawn(job).map_err(file)?;
        wait(&receiver, &interrupt).unwrap_or_else(|| panicked(worker.join()))
    })
}

/// Waits for a result, and runs handlers of signals meanwhile; `None` where the work panicked.
fn wait<T>(receiver: &Receiver<T>, interrupt: &Interrupt) -> Option<PyResult<T>> {
    loop {
        match receiver.recv_timeout(PAUSE) {
            Ok(result) => return Some(Ok(result)),
            Err(RecvTimeoutError::Disconnected) => return None,
            Err(RecvTimeoutError::Timeout) => {
                if let Err(error) = Python::attach(|py| py.check_signals()) {
                    interrupt.raise();
                    return Some(Err(error));
                }
            }
        }
    }
}

/// Goes on with the panic of work that has no result.
fn panicked<T>(joined: thread::Result<()>) -> PyResult<T> {
    match joined {
        Err(panic) => resume_unwind(panic),
        Ok(()) => unreachable!("work that ends sends its result"),
    }
}
