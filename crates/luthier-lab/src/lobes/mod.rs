//! `lobes`: errors of fitted lobes against the simulation, for materials, for their twins in the other distribution, and for random stacks.

mod page;
mod reasons;
mod stacks;

use std::fmt::Write as _;
use std::sync::atomic::{AtomicU64, Ordering};

use luthier::read_materials;
use luthier_layers::models::lobes::{EXCESS, FitSettings, Lobes, Simulation, most_lobes, shown};
use luthier_layers::registry::model;
use luthier_optics::color::Color;
use luthier_optics::stack::Stack;
use luthier_report::{ModelSubject, Reference, ReferenceSettings, Shown, ViewError};
use luthier_terminal::{Bar, Failure, Outcome, deliver, valid};
use rayon::prelude::*;

use self::reasons::Reasons;
use crate::cli::{LobesOptions, Precision};

pub(crate) use self::stacks::{anisotropic, material, of, random};

/// Angles of the judge against the normal, degrees: the angles of `luthier-lab judge`, and others between.
pub(crate) const THETAS_DEG: [f64; 9] = [0.0, 7.0, 30.0, 45.0, 60.0, 70.0, 77.0, 80.0, 85.0];

/// Models of papers for comparison.
const BESIDE: [&str; 2] = ["belcour", "elek"];

/// Standard error that albedos of the judge may have.
const ALBEDO_STD_ERR: f64 = 7e-4;

/// Family of random numbers of the judge; fits have 0.
pub(crate) const JUDGE_SEED: u64 = 1 << 40;

/// Number of the quantities that are judged: lobe errors and albedo errors.
pub(crate) const QUANTITIES: usize = 2;

/// Errors that a stack should not exceed, by quantity.
const LIMITS: [f64; QUANTITIES] = [0.05, 0.003];

/// Number of random stacks, for each quantity, whose errors are traced to a reason.
const WORST: usize = 10;

/// A stack, fitted and judged.
struct Judged {
    name: String,
    lobes: Lobes,
    errors: Vec<ViewError>,
    /// For each of [`BESIDE`].
    beside: Vec<Vec<ViewError>>,
    /// Paths of the judge.
    paths: u64,
    /// Reasons of the errors, where they were looked for.
    reasons: Option<Reasons>,
}

impl Judged {
    /// Largest error of a quantity.
    fn error(&self, quantity: usize) -> f64 {
        largest(&self.errors)[quantity]
    }
}

/// The errors of a view by quantity.
fn of_view(view: &ViewError) -> [f64; QUANTITIES] {
    [view.lobe.error, view.albedo.error]
}

/// Median, 95th percentile and largest; 0 of no values.
pub(crate) fn ranks(values: impl Iterator<Item = f64>) -> [f64; 3] {
    let mut values: Vec<f64> = values.collect();
    values.sort_by(f64::total_cmp);
    let Some(last) = values.len().checked_sub(1) else { return [0.0; 3] };
    let middle = values.len() / 2;
    let median = 0.5 * (values[last - middle] + values[middle]);
    [median, values[(values.len() * 95 / 100).min(last)], values[last]]
}

/// The largest errors of views by quantity.
pub(crate) fn largest(views: &[ViewError]) -> [f64; QUANTITIES] {
    views.iter().map(of_view).fold([0.0; QUANTITIES], |most, errors| [0, 1].map(|q: usize| most[q].max(errors[q])))
}

/// Stacks of a group whose errors are traced to a reason.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Choice {
    /// Those with errors beyond the limit.
    Beyond,
    /// Those with the largest errors, [`WORST`] of them.
    Worst,
}

impl Choice {
    /// Numbers of the stacks whose error of a quantity is looked into, the largest first.
    fn of(self, stacks: &[&Judged], quantity: usize) -> Vec<usize> {
        let errors: Vec<f64> = stacks.iter().map(|stack| stack.error(quantity)).collect();
        let mut numbers: Vec<usize> = (0..stacks.len()).collect();
        numbers.sort_by(|a, b| errors[*b].total_cmp(&errors[*a]));
        match self {
            Self::Beyond => numbers.retain(|number| errors[*number] > LIMITS[quantity]),
            Self::Worst => numbers.truncate(WORST),
        }
        numbers
    }
}

/// A group of stacks with its title, and the choice of those whose errors are traced.
struct Group {
    title: &'static str,
    stacks: Vec<Judged>,
    choice: Choice,
}

