//! Errors of the window.

use luthier_gpu::GpuError;
use thiserror::Error;

/// Failure to open a window.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum ViewError {
    /// No display, or none that takes a window.
    #[error(
        "cannot open a window: {0}; `luthier view` needs a display (set DISPLAY; without a screen: xvfb-run luthier view ..., \
         Debian and Ubuntu: apt-get install xvfb xauth libxkbcommon-x11-0 libx11-xcb1 libxcursor1 libxi6)"
    )]
    Display(String),
    /// The built-in surroundings cannot be made.
    #[error(transparent)]
    Renderer(#[from] GpuError),
    /// A thread cannot be started.
    #[error("cannot start a thread: {0}")]
    Thread(std::io::Error),
    /// A screenshot cannot be written.
    #[error("{0}")]
    Screenshot(String),
}
