//! `gallery`: many materials side by side.

use luthier_export::{Package, lit, read};
use luthier_manifest::Form;
use luthier_report::sheet;
use luthier_terminal::{Failure, Outcome, open};

use crate::cli::{GalleryOptions, ShapeName};
use crate::materials::bakeable;
use crate::picture::{Format, settings};
use crate::store::store;

/// Renders many materials side by side.
pub(crate) fn run(options: &GalleryOptions) -> Outcome {
    let format = Format::of(&options.output)?;
    if options.shape == ShapeName::Grid {
        return Err(Failure::Input(anyhow::anyhow!(
            "a gallery shows one material per picture, the grid 25 of its own"
        )));
    }
    let materials = bakeable(read(&options.sources.paths)?, &options.shading, &[], false)?;
    let package = Package::for_renderer(&lit(&materials), store()?)?;
    let look = &options.look;
    let settings = settings(look, options.shape.into(), options.size)?;
    let gpu = open(look.adapter.as_deref())?;
    let scene = gpu.scene(&package, Form::Baked)?;
    let mut pictures = Vec::with_capacity(materials.len());
    for (i, material) in materials.iter().enumerate() {
        pictures.push((material.name.clone(), scene.render(&[i as u32], &settings)?));
    }
    let columns = options.columns.unwrap_or_else(|| (pictures.len() as f64).sqrt().ceil() as u32);
    format.write(&options.output, sheet(&pictures, columns), look.tone.into())
}