/// Fits and judges, as a page.
pub(crate) fn run(options: &LobesOptions) -> Outcome {
    let materials = valid(read_materials(&options.sources.paths)?, false)?;
    let groups: [(&str, Choice, Vec<ModelSubject>); 3] = [
        ("Materials", Choice::Beyond, materials.iter().map(|material| stacks::of(material, false)).collect()),
        (
            "Twins in the other distribution",
            Choice::Beyond,
            materials.iter().map(|material| stacks::of(material, true)).collect(),
        ),
        ("Random stacks", Choice::Worst, (0..options.random.into()).map(stacks::random).collect()),
    ];
    let total = groups.iter().map(|(.., subjects)| subjects.len()).sum::<usize>() as u64;
    let (bar, done) = (Bar::new("fitting and judging"), AtomicU64::new(0));
    let judged = groups.iter().filter(|(.., subjects)| !subjects.is_empty()).map(|(title, choice, subjects)| Group {
        title,
        stacks: judge_all(subjects, *choice, options, &|| bar.set(done.fetch_add(1, Ordering::Relaxed) + 1, total)),
        choice: *choice,
    });
    let judged: Vec<Group> = judged.collect();
    drop(bar);
    let page = page::page(&judged, options).map_err(Failure::input)?;
    deliver(&page, options.destination.output.as_deref())
}

/// Judges stacks, and looks for the reasons of the errors of some of them.
fn judge_all(
    subjects: &[ModelSubject],
    choice: Choice,
    options: &LobesOptions,
    progress: &(dyn Fn() + Sync),
) -> Vec<Judged> {
    let mut judged: Vec<(Judged, Reference)> =
        subjects.par_iter().map(|subject| judge(subject, options)).inspect(|_| progress()).collect();
    let stacks: Vec<&Judged> = judged.iter().map(|(stack, _)| stack).collect();
    let mut chosen: Vec<usize> = (0..QUANTITIES).flat_map(|quantity| choice.of(&stacks, quantity)).collect();
    chosen.sort_unstable();
    chosen.dedup();
    let reasons = chosen.par_iter().map(|&number| {
        let (stack, reference) = &judged[number];
        Reasons::of(&subjects[number], stack, reference, options)
    });
    let reasons: Vec<Reasons> = reasons.collect();
    chosen.into_iter().zip(reasons).for_each(|(number, reasons)| judged[number].0.reasons = Some(reasons));
    judged.into_iter().map(|(stack, _)| stack).collect()
}

/// A table of errors by stack and column, with errors of another fit in brackets, and with medians.
pub(crate) fn table(
    out: &mut String,
    [title, kind]: [&str; 2],
    columns: &[String],
    rows: &[(String, Vec<[f64; 2]>)],
) -> std::fmt::Result {
    let rule = "--:|".repeat(columns.len());
    writeln!(out, "\n## {title}\n\n| stack | {kind} | lobes | {} |\n|---|---|--:|{rule}", columns.join(" | "))?;
    for (stack, errors) in rows {
        writeln!(out, "| {stack} |{}", errors.iter().map(cell).collect::<String>())?;
    }
    let medians = (0..columns.len()).map(|c| [0, 1].map(|fit: usize| median(rows.iter().map(|row| row.1[c][fit]))));
    writeln!(out, "| **median** | | |{}", medians.map(|errors| cell(&errors)).collect::<String>())
}

fn cell([own, beside]: &[f64; 2]) -> String {
    format!(" {own:.3} ({beside:.3}) |")
}

fn median(values: impl Iterator<Item = f64>) -> f64 {
    let mut values: Vec<f64> = values.collect();
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied().unwrap_or(0.0)
}

/// Settings of the judge, with a family of random numbers.
pub(crate) fn judge_settings(precision: &Precision, seed: u64) -> ReferenceSettings {
    let Precision { noise, samples } = *precision;
    ReferenceSettings { noise, albedo_std_err: ALBEDO_STD_ERR, most: samples.get().into(), seed }
}

/// Settings of the fit.
fn fit_settings(options: &LobesOptions) -> FitSettings {
    let (rows, paths) = (options.rows as usize, u64::from(options.paths_per_row.get()));
    FitSettings { rows, paths, ..FitSettings::default() }
}

/// The simulated light of a stack, as in bakes.
fn simulated(stack: &Stack, wavelengths_nm: [f64; 3], settings: FitSettings) -> Simulation {
    Simulation::new(&shown(stack), &Color::ThreeWavelengths(wavelengths_nm), settings)
}

fn judge(subject: &ModelSubject, options: &LobesOptions) -> (Judged, Reference) {
    let simulation = simulated(&subject.stack, subject.wavelengths_nm, fit_settings(options));
    let lobes = simulation.fit_fewest(most_lobes(&subject.stack), EXCESS);
    let reference = Reference::new(subject, &THETAS_DEG, judge_settings(&options.precision, JUDGE_SEED));
    let beside = BESIDE.iter().filter_map(|name| model(name));
    let judged = Judged {
        name: subject.name.clone(),
        errors: reference.errors(Shown::Lobes(&lobes)),
        beside: beside.map(|model| reference.errors(Shown::Model(model.as_ref()))).collect(),
        paths: reference.paths(),
        lobes,
        reasons: None,
    };
    (judged, reference)
}
