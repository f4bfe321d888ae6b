//! Materials whose stacks are simulated on the device.

use std::path::Path;

use luthier::{Bake, Source, TomlFile, refuse};
use luthier_export::Package;
use luthier_gpu::{Gpu, RenderSettings, Shown, SimulationSettings};
use luthier_lut::Image;
use luthier_manifest::{Feature, Form, MapSlot, ShadingModel};
use luthier_material::{Diagnostic, FileKind, Material, Severity, distribution_key};
use luthier_terminal::{Bar, Failure, Outcome, valid};

use crate::cli::Shading;
use crate::memory_bake;
use crate::store::store;

/// A material by file, or by its name in a bake on disk, ready to be simulated; and its number.
pub(crate) fn find(material: &str, out: &Path) -> Outcome<(Package, u32)> {
    let file = Path::new(material);
    if file.extension().is_none_or(|e| e != "toml") {
        return memory_bake::find(material, &Shading::default(), &[], out);
    }
    let file = TomlFile::read(file)?;
    if file.kind() == FileKind::Surface {
        let text = format!("{material} is a surface; the simulation on the device takes one of its materials");
        return Err(Failure::Input(anyhow::anyhow!(text)));
    }
    let mut sources = vec![Source::of(file)];
    refuse(&mut sources, beyond);
    Ok((package(valid(sources, false)?)?, 0))
}

/// A package of materials for the simulation. It needs no model, so nothing is fitted and no table is baked.
pub(crate) fn package(mut materials: Vec<Material>) -> Outcome<Package> {
    for material in &mut materials {
        material.shade_by(ShadingModel::Phong);
        material.bake.tables.clear();
    }
    Ok(Bake::lit().package(&materials, store()?)?)
}

/// Reasons why a material cannot be simulated, each with its file and line; empty if it can.
#[cfg(feature = "view")]
pub(crate) fn refusals(material: &Material) -> Vec<String> {
    let beyond = beyond(material).into_iter();
    beyond.map(|Diagnostic { message, label, line, .. }| format!("{message} ({label}:{line})")).collect()
}

/// Refusals of the parts of a material that the simulation on the device does not take.
pub(crate) fn beyond(material: &Material) -> Vec<Diagnostic> {
    let mut found: Vec<(String, Feature)> = Vec::new();
    for (number, layer) in material.stack.layers.iter().enumerate() {
        if !layer.films.is_empty() {
            found.push((format!("layer.{number}.film.0.type"), Feature::Films));
        }
        if material.layers[number].reradiation.is_some() {
            found.push((format!("layer.{number}.reradiation"), Feature::Reradiation));
        }
        let slopes = layer.surface.distribution;
        if !layer.surface.is_smooth() && !slopes.has_walks() {
            found.push((format!("layer.{number}.{}", distribution_key(slopes)), Feature::Distribution));
        }
        // Films are refused with their weights.
        let varied = material.layers[number].varied();
        for (key, slot) in varied.filter(|(_, slot)| *slot != MapSlot::Weight || !material.weighs_film()) {
            let of_surface = match slot {
                MapSlot::Normal => Feature::NormalMap,
                MapSlot::Roughness => Feature::RoughnessMap,
                MapSlot::Weight => Feature::Weight,
                _ => Feature::ThicknessMap,
            };
            let feature = slot.layer_feature(number as u32).unwrap_or(of_surface);
            found.push((format!("layer.{number}.{key}"), feature));
        }
    }
    let effects = &material.effects;
    for (is_there, key, feature) in [
        (effects.flakes.is_some(), "effects.flakes", Feature::Flakes),
        (effects.patina.is_some(), "effects.patina", Feature::Patina),
        (
            material.layers.first().is_some_and(|first| first.weight < 1.0 && !first.weighs_film),
            "layer.0.weight",
            Feature::Weight,
        ),
        (effects.glitter.is_some(), "effects.glitter", Feature::Glitter),
    ] {
        if is_there {
            found.push((key.to_owned(), feature));
        }
    }
    let refusals = found.into_iter().map(|(key, feature)| {
        let message = format!("the simulation on the device does not take {}", feature.name());
        let hint = "leave it out for the simulation, or render the material by a model: leave out `--simulated`";
        material.diagnostic(Severity::Error, &key, message, Some(hint.to_owned()))
    });
    refusals.collect()
}

/// A simulated picture, and the root of the mean square of the standard errors of its pixels.
pub(crate) struct Picture {
    pub(crate) image: Image,
    pub(crate) noise: f64,
}

/// Samples that are added at once.
const STEP: u32 = 32;

/// Simulates a picture with `samples` samples of each pixel. `so_far` sees it whenever their number has doubled.
pub(crate) fn picture(
    gpu: &Gpu,
    package: &Package,
    parts: &[Shown],
    settings: &RenderSettings,
    samples: u32,
    mut so_far: impl FnMut(Image) -> Outcome,
) -> Outcome<Picture> {
    // The simulation reads the material buffer, which every form binds.
    let form = Form::ALL.into_iter().find(|form| package.wgsl(*form).is_ok()).unwrap_or(Form::Baked);
    let scene = gpu.scene(package, form)?;
    let mut simulation = scene.simulation(parts, settings, &SimulationSettings::default())?;
    let bar = Bar::new("simulating");
    let mut next = 2 * STEP;
    while simulation.samples() < samples {
        simulation.add(STEP.min(samples - simulation.samples()))?;
        bar.set(simulation.samples().into(), samples.into());
        if simulation.samples() >= next && next < samples {
            so_far(simulation.image())?;
            next *= 2;
        }
    }
    let squares: f64 = simulation.noise().data.iter().map(|error| f64::from(*error) * f64::from(*error)).sum();
    let image = simulation.image();
    let noise = (squares / image.data.len() as f64).sqrt();
    Ok(Picture { image, noise })
}
