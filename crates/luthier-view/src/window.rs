//! The loop that runs the window.

use std::sync::{Arc, Mutex, PoisonError};

use eframe::egui::{ThemePreference, ViewportBuilder};
use luthier_gpu::Gpu;

use crate::app::App;
use crate::error::ViewError;
use crate::host::Host;
use crate::look::{Look, Surroundings};
use crate::options::Options;
use crate::theme;

/// Opens the window, and returns when it is closed.
///
/// # Errors
/// [`ViewError::Display`] where there is no display; see [`ViewError`].
pub fn run(host: Arc<dyn Host>, gpu: Gpu, options: Options) -> Result<(), ViewError> {
    let surroundings = Surroundings::new(&options.settings, options.environment_name)?;
    let look = Look::of(&options.settings, options.tone);
    let failure = Arc::new(Mutex::new(None));
    let outcome = Arc::clone(&failure);
    let viewport = ViewportBuilder::default()
        .with_title("luthier view")
        .with_app_id("luthier")
        .with_inner_size(options.size)
        .with_min_inner_size([560.0, 360.0]);
    let native = eframe::NativeOptions { viewport, run_and_return: true, ..Default::default() };
    let create: eframe::AppCreator<'_> = Box::new(move |creation| {
        let context = &creation.egui_ctx;
        theme::apply(context);
        context.set_theme(match options.dark {
            Some(true) => ThemePreference::Dark,
            Some(false) => ThemePreference::Light,
            None => ThemePreference::System,
        });
        let app = App::new(context.clone(), host, gpu, &options, look, surroundings, outcome)?;
        Ok(Box::new(app))
    });
    eframe::run_native("luthier view", native, create).map_err(|error| match error {
        eframe::Error::AppCreation(source) => match source.downcast::<ViewError>() {
            Ok(error) => *error,
            Err(other) => ViewError::Display(other.to_string()),
        },
        other => ViewError::Display(cause(&other.to_string())),
    })?;
    match failure.lock().unwrap_or_else(PoisonError::into_inner).take() {
        Some(message) => Err(ViewError::Screenshot(message)),
        None => Ok(()),
    }
}

/// The cause behind an error of the window system, which names places in its own source.
fn cause(message: &str) -> String {
    let (_, cause) = message.rsplit_once(".rs:").unwrap_or(("", message));
    cause.trim_start_matches(|c: char| c.is_ascii_digit() || c == ':' || c == ' ').trim_end_matches('.').to_owned()
}

#[cfg(test)]
mod tests {
    use super::cause;

    #[test]
    fn causes_have_no_places_in_source() {
        assert_eq!(cause("EventLoopError: os error at /a/winit-0.30/src/linux/mod.rs:765: no DISPLAY."), "no DISPLAY");
        assert_eq!(cause("no adapter"), "no adapter");
    }
}
