use crate::cli::{GalleryOptions, ShapeName};
use crate::device::{device, open};
use crate::failure::{Failure, Outcome};
use crate::materials::{shaded, valid};
use crate::memory_bake;
use crate::picture::{Format, settings};
use crate::sheet::sheet;
use luthier_export::read;
use luthier_manifest::Form;

/// Renders many materials side by side.
pub(crate) fn run(options: &GalleryOptions) -> Outcome {
    let format = Format::of(&options.output)?;
    if options.shape == ShapeName::Grid {
        return Err(Failure::Input(anyhow::anyhow!(
            "a gallery shows one material per picture, the grid 25 of its own"
        )));
    }
    let materials = shaded(valid(read(&options.sources.paths)?, false)?, &options.shading);
    let package = memory_bake::bake_lit(&materials)?;
    let look = &options.look;
    let settings = settings(look, options.shape.into(), options.size)?;
    let gpu = open(look.adapter.as_deref())?;
    let scene = gpu.scene(&package, Form::Baked).map_err(device)?;
    let mut pictures = Vec::with_capacity(materials.len());
    for (i, material) in materials.iter().enumerate() {
        pictures.push((material.name.clone(), scene.render(&[i as u32], &settings).map_err(device)?));
    }
    let columns = options.columns.unwrap_or_else(|| (pictures.len() as f64).sqrt().ceil() as u32);
    format.write(&options.output, sheet(&pictures, columns), look.tone.into())
}
