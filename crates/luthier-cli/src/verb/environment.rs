//! `environment`: levels and irradiance of a picture, as textures.

use std::collections::BTreeSet;

use luthier_environment::{Environment, Layout, Level};
use luthier_export::{ENVIRONMENT, GENERATOR, publish, sha256};
use luthier_lut::{Image, TexelFormat};
use luthier_terminal::{Failure, Outcome, complain, print};
use luthier_texture::ktx2::{Levels, encode_levels};
use serde_json::{Value, json};

use crate::cli::{EnvironmentOptions, LayoutName};
use crate::interrupt::whole;
use crate::surroundings::{self, Surroundings};

/// The largest half float.
const LARGEST: f32 = 65504.0;

/// Rows of the map of a scenery.
const ROWS: u32 = 512;

/// Writes the levels of a picture.
pub(crate) fn run(options: &EnvironmentOptions) -> Outcome {
    let (environment, source) = source(options)?;
    let size = options.size.unwrap_or_else(|| environment.level_size());
    let asked: BTreeSet<LayoutName> = options.layout.iter().copied().collect();
    let layouts = if asked.is_empty() { LayoutName::ALL.into() } else { asked };
    let (mut files, mut textures, mut clamped) = (Vec::new(), Vec::new(), 0);
    for layout in layouts {
        let levels = environment.levels(layout.into(), size).map_err(Failure::input)?;
        let irradiance = [Level { width: 0.0, images: environment.irradiance_level(layout.into()) }];
        let listed: Vec<Value> = levels.iter().map(|level| described(level, layout.into())).collect();
        clamped += levels[0].images.iter().flat_map(Image::texels).filter(|t| t.iter().any(|v| *v > LARGEST)).count();
        for (content, levels) in [("environment", levels.as_slice()), ("irradiance", &irradiance)] {
            let path = format!("{content}-{}.ktx2", layout.name());
            let bytes = encode_levels(&stored(levels), !options.no_zstd).map_err(Failure::input)?;
            let image = &levels[0].images[0];
            let mut entry = json!({
                "path": path, "sha256": sha256(&bytes), "layout": layout.name(), "content": content, "format": "rgba16float",
                "width": image.width, "height": image.height,
            });
            if content == "environment" {
                entry["levels"] = json!(listed);
            }
            textures.push(entry);
            files.push((path, bytes));
        }
    }
    let manifest = json!({
        "generator": GENERATOR,
        "source": source,
        "radiance": "linear RGB; values above 65504 are stored as that",
        "clamped": clamped,
        "orientation": {
            "up": "+y",
            "equirect": "the top row is +y, the middle of the map is -z, +x lies to the right of the middle",
            "cube": "faces +x, -x, +y, -y, +z, -z as KTX2 and graphics interfaces order and turn them; a texel holds what comes from its direction",
        },
        "blur": "exp((cos - 1) / width^2), less what a bilinear read of the level blurs; alpha: the slope parameter of the mirror that blurs as \
                 much along its normal, width / sqrt 2; roughness: sqrt alpha",
        "irradiance": "irradiance over pi: what a white Lambertian patch sends out",
        "textures": textures,
    });
    let text = format!("{manifest:#}\n");
    files.push((ENVIRONMENT.to_owned(), text.clone().into_bytes()));
    let listed: Vec<(&str, &[u8])> = files.iter().map(|(path, bytes)| (path.as_str(), bytes.as_slice())).collect();
    whole(&options.out, || publish(&options.out, &listed))?;
    if clamped > 0 {
        complain(&format!(
            "warning: {clamped} texels are brighter than half floats hold and are stored as {LARGEST}; blurs know the whole"
        ));
    }
    if options.json {
        return print(&text);
    }
    let bytes: usize = files.iter().map(|(_, bytes)| bytes.len()).sum();
    print(&format!("{} files, {bytes} bytes, into {}", files.len(), options.out.display()))
}

/// The environment that the options name, and its entry in the manifest.
fn source(options: &EnvironmentOptions) -> Outcome<(Environment, Value)> {
    if let Some(sky) = options.sky {
        let environment = sky.environment(ROWS).map_err(Failure::input)?;
        return Ok((environment, json!({ "sky": sky.name(), "width": 2 * ROWS, "height": ROWS })));
    }
    let path = options.picture.as_deref().unwrap_or(std::path::Path::new(""));
    let Surroundings { environment, sha256, size: [width, height], negative } = surroundings::read(path)?;
    let name = path.file_name().map(|name| name.to_string_lossy());
    Ok((environment, json!({ "file": name, "sha256": sha256, "width": width, "height": height, "negative": negative })))
}

/// A level as the manifest lists it.
fn described(level: &Level, layout: Layout) -> Value {
    let alpha = level.width * std::f64::consts::FRAC_1_SQRT_2;
    let mean = layout.mean(&level.images);
    json!({ "size": level.images[0].height, "width": level.width, "alpha": alpha, "roughness": alpha.sqrt(), "mean": mean })
}

/// Levels as half floats, with a fourth channel of 1.
fn stored(levels: &[Level]) -> Levels<'static> {
    let first = &levels[0];
    Levels {
        format: TexelFormat::Rgba16Float,
        width: first.images[0].width,
        height: first.images[0].height,
        faces: first.images.len() as u32,
        levels: levels.iter().map(|level| level.images.iter().flat_map(face).collect::<Vec<u8>>().into()).collect(),
        metadata: Vec::new(),
    }
}

/// A face as half floats with an opaque fourth channel.
fn face(image: &Image) -> Vec<u8> {
    let data = image.texels().flat_map(|t| [t[0], t[1], t[2], 1.0].map(|v| v.min(LARGEST))).collect();
    TexelFormat::Rgba16Float.encode(&Image { channels: 4, data, ..*image })
}
