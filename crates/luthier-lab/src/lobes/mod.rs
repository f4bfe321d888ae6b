//! `lobes`: how near fits of lobes come to the simulation, on materials, on their twins in the other distribution, and on random stacks.

mod page;
mod stacks;

use std::sync::atomic::{AtomicU64, Ordering};

use luthier_export::read;
use luthier_layers::lobes::{Channel, EXCESS, FitSettings, LOBES, Lobes, Simulation};
use luthier_layers::model::Model;
use luthier_layers::registry::model;
use luthier_optics::color::Color;
use luthier_report::{ModelSettings, ModelSubject, ViewError, judge_views};
use luthier_terminal::{Bar, Failure, Outcome, deliver, valid};
use rayon::prelude::*;

use crate::cli::LobesOptions;

pub(crate) use self::stacks::{anisotropic, of, random};

/// Angles of the judge against the normal, degrees: those of `luthier-lab judge`, and others between.
const THETAS_DEG: [f64; 10] = [0.0, 7.0, 18.0, 30.0, 45.0, 60.0, 70.0, 77.0, 80.0, 85.0];

/// Numbers of lobes that are fitted.
const COUNTS: [usize; 3] = [0, 1, 2];

/// Models of papers beside them.
const BESIDE: [&str; 2] = ["belcour", "elek"];

/// Family of random numbers of the judge; fits have 0.
pub(crate) const JUDGE_SEED: u64 = 1 << 40;

/// A stack, fitted and judged.
struct Judged {
    name: String,
    /// For each of [`COUNTS`]: the lobes, and the errors of all views.
    fits: Vec<(Lobes, Vec<ViewError>)>,
    /// Lobes of them that a bake takes.
    baked: usize,
    /// For each of [`BESIDE`].
    beside: Vec<Vec<ViewError>>,
}

/// A stack, judged or refused.
type Outcomes = Vec<Result<Judged, String>>;

/// Fits and judges, as a page.
pub(crate) fn run(options: &LobesOptions) -> Outcome {
    let materials = valid(read(&options.sources.paths)?, false)?;
    let groups: [Vec<ModelSubject>; 3] = [
        materials.iter().map(|material| stacks::of(material, false)).collect(),
        materials.iter().map(|material| stacks::of(material, true)).collect(),
        (0..options.random.into()).map(stacks::random).collect(),
    ];
    let total = groups.iter().map(Vec::len).sum::<usize>() as u64;
    let (bar, done) = (Bar::new("fitting and judging"), AtomicU64::new(0));
    let judged: [Outcomes; 3] = groups.each_ref().map(|subjects| {
        let outcome = |subject: &ModelSubject| {
            let judged = judge(subject, options);
            bar.set(done.fetch_add(1, Ordering::Relaxed) + 1, total);
            judged
        };
        subjects.par_iter().map(outcome).collect()
    });
    drop(bar);
    let page = page::page(&judged, options).map_err(Failure::input)?;
    deliver(&page, options.destination.output.as_deref())
}

fn judge(subject: &ModelSubject, options: &LobesOptions) -> Result<Judged, String> {
    let color = Color::ThreeWavelengths(subject.wavelengths_nm);
    let settings = FitSettings {
        rows: options.rows as usize,
        paths: u64::from(options.paths_per_row.get()),
        ..FitSettings::default()
    };
    let simulation = Simulation::new(&subject.stack, &color, settings);
    let fits: Vec<Lobes> = COUNTS.map(|lobes| simulation.fit(lobes)).to_vec();
    let baked = simulation.fit_fewest(LOBES, EXCESS).rows[0].lobes.len();
    let models = |channel: usize| -> Vec<Box<dyn Model + '_>> {
        let own = fits.iter().map(|lobes| Box::new(Channel { lobes, channel }) as Box<dyn Model>);
        own.chain(BESIDE.iter().filter_map(|name| model(name))).collect()
    };
    let judge = ModelSettings { samples: options.samples, seed: JUDGE_SEED };
    let mut views = judge_views(subject, models, &THETAS_DEG, judge);
    let beside = views.split_off(fits.len());
    let fits = fits.into_iter().zip(views).collect();
    Ok(Judged { name: subject.name.clone(), fits, baked, beside })
}
