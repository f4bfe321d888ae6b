//! `textured`: materials whose maps vary them, at random places: shader, rows that ship and simulation, each against the next.

mod cases;
mod page;

use luthier::{Bake, MemoryStore, read_materials};
use luthier_export::GENERATOR;
use luthier_gpu::Gpu;
use luthier_layers::models::lobes::Lobes;
use luthier_manifest::ShadingModel;
use luthier_material::{Effects, Material, left_out};
use luthier_optics::stack::Film;
use luthier_report::{
    AT_PLACES, AtPlaces, PLACES_SEED, SimulatedAt, SimulatedSettings, Weights, at_places, simulated, simulated_by,
};
use luthier_terminal::{Bar, Outcome, Shaders, adapter_label, complain, deliver, open, valid};

use crate::cli::TexturedOptions;
use crate::lobes::{JUDGE_SEED, judge_settings};
use crate::parity::subject;

/// Angles of the eye at every place, degrees.
const THETAS_DEG: [f64; 9] = [0.0, 7.0, 30.0, 45.0, 60.0, 70.0, 77.0, 80.0, 85.0];

/// A material at its places.
#[derive(Debug)]
struct Judged {
    name: String,
    model: ShadingModel,
    at: AtPlaces,
    /// Names of features of the material that its model does not show.
    left_out: Vec<&'static str>,
    /// The worst view of the simulation that misses, and the errors of lobes that are fitted at that very place.
    worst: Option<(SimulatedAt, SimulatedAt)>,
}

impl Judged {
    /// True where the shader agrees with its tables.
    fn holds(&self) -> bool {
        self.at.shader.as_ref().is_none_or(|shader| shader.not_finite == 0 && shader.relative_dim.p99 <= AT_PLACES)
    }
}

/// Bakes and judges, as a page.
pub(crate) fn run(options: &TexturedOptions) -> Outcome {
    let mut materials = Vec::new();
    if !options.paths.is_empty() {
        for material in valid(read_materials(&options.paths)?, true)?.into_iter().filter(varies) {
            materials.extend(as_by_default(&material));
            materials.push(material);
        }
    }
    if !options.no_generated {
        materials.extend(cases::all());
    }
    materials.retain(|material| options.only.as_ref().is_none_or(|name| material.name == *name));
    let gpu = open(options.adapter.name.as_deref())?;
    let bar = Bar::new("judging");
    let mut judged = Vec::new();
    for (n, material) in (0..).zip(&materials) {
        judged.extend(judge(material, &gpu, options)?);
        bar.set(n + 1, materials.len() as u64);
    }
    drop(bar);
    let page = page::write(&judged, GENERATOR, &adapter_label(&gpu), options)?;
    deliver(&page, options.destination.output.as_deref())?;
    let broken: Vec<&Judged> = judged.iter().filter(|judged| !judged.holds()).collect();
    for Judged { name, at, .. } in &broken {
        complain(&format!("{name}: {:?}", at.shader.as_ref().and_then(|shader| shader.worst.as_ref())));
    }
    if broken.is_empty() { Ok(()) } else { Err(luthier_terminal::Failure::Verdict) }
}

/// Whether textures or effects make a material differ from place to place.
fn varies(material: &Material) -> bool {
    let has_maps = material.layers.iter().any(|layer| layer.varied().next().is_some());
    let film = material.stack.layers.first().and_then(|layer| layer.films.first());
    has_maps || material.effects != Effects::default() || film.is_some_and(Film::varies)
}

/// The material with the model that it would have if its file named none.
fn as_by_default(material: &Material) -> Option<Material> {
    let mut other = material.clone();
    other.bake.model = None;
    other.name = format!("{}-by-default", material.name);
    (other.model() != material.model()).then_some(other)
}

fn judge(material: &Material, gpu: &Gpu, options: &TexturedOptions) -> Outcome<Option<Judged>> {
    let bake = Bake { refuses: false, ..Bake::wgsl(&[]) };
    let package = bake.package(std::slice::from_ref(material), &MemoryStore::default())?;
    let shaders = Shaders::new(gpu, &package)?;
    let subject = subject(&package, vec![material.reflecting_stack().into_owned()])?;
    let device: &dyn luthier_report::Device = &shaders;
    let weights = if gpu.is_software() { Weights::Exact } else { Weights::EightBit };
    let found = at_places(&subject, 0, Some((device, weights)), options.pairs, PLACES_SEED);
    let Some(mut at) = found.map_err(luthier_terminal::Failure::input)? else { return Ok(None) };
    let settings = SimulatedSettings {
        places: options.places,
        thetas_deg: THETAS_DEG.to_vec(),
        reference: judge_settings(&options.precision, JUDGE_SEED),
        seed: PLACES_SEED,
    };
    at.simulated = simulated(&subject, 0, &settings).map_err(luthier_terminal::Failure::input)?;
    let misses = at.simulated.iter().flat_map(|found| found.misses());
    let worst = misses.max_by(|a, b| a.excess().total_cmp(&b.excess())).cloned();
    let worst = worst.and_then(|worst| {
        let again = simulated_by(&subject, 0, &settings, &worst, &Lobes::of)?;
        Some((worst, again))
    });
    let model = package.manifest.materials[0].model;
    let left_out = left_out(material, model).iter().map(|part| part.feature.name()).collect();
    Ok(Some(Judged { name: material.name.clone(), model, at, left_out, worst }))
}
