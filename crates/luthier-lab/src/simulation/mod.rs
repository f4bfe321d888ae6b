//! `simulation`: times and pictures of the simulation on the device, compared with models.

mod page;

use std::sync::Arc;
use std::time::Instant;

use luthier::{Bake, MemoryStore, lit, read_materials};
use luthier_environment::{Environment, Scenery};
use luthier_export::GENERATOR;
use luthier_gpu::{Facets, Gpu, RenderSettings, Scene, Shape, Shown, SimulationSettings};
use luthier_lut::Image;
use luthier_manifest::{ColorMode, Form, ShadingModel};
use luthier_material::Material;
use luthier_report::{Spread, compare_pictures};
use luthier_terminal::{Bar, Failure, Outcome, adapter_json, adapter_label, deliver, open, valid};
use serde_json::{Value, json};

use crate::cli::SimulationOptions;

/// Version of the JSON.
const SCHEMA: u32 = 1;

/// Models beside the simulation: the papers' two, and the one that is fitted to a simulation.
const MODELS: [ShadingModel; 3] = [ShadingModel::Yamaguchi, ShadingModel::Belcour, ShadingModel::Lobes];

/// Samples of a pixel that times are for; the last is the paper's.
const SAMPLES: [u32; 4] = [32, 128, 512, 2048];

/// Rows of the map of the surroundings.
const ROWS: u32 = 128;

/// Turns of the surroundings about the vertical axis: degrees, and thirds of a whole one.
const TURNS: [(u32, u32); 3] = [(0, 0), (120, 1), (240, 2)];

/// Directions of the environment for each lobe and sample of a pixel, of models in pictures: with 16 samples 1,024.
const DIRECTIONS: u32 = 64;

/// Median milliseconds of a picture, and their median deviation.
struct Time {
    material: String,
    way: String,
    samples: u32,
    spread: Spread,
}

/// Errors of models against the simulation.
struct Error {
    material: String,
    turn: u32,
    /// Mean of the simulation over the picture.
    mean: f64,
    /// Its noise.
    noise: f64,
    /// Root mean square difference of each of [`MODELS`], the noise taken out.
    rms: Vec<f64>,
}

/// A material on the device: a scene for the simulation of its stack, and a scene for each model.
struct Subject {
    name: String,
    stack: Scene,
    models: Vec<Scene>,
}

/// Measures materials.
pub(crate) fn run(options: &SimulationOptions) -> Outcome {
    let gpu = open(options.adapter.name.as_deref())?;
    let materials = valid(read_materials(&options.sources.paths)?, false)?;
    let skies = skies()?;
    let bar = Bar::new("simulation");
    let (mut times, mut errors) = (Vec::new(), Vec::new());
    for (i, material) in materials.iter().enumerate() {
        let subject = Subject::new(&gpu, material)?;
        times.extend(subject.times(options, &skies[0])?);
        errors.extend(subject.errors(options, &skies)?);
        bar.set(i as u64 + 1, materials.len() as u64);
    }
    drop(bar);
    let adapter = adapter_label(&gpu);
    if let Some(file) = &options.data {
        let data = data(&gpu, options, &times, &errors);
        deliver(&format!("{data:#}\n"), Some(file))?;
    }
    deliver(&page::page(options, &adapter, gpu.is_software(), &times, &errors), options.destination.output.as_deref())
}

/// The surroundings at each turn.
fn skies() -> Outcome<Vec<Arc<Environment>>> {
    let map = Scenery::StripStudio.map(ROWS).map_err(Failure::input)?;
    let skies = TURNS.iter().map(|(_, third)| {
        let (width, shift) = (map.width, map.width * third / 3);
        let mut turned = map.clone();
        for (y, x) in (0..map.height).flat_map(|y| (0..width).map(move |x| (y, x))) {
            turned.texel_mut((x + shift) % width, y).copy_from_slice(map.texel(x, y));
        }
        Environment::new(turned).map(Arc::new).map_err(Failure::input)
    });
    skies.collect()
}

impl Subject {
    fn new(gpu: &Gpu, material: &Material) -> Outcome<Self> {
        let models = MODELS.iter().map(|model| scene(gpu, material, *model)).collect::<Outcome<_>>()?;
        Ok(Self { name: material.name.clone(), stack: scene(gpu, material, ShadingModel::Phong)?, models })
    }

