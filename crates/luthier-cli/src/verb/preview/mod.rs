//! `preview`: a picture of one material, of the grid, or of a glTF file with its own materials.

mod scene;

use std::path::Path;

use luthier::{Bake, lit};
use luthier_gpu::{RenderSettings, Shape, Shown};
use luthier_lut::Image;
use luthier_manifest::Form;
use luthier_terminal::{Failure, Outcome, open};

use crate::cli::{PreviewOptions, ShapeName};
use crate::meshes::scene_file::is_scene;
use crate::picture::{Format, render, settings};
use crate::store::store;
use crate::verb::compare::ENVIRONMENT_SAMPLES;
use crate::{grid, memory_bake, simulated};

/// Renders one material, the grid, or a glTF file.
pub(crate) fn run(options: &PreviewOptions) -> Outcome {
    let format = Format::of(&options.output)?;
    if let Some(samples) = options.simulated {
        return simulate(options, samples, format);
    }
    let shape = options.shape.unwrap_or(ShapeName::Model);
    let named = named(options, shape)?;
    let look = &options.look;
    // Before the bake, which is for nothing where no driver is there.
    let gpu = open(look.adapter.as_deref())?;
    let mut own = None;
    let (package, parts) = match named {
        Some(file) if is_scene(file) => {
            let (package, parts, mesh) = scene::read(Path::new(file), &options.shading)?;
            own = Some(mesh);
            (package, parts)
        }
        Some(material) => {
            let (package, shown) = memory_bake::shown(material, &options.shading, &options.out)?;
            (package, vec![shown])
        }
        None => (Bake::lit().package(&lit(&grid::materials()?), store()?)?, all_of_grid()),
    };
    let closed = if own.is_some() { ShapeName::Sphere } else { shape };
    let mut settings = settings(look, closed, options.mesh.as_deref(), options.size)?;
    if own.is_some() {
        settings.shape = Shape::Mesh;
        settings.camera = Shape::Mesh.camera();
        if let Some(eye) = look.camera {
            settings.camera.eye = eye.0;
        }
        settings.mesh = own;
    }
    let scene = gpu.scene(&package, Form::Baked)?;
    for material in scene.materials_of(&parts)? {
        // Blurred maps need tables of albedos, which a bake on disk may lack, and ignore maps of single layers.
        if look.environment_samples.is_none() && (!scene.has_albedo(material)? || scene.has_layer_maps(material)?) {
            settings.environment_samples = ENVIRONMENT_SAMPLES;
        }
    }
    if gpu.is_software() && settings.samples > 1 {
        // A software adapter takes long: a first picture with one sample of each pixel comes before.
        let draft = RenderSettings { samples: 1, ..settings.clone() };
        write(options, format, render(&scene, &parts, &draft, "first picture")?)?;
    }
    write(options, format, render(&scene, &parts, &settings, "rendering")?)
}

fn write(options: &PreviewOptions, format: Format, image: Image) -> Outcome {
    format.write(&options.output, image, options.look.tone.into())
}

/// The picture by random walks of light through the stack of each material.
fn simulate(options: &PreviewOptions, samples: u32, format: Format) -> Outcome {
    let shape = options.shape.unwrap_or(ShapeName::Sphere);
    let (package, parts) = match named(options, shape)? {
        Some(material) => {
            let (package, number) = simulated::find(material, &options.out)?;
            (package, vec![Shown::Material(number)])
        }
        None => (simulated::package(grid::materials()?)?, all_of_grid()),
    };
    let look = &options.look;
    let settings = settings(look, shape, None, options.size)?;
    let gpu = open(look.adapter.as_deref())?;
    let picture =
        simulated::picture(&gpu, &package, &parts, &settings, samples, |image| write(options, format, image))?;
    write(options, format, picture.image)
}

/// Why a file with triangles and materials of its own is refused.
const SCENE: &str = "a glTF file has its own shape and materials: leave out --shape, --mesh and --simulated, or name a material file and the glTF file by --mesh";

/// The material that is named; `None` for the grid, which needs none.
fn named(options: &PreviewOptions, shape: ShapeName) -> Outcome<Option<&String>> {
    let text = match (&options.material, shape) {
        (None, ShapeName::Grid) => return Ok(None),
        (Some(file), _) if is_scene(file) => {
            let has_own = options.shape.is_none() && options.mesh.is_none() && options.simulated.is_none();
            return if has_own { Ok(options.material.as_ref()) } else { Err(Failure::Usage(anyhow::anyhow!(SCENE))) };
        }
        (Some(_), ShapeName::Grid) => "the grid makes its own materials; name none",
        (Some(material), _) => return Ok(Some(material)),
        (None, _) => "name a material, or take --shape grid",
    };
    Err(Failure::Input(anyhow::anyhow!(text)))
}

fn all_of_grid() -> Vec<Shown> {
    (0..Shape::Grid.materials() as u32).map(Shown::Material).collect()
}
