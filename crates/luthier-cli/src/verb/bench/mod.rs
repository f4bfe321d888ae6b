//! `bench`: shaders timed on the adapter at hand.

mod per_pixel;
mod rows;
mod subjects;
mod text;

use luthier::read_materials;
use luthier_cost::Timing;
use luthier_export::GENERATOR;
use luthier_gpu::{Gpu, Stopwatch, Workload};
use luthier_material::Material;
use luthier_report::{Pair, ParitySet};
use luthier_terminal::{Bar, Failure, Outcome, adapter_json, deliver, open, valid};
use serde::Serialize;
use serde_json::Value;

use crate::cli::BenchOptions;
use crate::verb::bench_fit;
use per_pixel::{PerPixel, per_pixel};
use rows::{Row, rows_of};
use subjects::subjects;

/// Pairs of directions, near the mirror direction and anywhere by halves: few enough for any cache.
const PAIRS: u32 = 1024;

/// Version of the JSON.
const SCHEMA: u32 = 2;

/// The result; docs/measurements/README.md describes it.
#[derive(Debug, Serialize)]
pub(crate) struct Bench {
    pub(crate) schema: u32,
    pub(crate) generator: &'static str,
    pub(crate) adapter: Value,
    /// `device` for timestamp queries, `host` where the adapter has none: submission and waiting are then part of every time.
    pub(crate) clock: &'static str,
    pub(crate) evaluations: u32,
    pub(crate) warm_up: u32,
    pub(crate) repeats: u32,
    /// Shaders of single materials, and yardsticks.
    pub(crate) rows: Vec<Row>,
    /// Sets whose materials are chosen for each pixel.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub(crate) per_pixel: Vec<PerPixel>,
}

/// Times shaders on the adapter at hand.
pub(crate) fn run(options: &BenchOptions) -> Outcome {
    if options.json && options.fit.as_deref().is_some_and(bench_fit::is_printed_alone) {
        return Err(Failure::Usage(anyhow::anyhow!("with --json, --fit writes the costs to a file: name it")));
    }
    let materials = valid(read_materials(&options.sources.paths)?, true)?;
    per_pixel::refuse(options, materials.len())?;
    let gpu = open(options.adapter.as_deref())?;
    let mut bench = Bench {
        schema: SCHEMA,
        generator: GENERATOR,
        adapter: adapter_json(&gpu),
        clock: "device",
        evaluations: 0,
        warm_up: options.warm_up,
        repeats: options.repeats.get(),
        rows: Vec::new(),
        per_pixel: Vec::new(),
    };
    let mut timings = Vec::new();
    if options.per_pixel.is_empty() {
        timings = bench.time_singly(&gpu, &materials, options)?;
    } else {
        per_pixel(&gpu, &materials, options, &mut bench)?;
    }
    let fit = options.fit.as_deref().map(|file| bench_fit::fitted(&gpu, &timings, file)).transpose()?;
    let text = if options.json {
        format!("{:#}\n", serde_json::to_value(&bench).map_err(Failure::input)?)
    } else {
        bench.to_text(&gpu) + &fit.map_or_else(String::new, |fit| format!("\n{fit}"))
    };
    deliver(&text, options.output.as_deref())
}

impl Bench {
    /// Times every shader of every material, and the yardsticks. Returns the times of those whose operations were counted.
    fn time_singly(&mut self, gpu: &Gpu, materials: &[Material], options: &BenchOptions) -> Outcome<Vec<Timing>> {
        let mut timings = Vec::new();
        let bar = Bar::new("timing");
        for (n, material) in materials.iter().enumerate() {
            let subjects = subjects(gpu, material, options)?;
            let pairs = pairs(material);
            let mut watches = Vec::new();
            for &lights in &options.lights {
                let workload = Workload { lights, ..Workload::single(0, options.evaluations) };
                for (i, subject) in subjects.iter().enumerate() {
                    if i == 0 {
                        watches.push(subject.scene.stopwatch(&pairs, workload.empty())?);
                    }
                    watches.push(subject.scene.stopwatch(&pairs, workload)?);
                }
            }
            let times = self.time(&watches)?;
            let times: Vec<_> = times.chunks(subjects.len() + 1).collect();
            for (i, (&lights, times)) in options.lights.iter().zip(times).enumerate() {
                let own = rows_of(material, &subjects, lights, times);
                timings.extend(own.iter().zip(&subjects).filter_map(|(row, subject)| {
                    // Counts are those of all lights of a view.
                    let time = 1e3 * row.net_ns * f64::from(lights);
                    Some(Timing {
                        material: row.material.clone(),
                        model: row.shader().to_owned(),
                        counts: *subject.counts.get(i)?,
                        time,
                    })
                }));
                self.rows.extend(own);
            }
            bar.set(n as u64 + 1, materials.len() as u64);
        }
        Ok(timings)
    }

    /// Nanoseconds per evaluation of some watches, which take turns.
    fn time(&mut self, watches: &[Stopwatch<'_>]) -> Outcome<Vec<Vec<f64>>> {
        if let Some(watch) = watches.first() {
            self.evaluations = watch.evaluations();
            self.clock = if watch.has_timestamps() { "device" } else { "host" };
        }
        Ok(Stopwatch::in_turn(watches, self.warm_up, self.repeats)?)
    }
}

/// Pairs of directions for a material.
fn pairs(material: &Material) -> Vec<Pair> {
    let layers = luthier_layers::layers::Layers::isotropic_rgb(&material.stack).layers;
    [ParitySet::Uniform, ParitySet::NearSpecular].iter().flat_map(|set| set.pairs(PAIRS / 2, &layers)).collect()
}
