//! `ladder`: what limits on the errors of lobes take and cost, for materials, random stacks and coats of engines, and the chart of error against time.

mod chart;
mod page;
mod rivals;
mod steps;

use std::path::Path;
use std::sync::atomic::{AtomicU64, Ordering};

use luthier::read_materials;
use luthier_cost::DeviceCost;
use luthier_manifest::ColorMode;
use luthier_material::{BakeSettings, Material};
use luthier_optics::interface::Interface;
use luthier_optics::stack::Stack;
use luthier_report::{ModelSubject, Reference};
use luthier_shader::{Yardstick, count};
use luthier_terminal::{Bar, Failure, Outcome, deliver, valid};
use rayon::prelude::*;

use self::rivals::{Rival, rivals};
use self::steps::{Taken, costs, steps};
use crate::cli::{LadderChartOptions, LadderOptions};
use crate::coats::{Drawn, coated};
use crate::lobes::{JUDGE_SEED, THETAS_DEG, judge_settings, material, random};

/// Device whose costs the page has.
const DEVICE: &str = "h100";

/// Least interfaces of random stacks, diffuse bases apart.
const INTERFACES: usize = 2;

/// A stack as a material.
struct Subject {
    /// Name of the stack on the page.
    name: String,
    material: Material,
    /// The stack, where it is judged.
    judged: Option<ModelSubject>,
    /// The stack by formulas of engines.
    drawn: Vec<Drawn>,
}

/// A stack with what it takes, and with models beside where it is judged.
struct Measured {
    name: String,
    taken: Vec<Taken>,
    rivals: Vec<Rival>,
}

/// Stacks of a kind.
struct Group {
    title: &'static str,
    /// Whether models stand beside.
    is_judged: bool,
    stacks: Vec<Measured>,
}

/// Outlines every material as each limit asks and prints a page; draws the chart.
pub(crate) fn run(options: &LadderOptions) -> Outcome {
    let materials = valid(read_materials(&options.sources.paths)?, true)?;
    let device = device()?;
    let yardstick = costs(&device, |lights| count(&Yardstick::GltfClearcoat.wgsl(), &[], lights))?;
    let is_judged = options.chart.is_some();
    let (families, shipped): (Vec<Material>, Vec<Material>) =
        materials.into_iter().partition(|material| material.family().is_some());
    let twins: Vec<Subject> =
        shipped.iter().map(|material| Subject::of(crate::lobes::of(material, true), false, Vec::new())).collect();
    let [families, shipped] = [families, shipped].map(|materials| {
        let subject =
            |material: Material| Subject { name: material.name.clone(), material, judged: None, drawn: Vec::new() };
        materials.into_iter().map(subject).collect::<Vec<Subject>>()
    });
    let coats = if is_judged { options.coats.unwrap_or(usize::MAX) } else { 0 };
    let coats = coated().into_iter().take(coats).map(|coat| Subject::of(coat.subject, true, coat.drawn));
    let coats: Vec<Subject> = coats.collect();
    let stacks = (0..).map(random).filter(|subject| interfaces(&subject.stack) >= INTERFACES);
    let stacks = stacks.take(options.stacks as usize).map(|subject| Subject::of(subject, is_judged, Vec::new()));
    let stacks: Vec<Subject> = stacks.collect();
    let groups = [
        ("Materials", false, shipped),
        ("Twins in the other distribution", false, twins),
        ("Materials with textures", false, families),
        ("Coats of engines", is_judged, coats),
        ("Random stacks", is_judged, stacks),
    ];
    let total = groups.iter().map(|(.., subjects)| subjects.len()).sum::<usize>() as u64;
    let (bar, done) = (Bar::new("fitting and judging"), AtomicU64::new(0));
    let mut measured = Vec::new();
    for (title, is_judged, subjects) in groups.into_iter().filter(|(.., subjects)| !subjects.is_empty()) {
        let stacks = subjects.par_iter().map(|subject| {
            let found = measure(subject, &device, options);
            bar.set(done.fetch_add(1, Ordering::Relaxed) + 1, total);
            found
        });
        let stacks: Vec<Measured> = stacks.collect::<Outcome<Vec<Option<Measured>>>>()?.into_iter().flatten().collect();
        if !stacks.is_empty() {
            measured.push(Group { title, is_judged, stacks });
        }
    }
    drop(bar);
    let page = page::page(&measured, &device, &yardstick, options).map_err(Failure::input)?;
    if let Some(path) = &options.chart {
        draw(&page, &device, Some(path))?;
    }
    deliver(&page, options.destination.output.as_deref())
}

/// Draws the chart of a page that is there.
pub(crate) fn redraw(options: &LadderChartOptions) -> Outcome {
    let page = std::fs::read_to_string(&options.page)
        .map_err(|error| Failure::Files(anyhow::anyhow!("{}: {error}", options.page.display())))?;
    draw(&page, &device()?, options.destination.output.as_deref())
}

fn draw(page: &str, device: &DeviceCost, path: Option<&Path>) -> Outcome {
    let chart = chart::chart(page, &device.device);
    deliver(
        &chart.ok_or_else(|| {
            Failure::Usage(anyhow::anyhow!("the page has no stacks that were judged: `ladder --chart` judges them"))
        })?,
        path,
    )
}

fn device() -> Outcome<DeviceCost> {
    DeviceCost::shipped(DEVICE).ok_or_else(|| Failure::Usage(anyhow::anyhow!("no costs of {DEVICE}")))
}

impl Subject {
    /// A stack that no file describes.
    fn of(subject: ModelSubject, is_judged: bool, drawn: Vec<Drawn>) -> Self {
        let bake = BakeSettings {
            color: Some(ColorMode::ThreeWavelengths),
            wavelengths_nm: Some(subject.wavelengths_nm),
            ..BakeSettings::default()
        };
        Self {
            name: subject.name.clone(),
            material: material("stack".to_owned(), subject.stack.clone(), bake),
            judged: is_judged.then_some(subject),
            drawn,
        }
    }
}

/// Number of interfaces that refract or mirror light.
fn interfaces(stack: &Stack) -> usize {
    (0..stack.layers.len()).filter(|layer| Interface::of(stack, *layer).is_some()).count()
}

fn measure(subject: &Subject, device: &DeviceCost, options: &LadderOptions) -> Outcome<Option<Measured>> {
    let settings = judge_settings(&options.precision, JUDGE_SEED);
    let reference = subject.judged.as_ref().map(|judged| Reference::new(judged, &THETAS_DEG, settings));
    let Some(taken) = steps(&subject.material, reference.as_ref(), device)? else { return Ok(None) };
    let rivals = reference.map(|reference| rivals(&subject.material, &subject.drawn, &reference, device));
    let rivals = rivals.transpose()?.unwrap_or_default();
    Ok(Some(Measured { name: subject.name.clone(), taken, rivals }))
}
