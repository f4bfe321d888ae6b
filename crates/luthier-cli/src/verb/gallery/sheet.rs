//! Many materials side by side in a picture.

use std::path::Path;

use luthier::{Bake, Source, find, lit, read_materials};
use luthier_gpu::Shown;
use luthier_manifest::Form;
use luthier_terminal::{Failure, Outcome, open};

use crate::cli::{GalleryOptions, ShapeName};
use crate::materials::bakeable;
use crate::picture::{Format, render, settings};
use crate::store::store;
use crate::variations::variations;
use crate::verb::compare::ENVIRONMENT_SAMPLES;

/// Renders many materials side by side.
pub(super) fn write(options: &GalleryOptions, output: &Path) -> Outcome {
    let sheet = &options.sheet;
    if options.simulated.is_some() {
        let text = "--simulated is for pages and for glTF files: leave it out, or name a page by --html";
        return Err(Failure::Usage(anyhow::anyhow!(text)));
    }
    let format = Format::of(output)?;
    if sheet.shape == ShapeName::Grid {
        return Err(Failure::Input(anyhow::anyhow!(
            "a gallery shows one material per picture, the grid 25 of its own"
        )));
    }
    let (titles, sources) = sources(options)?;
    // A grid would repeat the warnings of its one file many times.
    let materials = bakeable(sources, &options.shading.in_forms(&[]), !sheet.grid.is_empty())?;
    let look = &sheet.look;
    let settings = settings(look, sheet.shape, sheet.mesh.as_deref(), sheet.size)?;
    // Before the bake, which is for nothing where no driver is there.
    let gpu = open(look.adapter.as_deref())?;
    let package = Bake::lit().package(&lit(&materials), store()?)?;
    let scene = gpu.scene(&package, Form::Baked)?;
    let mut pictures = Vec::with_capacity(materials.len());
    for (i, material) in materials.iter().enumerate() {
        let title = titles.get(i).unwrap_or(&material.name);
        let mut settings = settings.clone();
        let number = i as u32;
        if look.environment_samples.is_none() && (!scene.has_albedo(number)? || scene.has_layer_maps(number)?) {
            settings.environment_samples = ENVIRONMENT_SAMPLES;
        }
        pictures.push((title.clone(), render(&scene, &[Shown::Material(number)], &settings, title)?));
    }
    let columns = sheet.columns.unwrap_or_else(|| (pictures.len() as f64).sqrt().ceil() as u32);
    format.write(output, luthier_report::sheet(&pictures, columns), look.tone.into())
}

/// The files, or the variations of one with their titles.
fn sources(options: &GalleryOptions) -> Outcome<(Vec<String>, Vec<Source>)> {
    let paths = &options.sources.paths;
    let [along, down] = options.sheet.grid.as_slice() else { return Ok((Vec::new(), read_materials(paths)?)) };
    match find(paths)?.as_slice() {
        [file] => Ok(variations(file, [along, down], options.sheet.steps)?.into_iter().unzip()),
        files => Err(Failure::Input(anyhow::anyhow!(
            "a grid is of one material file, and here are {}: name one",
            files.len()
        ))),
    }
}
