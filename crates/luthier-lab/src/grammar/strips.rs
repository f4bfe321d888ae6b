//! Strips of pictures: a ball for each value of a key.

use std::path::Path;

use luthier::{Bake, MemoryStore, Source, Sources, refuse};
use luthier_export::{Package, sha256};
use luthier_gpu::{RenderSettings, Shape, Shown, ToneMapping};
use luthier_lut::Image;
use luthier_manifest::Form;
use luthier_terminal::{Bar, Failure, Outcome, files, open, valid};
use luthier_texture::png;

use super::samples::Sample;
use crate::cli::GrammarOptions;

/// Directions of the environment for a lobe and a sample of a pixel. Blurred environments need tables of albedos, which take longer than all
/// pictures.
const ENVIRONMENT_SAMPLES: u32 = 64;

/// Pixels between pictures.
const GAP: u32 = 4;

/// Brightness of these pixels.
const PAPER: f32 = 1.0;

/// File beside the pictures with the hash of each sample. By it a test finds pictures that are out of date.
pub(crate) const HASHES: &str = "samples.txt";

/// The text of that file.
pub(crate) fn hashes(samples: &[Sample]) -> String {
    let samples = samples.iter();
    samples.map(|sample| format!("{} {}\n", sample.picture(), &sha256(sample.hashed().as_bytes())[..16])).collect()
}

/// Renders strips into a folder: of the keys that are asked for, or of all.
pub(crate) fn render(samples: &[Sample], folder: &Path, options: &GrammarOptions) -> Outcome {
    let names: Vec<&str> = samples.iter().map(|sample| sample.key).collect();
    if let Some(unknown) = options.keys.iter().find(|key| !names.contains(&key.as_str())) {
        return Err(Failure::unknown("key", unknown, &names));
    }
    std::fs::create_dir_all(folder).map_err(files(folder, "make"))?;
    let (gpu, size) = (open(options.adapter.name.as_deref())?, options.size);
    let is_all = options.keys.is_empty();
    let asked: Vec<&Sample> =
        samples.iter().filter(|s| is_all || options.keys.iter().any(|key| key == s.key)).collect();
    let bar = Bar::new("pictures");
    let work = std::env::temp_dir().join(format!("luthier-grammar-{}", std::process::id()));
    std::fs::create_dir_all(&work).map_err(files(&work, "make"))?;
    for (done, sample) in asked.iter().enumerate() {
        let mut pictures = Vec::new();
        for text in sample.texts() {
            let (package, shown) = if sample.is_surface() { surface(&text, &work)? } else { ball(text)? };
            pictures.push(gpu.scene(&package, Form::Baked)?.render_shown(&[shown], &settings(size)?)?);
        }
        let path = folder.join(sample.picture());
        let bytes = png::encode_image(&strip(&pictures)).map_err(Failure::input)?;
        std::fs::write(&path, bytes).map_err(files(&path, "write"))?;
        bar.set(done as u64 + 1, asked.len() as u64);
    }
    let path = folder.join(HASHES);
    let before = std::fs::read_to_string(&path).unwrap_or_default();
    // A picture that was not asked for is still of its older sample, so its hash stays.
    let after = hashes(samples);
    let lines = samples.iter().zip(after.lines());
    let lines = lines.filter_map(|(sample, line)| match asked.iter().any(|asked| asked.key == sample.key) {
        true => Some(line),
        false => before.lines().find(|known| known.split(' ').next() == line.split(' ').next()),
    });
    let text: String = lines.map(|line| format!("{line}\n")).collect();
    std::fs::write(&path, text).map_err(files(&path, "write"))?;
    std::fs::remove_dir_all(&work).map_err(files(&work, "remove"))
}

fn settings(size: u32) -> Outcome<RenderSettings> {
    Ok(RenderSettings {
        size,
        samples: 2,
        environment_samples: ENVIRONMENT_SAMPLES,
        ..RenderSettings::new(Shape::Sphere)?
    })
}

/// A material, baked by itself: materials of one bake share sizes of tables.
fn ball(text: String) -> Outcome<(Package, Shown)> {
    let path = crate::maps::maps("sample.toml");
    let mut sources: Vec<Source> = vec![Source::of_text(&path, text)];
    refuse(&mut sources, |material| luthier::refusals::of_model(material, None));
    let package = Bake::lit().package(&valid(sources, true)?, &MemoryStore::default())?;
    Ok((package, Shown::Material(0)))
}

/// A surface of several materials, whose file is written into a folder first.
fn surface(text: &str, work: &Path) -> Outcome<(Package, Shown)> {
    let path = work.join("surface.toml");
    std::fs::write(&path, text).map_err(files(&path, "write"))?;
    let sources = Sources::read([&path])?;
    let bake = Bake { surfaces: sources.surface_entries(), ..Bake::lit() };
    Ok((bake.package(&valid(sources.materials, true)?, &MemoryStore::default())?, Shown::Surface(0)))
}

/// Pictures side by side, as a display shows them.
fn strip(pictures: &[Image]) -> Image {
    let side = pictures.first().map_or(0, |picture| picture.width);
    let mut strip = Image::zeros(pictures.len() as u32 * (side + GAP) - GAP, side, 3);
    strip.data.fill(PAPER);
    for (left, picture) in (0..).step_by((side + GAP) as usize).zip(pictures) {
        let shown = ToneMapping::Shoulder.image(picture.clone());
        for (x, y) in (0..side).flat_map(|y| (0..side).map(move |x| (x, y))) {
            strip.texel_mut(left + x, y).copy_from_slice(&shown.texel(x, y)[..3]);
        }
    }
    strip
}
