use std::path::Path;

use luthier_bake::Silent;
use luthier_gpu::{Artefacts, BallSettings, TableTexels, WgslShader};
use luthier_lut::Image;
use luthier_texture::png;

use crate::artefacts::manifest;
use crate::bake_files::BakeFiles;
use crate::cli::{PreviewOptions, Shading};
use crate::device::{device, open};
use crate::failure::{Failure, Outcome, files};
use crate::materials::{read_image, read_one, shaded, valid};

/// Renders a ball and writes it as PNG.
pub(crate) fn run(options: &PreviewOptions) -> Outcome {
    let file = Path::new(&options.material);
    let artefacts = if file.extension().is_some_and(|e| e == "toml") {
        bake_one(file, &options.shading)?
    } else {
        manifest(&options.out)?;
        Artefacts::load(&options.out).map_err(device)?
    };
    let material = if file.extension().is_some_and(|e| e == "toml") {
        0
    } else {
        artefacts.manifest.material_index(&options.material).ok_or_else(|| {
            let known: Vec<&str> = artefacts.manifest.materials.iter().map(|m| m.name.as_str()).collect();
            let name = &options.material;
            Failure::Input(anyhow::anyhow!(
                "no material `{name}` in {}; known: {}; or name a .toml file",
                options.out.display(),
                known.join(", ")
            ))
        })?
    };
    let gpu = open(options.adapter.as_deref())?;
    let scene = gpu.scene(&artefacts, "baked").map_err(device)?;
    let settings = BallSettings {
        size: options.size,
        samples: options.samples,
        exposure: libm::exp2f(options.exposure),
        ..BallSettings::default()
    };
    let image = scene.render_ball(material, &settings).map_err(device)?;
    let bytes = png::encode_image(&tone_mapped(image)).map_err(Failure::input)?;
    std::fs::write(&options.output, bytes).map_err(files(&options.output, "write"))
}

/// Bakes one material in memory.
fn bake_one(file: &Path, shading: &Shading) -> Outcome<Artefacts> {
    let materials = shaded(valid(vec![read_one(file)?], false)?, shading);
    let bake = luthier_bake::bake(&materials, &read_image, &Silent).map_err(Failure::input)?;
    let made = BakeFiles::new(&materials, &bake)?;
    let tables = bake
        .atlases
        .iter()
        .map(|atlas| TableTexels {
            kind: atlas.kind,
            format: atlas.format,
            width: atlas.texels.width,
            height: atlas.texels.height,
            bytes: atlas.format.encode(&atlas.texels),
        })
        .collect();
    let shaders = made
        .manifest
        .shaders
        .iter()
        .filter(|s| s.target == "wgsl")
        .filter_map(|s| {
            let (_, bytes) = made.files.iter().find(|(path, _)| *path == s.file.path)?;
            Some(WgslShader { form: s.form.clone(), wgsl: String::from_utf8_lossy(bytes).into_owned() })
        })
        .collect();
    Artefacts::from_parts(made.manifest.clone(), tables, shaders).map_err(device)
}

/// Where highlights start to be compressed.
const SHOULDER: f32 = 0.8;

/// Keeps values below the shoulder and compresses those above it smoothly towards 1.
fn tone_mapped(mut image: Image) -> Image {
    for value in &mut image.data {
        if *value > SHOULDER {
            let range = 1.0 - SHOULDER;
            let excess = (*value - SHOULDER) / range;
            *value = SHOULDER + range * excess / (1.0 + excess);
        }
    }
    image
}
