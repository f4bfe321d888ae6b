//! Pictures: how they are lit, and how they are written.

use std::path::Path;
use std::sync::Arc;

use luthier_gpu::{Backdrop, Light, RenderSettings, Scene, Shape, Shown, ToneMapping};
use luthier_lut::Image;
use luthier_terminal::{Bar, Failure, Outcome, files};
use luthier_texture::{Metadata, exr, png};

use crate::cli::{Look, ShapeName};
use crate::{meshes, surroundings};

/// Rows of the maps of surroundings that luthier makes.
const SKY_ROWS: u32 = 512;

/// The settings that options ask for. A mesh file replaces the shape.
pub(crate) fn settings(look: &Look, shape: ShapeName, mesh: Option<&Path>, size: u32) -> Outcome<RenderSettings> {
    let mut settings = match mesh {
        Some(path) => {
            let mesh = Some(Arc::new(meshes::read(path)?));
            RenderSettings {
                shape: Shape::Mesh,
                camera: Shape::Mesh.camera(),
                mesh,
                ..RenderSettings::new(Shape::Sphere)?
            }
        }
        None => RenderSettings::new(shape.into())?,
    };
    settings.size = size;
    settings.samples = look.samples;
    settings.exposure = libm::exp2f(look.exposure);
    settings.environment_samples = look.environment_samples.unwrap_or(0);
    if let Some(path) = &look.environment {
        settings.environment = Arc::new(surroundings::read(path)?.environment);
    }
    if let Some(sky) = look.sky {
        settings.environment = Arc::new(sky.environment(SKY_ROWS).map_err(Failure::input)?);
    }
    if look.background {
        settings.backdrop = Backdrop::Environment;
    }
    if let Some(eye) = look.camera {
        settings.camera.eye = eye.0;
    }
    let irradiance = look.light_color.0;
    let default = settings.lights.drain(..).next().map(|light| light.with_color(irradiance));
    settings.lights.extend(look.light.iter().map(|v| Light::Directional { direction: v.0, irradiance }));
    settings.lights.extend(look.point_light.iter().map(|v| {
        let distance_sq: f32 = v.0.iter().map(|x| x * x).sum();
        Light::Point { position: v.0, intensity: irradiance.map(|e| e * distance_sq) }
    }));
    if settings.lights.is_empty() && look.environment.is_none() && look.sky.is_none() {
        settings.lights.extend(default);
    }
    Ok(settings)
}

/// Renders, and shows progress. Passes are short, so that none outlasts the patience with a busy software adapter.
pub(crate) fn render(scene: &Scene, parts: &[Shown], settings: &RenderSettings, what: &str) -> Outcome<Image> {
    let bar = Bar::new(what);
    let image = scene.render_watched(parts, settings, &|done, count| {
        bar.set(done as u64, count as u64);
        true
    });
    Ok(image?.expect("nobody stops it"))
}

/// File format of a picture.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Format {
    Png,
    Exr,
}

impl Format {
    /// The format by the extension of a file.
    pub(crate) fn of(path: &Path) -> Outcome<Self> {
        let extension = path.extension().map(|e| e.to_string_lossy().to_lowercase());
        match extension.as_deref() {
            Some("png") => Ok(Self::Png),
            Some("exr") => Ok(Self::Exr),
            _ => {
                let text = format!("cannot write {}: pictures are .png or .exr", path.display());
                Err(Failure::Input(anyhow::anyhow!(text)))
            }
        }
    }

    /// Writes a linear picture: unchanged as EXR, with a tone curve and the transfer function of sRGB as PNG.
    pub(crate) fn write(self, path: &Path, image: Image, tone: ToneMapping) -> Outcome {
        let bytes = match self {
            Self::Png => png::encode_image(&tone.image(image)),
            Self::Exr => exr::encode(&image, &exr::RGB, &Metadata::new()),
        };
        std::fs::write(path, bytes.map_err(Failure::input)?).map_err(files(path, "write"))
    }
}
