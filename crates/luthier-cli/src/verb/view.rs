//! `view`: the window.

use std::sync::Arc;

use luthier_export::read;
use luthier_gpu::{Scenery, model};
use luthier_terminal::{Failure, Outcome, open};
use luthier_view::{Options, Shots, ViewError};

use crate::cli::{ShapeName, ThemeName, ViewOptions};
use crate::picture::{Format, settings};
use crate::view_host::ViewHost;

/// Opens the window, and returns when it is closed.
pub(crate) fn run(options: &ViewOptions) -> Outcome {
    if options.shape == ShapeName::Grid {
        return Err(Failure::Input(anyhow::anyhow!("a window shows one material; the grid has 25 of its own")));
    }
    if let Some(path) = &options.screenshot
        && Format::of(path)? != Format::Png
    {
        return Err(Failure::Input(anyhow::anyhow!("cannot write {}: screenshots are .png", path.display())));
    }
    // A path that is none is a mistake of the command line; what is in the files is shown in the window.
    read(&options.sources.paths)?;
    let look = &options.look;
    let mut settings = settings(look, options.shape, options.mesh.as_deref(), 1)?;
    // The window may come to it.
    settings.mesh = settings.mesh.or_else(|| Some(Arc::new(model::mesh())));
    let shape = settings.shape;
    let gpu = open(look.adapter.as_deref())?;
    let window = Options {
        settings,
        environment_name: look.environment.as_ref().map(|_| "file").or(look.sky.map(Scenery::name)),
        tone: look.tone.into(),
        shape,
        form: options.form,
        model: options.shading.model,
        fits: !options.shading.no_fit,
        size: options.window.0.map(f32::from),
        dark: options.theme.map(|theme| theme == ThemeName::Dark),
        shots: options.screenshot.is_some().then_some(Shots { frames: options.frames, count: options.shots }),
    };
    let host = ViewHost::new(options.sources.paths.clone(), options.screenshot.clone(), &options.shading);
    luthier_view::run(Arc::new(host), gpu, window).map_err(|error| match error {
        ViewError::Renderer(source) => source.into(),
        ViewError::Screenshot(_) => Failure::Files(error.into()),
        _ => Failure::Device(error.into()),
    })
}
