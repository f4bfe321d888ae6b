//! `view`: the window.

use std::sync::Arc;

use luthier::read_materials;
use luthier_gpu::{Scenery, model};
use luthier_terminal::{Failure, Outcome, open};
use luthier_view::{Against, Comparison, Options, Shots, ViewError};

use crate::cli::{ShapeName, Side, ThemeName, ViewOptions};
use crate::picture::{Format, settings};
use crate::view_host::ViewHost;

/// Opens the window, and returns when it is closed.
pub(crate) fn run(options: &ViewOptions) -> Outcome {
    let usual = if matches!(options.against, Some(Side::Simulated(_))) { ShapeName::Sphere } else { ShapeName::Model };
    let shape = options.shape.unwrap_or(usual);
    if shape == ShapeName::Grid {
        return Err(Failure::Input(anyhow::anyhow!("a window shows one material; the grid has 25 of its own")));
    }
    if let Some(path) = &options.screenshot
        && Format::of(path)? != Format::Png
    {
        return Err(Failure::Input(anyhow::anyhow!("cannot write {}: screenshots are .png", path.display())));
    }
    // A path that does not exist is a mistake of the command line; the window shows faults of files.
    read_materials(&options.sources.paths)?;
    let look = &options.look;
    let mut settings = settings(look, shape, options.mesh.as_deref(), 1)?;
    // The model can be chosen as the shape later, in the window.
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
        comparison: comparison(options),
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

/// The comparison that the options ask for.
fn comparison(options: &ViewOptions) -> Comparison {
    let mut comparison = Comparison::default();
    comparison.against = options.against.as_ref().map(|side| match side {
        Side::Simulated(paths) => {
            comparison.paths = *paths;
            Against::Simulation
        }
        Side::Shader(choice) => Against::Shader { model: choice.model, form: Some(choice.form) },
    });
    if let Some(factor) = options.difference {
        (comparison.difference, comparison.gain) = (true, f32::from(factor));
    }
    comparison
}