    /// Times of a picture under surroundings alone. All ways are timed in turn, so that other load of the machine affects them alike.
    fn times(&self, options: &SimulationOptions, sky: &Arc<Environment>) -> Outcome<Vec<Time>> {
        let mut times = Vec::new();
        for samples in SAMPLES {
            let mut runs: Vec<(String, Vec<f64>)> = Vec::new();
            for round in 0..=options.repeats.get() {
                let mut took = Vec::new();
                let settings = settings(options.time_size, sky)?;
                let per_pixel = settings.samples * settings.samples;
                for (way, facets) in [("simulation", Facets::Walk), ("simulation, one facet", Facets::One)] {
                    let started = Instant::now();
                    let simulation = SimulationSettings { facets, seed: 0 };
                    let mut picture = self.stack.simulation(&[Shown::Material(0)], &settings, &simulation)?;
                    picture.add(if round == 0 { 1 } else { samples })?;
                    took.push((way, started.elapsed().as_secs_f64() * 1e3));
                }
                for (model, scene) in MODELS.iter().zip(&self.models) {
                    let environment_samples = if round == 0 { 1 } else { samples.div_ceil(per_pixel) };
                    let started = Instant::now();
                    scene.render(&[0], &RenderSettings { environment_samples, ..settings.clone() })?;
                    took.push((model.name(), started.elapsed().as_secs_f64() * 1e3));
                }
                for (i, (way, milliseconds)) in took.into_iter().enumerate() {
                    match runs.get_mut(i) {
                        Some((_, all)) => all.push(milliseconds),
                        // The first round compiles: its times do not count.
                        None => runs.push((way.to_owned(), Vec::new())),
                    }
                }
            }
            times.extend(runs.into_iter().map(|(way, runs)| Time {
                material: self.name.clone(),
                way,
                samples,
                spread: Spread::of(&runs),
            }));
        }
        Ok(times)
    }

    /// Pictures of the models against the simulated one.
    fn errors(&self, options: &SimulationOptions, skies: &[Arc<Environment>]) -> Outcome<Vec<Error>> {
        let errors = TURNS.iter().zip(skies).map(|((turn, _), sky)| {
            let settings = settings(options.size, sky)?;
            let mut simulation =
                self.stack.simulation(&[Shown::Material(0)], &settings, &SimulationSettings::default())?;
            simulation.add(options.samples.get())?;
            let (truth, noise) = (simulation.image(), mean_square(&simulation.noise()));
            let rms = self.models.iter().map(|scene| {
                let settings = RenderSettings { environment_samples: DIRECTIONS, ..settings.clone() };
                let image = scene.render(&[0], &settings)?;
                let compared = compare_pictures(&image, &truth, |v| v).map_err(Failure::input)?;
                Ok((compared.rms_err * compared.rms_err - noise).max(0.0).sqrt())
            });
            let mean = truth.data.iter().map(|v| f64::from(*v)).sum::<f64>() / truth.data.len() as f64;
            let rms = rms.collect::<Outcome<_>>()?;
            Ok(Error { material: self.name.clone(), turn: *turn, mean, noise: noise.sqrt(), rms })
        });
        errors.collect()
    }
}

/// A ball under surroundings alone, before black.
fn settings(size: u32, sky: &Arc<Environment>) -> Outcome<RenderSettings> {
    Ok(RenderSettings {
        size,
        lights: Vec::new(),
        environment: Arc::clone(sky),
        backdrop: luthier_gpu::Backdrop::Plain([0.0; 3]),
        ..RenderSettings::new(Shape::Sphere)?
    })
}

fn mean_square(image: &Image) -> f64 {
    image.data.iter().map(|v| f64::from(*v) * f64::from(*v)).sum::<f64>() / image.data.len() as f64
}

/// A material in the scene of a model, at the wavelengths of the simulation.
fn scene(gpu: &Gpu, material: &Material, model: ShadingModel) -> Outcome<Scene> {
    let mut shaded = material.clone();
    shaded.shade_by(model);
    shaded.bake.color = Some(ColorMode::ThreeWavelengths);
    let package = Bake::lit().package(&lit(&[shaded]), &MemoryStore::default())?;
    Ok(gpu.scene(&package, Form::Baked)?)
}

impl Time {
    fn json(&self) -> Value {
        let Self { material, way, samples, spread } = self;
        json!({ "material": material, "way": way, "samples": samples, "median_ms": spread.median, "mad_ms": spread.mad })
    }
}

impl Error {
    fn json(&self) -> Value {
        let Self { material, turn, mean, noise, rms } = self;
        let models: serde_json::Map<String, Value> =
            MODELS.iter().zip(rms).map(|(model, rms)| (model.name().to_owned(), json!(rms))).collect();
        json!({ "material": material, "turn_deg": turn, "mean": mean, "noise": noise, "rms_err": models })
    }
}

fn data(gpu: &Gpu, options: &SimulationOptions, times: &[Time], errors: &[Error]) -> Value {
    json!({
        "schema": SCHEMA,
        "generator": GENERATOR,
        "adapter": adapter_json(gpu),
        "clock": "host",
        "time_size": options.time_size,
        "repeats": options.repeats,
        "size": options.size,
        "samples": options.samples,
        "times": times.iter().map(Time::json).collect::<Vec<_>>(),
        "errors": errors.iter().map(Error::json).collect::<Vec<_>>(),
    })
}
