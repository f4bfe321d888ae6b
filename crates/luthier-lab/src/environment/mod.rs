//! `environment`: pictures under detailed surroundings, against sums over every texel of these.

mod cost;
mod page;
mod pictures;

use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

use luthier::{Bake, MemoryStore, lit, read_materials};
use luthier_environment::{Environment, Scenery};
use luthier_gpu::Gpu;
use luthier_manifest::{ColorMode, Form, FunctionGroup, ShadingModel};
use luthier_material::{BakeSettings, Material};
use luthier_optics::stack::{Base, Layer};
use luthier_report::ModelSubject;
use luthier_terminal::{Bar, Failure, Outcome, deliver, open, valid};
use rayon::prelude::*;

use self::cost::Costs;
use self::page::Page;
use self::pictures::{Pictures, Point, Shown, Texel, error, mean, points, texels};
use crate::cli::EnvironmentOptions;

/// Models that are measured in addition to `lobes`.
const PAPERS: [ShadingModel; 2] = [ShadingModel::Elek, ShadingModel::Belcour];

/// Groups of functions with ever more reads for each lobe; the last is the default.
const STEPS: [FunctionGroup; 4] =
    [FunctionGroup::Environment1, FunctionGroup::Environment2, FunctionGroup::Environment4, FunctionGroup::Environment];

/// Surroundings that are measured: the hardest, by which directions and blurs were chosen, and one beside.
const SKIES: [Scenery; 4] = [Scenery::CloudySun, Scenery::StripStudio, Scenery::NightStreet, Scenery::EveningRoom];

/// How many of [`SKIES`] directions and blurs were chosen by.
const CHOSEN_BY: usize = 3;

/// Least slope parameter of random stacks: sums resolve no narrower lobes.
const ALPHA_MIN: f64 = 0.1;

/// Errors of a step under a sky, with the default samples of a pixel and with one.
type Errors = [f64; 2];

/// A material under a sky.
struct Row {
    material: String,
    sky: Scenery,
    /// Slope parameter of the first interface.
    alpha: f64,
    /// Mean of the sum.
    mean: f64,
    /// By step.
    steps: Vec<Errors>,
    /// For each of [`PAPERS`], against its own sum and against that of lobes; none of random stacks.
    papers: Vec<[f64; 2]>,
    /// Whether directions and blurs were chosen by this pair.
    is_chosen_by: bool,
}

/// Compares pictures of materials.
pub(crate) fn run(options: &EnvironmentOptions) -> Outcome {
    let gpu = open(options.adapter.name.as_deref())?;
    let materials = valid(read_materials(&options.sources.paths)?, false)?;
    let skies: Vec<Arc<Environment>> = SKIES
        .into_iter()
        .map(|scenery| scenery.environment(options.rows).map(Arc::new))
        .collect::<Result<_, _>>()
        .map_err(Failure::input)?;
    let (points, texels) = (points(options.size), texels(&skies));
    let random = (0..).map(crate::lobes::random).filter(is_resolved).take(options.random as usize).map(|subject| {
        let wavelengths_nm = Some(subject.wavelengths_nm);
        let color = Some(ColorMode::ThreeWavelengths);
        (subject.name, subject.stack, BakeSettings { color, wavelengths_nm, ..BakeSettings::default() })
    });
    let random =
        random.map(|(name, stack, bake)| (name, crate::lobes::material("stack".to_owned(), stack, bake), false));
    let given = materials.iter().map(|material| (material.name.clone(), material.clone(), true));
    let all: Vec<(String, Material, bool)> = given.chain(random).collect();
    let (bar, done) = (Bar::new("materials"), AtomicU64::new(0));
    let rows = all.par_iter().map(|(name, material, is_given)| {
        let rows = measure(&gpu, (name, material, *is_given), &points, &skies, &texels);
        bar.set(done.fetch_add(1, Ordering::Relaxed) + 1, all.len() as u64);
        rows
    });
    let rows = rows.collect::<Outcome<Vec<Vec<Row>>>>()?.into_iter().flatten().collect();
    drop(bar);
    let costs = materials.iter().map(Costs::of).collect::<Outcome<_>>()?;
    let bytes = cost::bytes(skies[0].level_size());
    let theta_max_deg = points.iter().map(Point::theta_deg).fold(0.0, f64::max);
    let page = Page { rows, costs, places: points.len(), theta_max_deg, bytes, options };
    deliver(&page.text(), options.destination.output.as_deref())
}

/// Whether a random stack has two interfaces that sums resolve.
fn is_resolved(subject: &ModelSubject) -> bool {
    let is_base = |layer: &Layer| matches!(layer.base, Base::Diffuse(_));
    let interfaces: Vec<&Layer> = subject.stack.layers.iter().filter(|layer| !is_base(layer)).collect();
    interfaces.len() == 2 && interfaces.iter().all(|layer| layer.surface.alpha_x > ALPHA_MIN && layer.films.is_empty())
}

/// A material under each sky; models of papers are measured of given ones.
fn measure(
    gpu: &Gpu,
    (name, material, is_given): (&str, &Material, bool),
    points: &[Point],
    skies: &[Arc<Environment>],
    texels: &[Texel],
) -> Outcome<Vec<Row>> {
    let lobes = Pictures::new(gpu, material, ShadingModel::Lobes, points, skies, texels)?;
    let papers: Vec<Pictures> = PAPERS
        .iter()
        .filter(|_| is_given)
        .map(|model| Pictures::new(gpu, material, *model, points, skies, texels))
        .collect::<Outcome<_>>()?;
    let mut rows: Vec<Row> = SKIES
        .into_iter()
        .enumerate()
        .map(|(number, sky)| {
            let truth = &lobes.summed[number];
            let papers = papers.iter().map(|paper| {
                let shown = &paper.shown[number].of_all;
                [error(shown, &paper.summed[number]), error(shown, truth)]
            });
            Row {
                material: name.to_owned(),
                sky,
                alpha: lobes.alpha,
                mean: mean(truth),
                steps: Vec::new(),
                papers: papers.collect(),
                is_chosen_by: is_given && number < CHOSEN_BY,
            }
        })
        .collect();
    let mut shaded = material.clone();
    shaded.bake.model = Some(ShadingModel::Lobes);
    let store = MemoryStore::default();
    for step in STEPS {
        let functions = [step, FunctionGroup::Sample].into_iter().collect();
        let package = Bake { functions, ..Bake::lit() }.package(&lit(&[shaded.clone()]), &store)?;
        let scene = gpu.scene(&package, Form::Baked)?;
        for ((row, sky), truth) in rows.iter_mut().zip(skies).zip(&lobes.summed) {
            let Shown { of_all, of_one } = Shown::new(&scene, points, sky)?;
            row.steps.push([error(&of_all, truth), error(&of_one, truth)]);
        }
    }
    Ok(rows)
}
