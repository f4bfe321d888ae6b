//! `gallery`: many materials side by side.

use luthier_export::{Package, Source, find, lit, read};
use luthier_manifest::Form;
use luthier_report::sheet;
use luthier_terminal::{Failure, Outcome, open};

use crate::cli::{GalleryOptions, ShapeName};
use crate::materials::bakeable;
use crate::picture::{Format, settings};
use crate::store::store;
use crate::variations::variations;
use crate::verb::compare::ENVIRONMENT_SAMPLES;

/// Renders many materials side by side.
pub(crate) fn run(options: &GalleryOptions) -> Outcome {
    let format = Format::of(&options.output)?;
    if options.shape == ShapeName::Grid {
        return Err(Failure::Input(anyhow::anyhow!(
            "a gallery shows one material per picture, the grid 25 of its own"
        )));
    }
    let (titles, sources) = sources(options)?;
    // The warnings of a grid would be those of one file many times.
    let materials = bakeable(sources, &options.shading, &[], !options.grid.is_empty())?;
    let package = Package::for_renderer(&lit(&materials), store()?)?;
    let look = &options.look;
    let settings = settings(look, options.shape, options.mesh.as_deref(), options.size)?;
    let gpu = open(look.adapter.as_deref())?;
    let scene = gpu.scene(&package, Form::Baked)?;
    let mut pictures = Vec::with_capacity(materials.len());
    for (i, material) in materials.iter().enumerate() {
        let title = titles.get(i).unwrap_or(&material.name);
        let mut settings = settings.clone();
        if look.environment_samples.is_none() && !scene.has_albedo(i as u32)? {
            settings.environment_samples = ENVIRONMENT_SAMPLES;
        }
        pictures.push((title.clone(), scene.render(&[i as u32], &settings)?));
    }
    let columns = options.columns.unwrap_or_else(|| (pictures.len() as f64).sqrt().ceil() as u32);
    format.write(&options.output, sheet(&pictures, columns), look.tone.into())
}

/// The files, or the variations of one with their titles.
fn sources(options: &GalleryOptions) -> Outcome<(Vec<String>, Vec<Source>)> {
    let paths = &options.sources.paths;
    let [along, down] = options.grid.as_slice() else { return Ok((Vec::new(), read(paths)?)) };
    match find(paths)?.as_slice() {
        [file] => Ok(variations(file, [along, down], options.steps)?.into_iter().unzip()),
        files => Err(Failure::Input(anyhow::anyhow!(
            "a grid is of one material file, and here are {}: name one",
            files.len()
        ))),
    }
}
