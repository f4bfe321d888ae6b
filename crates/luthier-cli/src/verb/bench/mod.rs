//! `bench`: shaders timed on the adapter at hand.

mod rows;
mod subjects;
mod text;

use luthier::read_materials;
use luthier_export::GENERATOR;
use luthier_gpu::Stopwatch;
use luthier_report::ParitySet;
use luthier_terminal::{Bar, Failure, Outcome, adapter_json, deliver, open, valid};
use serde::Serialize;
use serde_json::Value;

use crate::cli::BenchOptions;
use rows::{Row, rows_of};
use subjects::subjects;

/// Pairs of directions, near the mirror direction and anywhere by halves: few enough for any cache.
const PAIRS: u32 = 1024;

/// Version of the JSON.
const SCHEMA: u32 = 1;

/// The result; docs/measurements/README.md describes it.
#[derive(Debug, Serialize)]
struct Bench {
    schema: u32,
    generator: &'static str,
    adapter: Value,
    /// `device` for timestamp queries, `host` where the adapter has none: submission and waiting are then part of every time.
    clock: &'static str,
    evaluations: u32,
    warm_up: u32,
    repeats: u32,
    rows: Vec<Row>,
}

/// Times shaders on the adapter at hand.
pub(crate) fn run(options: &BenchOptions) -> Outcome {
    let materials = valid(read_materials(&options.sources.paths)?, true)?;
    let gpu = open(options.adapter.as_deref())?;
    let bar = Bar::new("timing");
    let mut rows = Vec::new();
    let (mut evaluations, mut has_timestamps) = (0, true);
    for (n, material) in materials.iter().enumerate() {
        let subjects = subjects(&gpu, material, options)?;
        let layers = luthier_layers::layers::Layers::isotropic_rgb(&material.stack).layers;
        let pairs: Vec<luthier_report::Pair> = [ParitySet::Uniform, ParitySet::NearSpecular]
            .iter()
            .flat_map(|set| set.pairs(PAIRS / 2, &layers))
            .collect();
        let mut watches = Vec::new();
        for (i, subject) in subjects.iter().enumerate() {
            let kernels: &[bool] = if i == 0 { &[true, false] } else { &[false] };
            for &is_empty in kernels {
                watches.push(subject.scene.stopwatch(0, &pairs, options.evaluations, is_empty)?);
            }
        }
        let times = Stopwatch::in_turn(&watches, options.warm_up, options.repeats.get())?;
        if let Some(watch) = watches.first() {
            (evaluations, has_timestamps) = (watch.evaluations(), watch.has_timestamps());
        }
        rows.extend(rows_of(material, &subjects, &times));
        bar.set(n as u64 + 1, materials.len() as u64);
    }
    drop(bar);
    let bench = Bench {
        schema: SCHEMA,
        generator: GENERATOR,
        adapter: adapter_json(&gpu),
        clock: if has_timestamps { "device" } else { "host" },
        evaluations,
        warm_up: options.warm_up,
        repeats: options.repeats.get(),
        rows,
    };
    let text = if options.json {
        format!("{:#}\n", serde_json::to_value(&bench).map_err(Failure::input)?)
    } else {
        bench.to_text(&gpu)
    };
    deliver(&text, options.output.as_deref())
}
