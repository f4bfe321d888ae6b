//! `bench`: shaders timed on the adapter at hand.

use luthier_export::{GENERATOR, Package, Shader, read};
use luthier_gpu::{Gpu, Scene, Stopwatch};
use luthier_manifest::ShadingModel;
use luthier_material::Material;
use luthier_report::ParitySet;
use luthier_shader::{Form, MaterialSet, Target};
use serde::Serialize;

use crate::cli::BenchOptions;
use crate::cost_page::{label, reads_d};
use crate::device::{device, open};
use crate::failure::{Failure, Outcome, files};
use crate::materials::valid;
use crate::memory_bake::bake;
use crate::output::print;
use crate::progress::Bar;

/// Pairs of directions, near the mirror direction and anywhere by halves: few enough for any cache.
const PAIRS: u32 = 1024;

/// Version of the JSON.
const SCHEMA: u32 = 1;

/// The result; docs/measurements/README.md describes it.
#[derive(Debug, Serialize)]
struct Bench {
    schema: u32,
    generator: &'static str,
    adapter: Adapter,
    /// `device` for timestamp queries, `host` where the adapter has none: submission and waiting are then part of every time.
    clock: &'static str,
    evaluations: u32,
    warm_up: u32,
    repeats: u32,
    rows: Vec<Row>,
}

#[derive(Debug, Serialize)]
struct Adapter {
    name: String,
    driver: String,
    backend: String,
    /// Whether it is a program on the CPU, which filters textures in software.
    software: bool,
}

/// Nanoseconds per evaluation of one shader.
#[derive(Debug, Serialize)]
struct Row {
    material: String,
    model: ShadingModel,
    form: &'static str,
    closed: bool,
    /// Median, all included.
    median_ns: f64,
    /// Median absolute deviation from it.
    mad_ns: f64,
    /// Tenth and ninetieth percentile.
    p10_ns: f64,
    p90_ns: f64,
    /// Median of the same kernel without an evaluation.
    harness_ns: f64,
    /// Median less that.
    net_ns: f64,
    /// Net over that of Phong's model.
    of_phong: f64,
    /// Net over that of the full form of the same model.
    of_full: f64,
}

/// Times shaders on the adapter at hand.
pub(crate) fn run(options: &BenchOptions) -> Outcome {
    let materials = valid(read(&options.sources.paths)?, true)?;
    let gpu = open(options.adapter.as_deref())?;
    let bar = Bar::new("timing");
    let mut rows = Vec::new();
    let (mut evaluations, mut has_timestamps) = (0, true);
    for (n, material) in materials.iter().enumerate() {
        let subjects = subjects(&gpu, material, options)?;
        let layers = luthier_layers::elek::layers(&material.stack);
        let pairs: Vec<luthier_report::Pair> = [ParitySet::Uniform, ParitySet::NearSpecular]
            .iter()
            .flat_map(|set| set.pairs(PAIRS / 2, &layers))
            .collect();
        let mut watches = Vec::new();
        for (i, subject) in subjects.iter().enumerate() {
            let watch = |is_empty| subject.scene.stopwatch(0, &pairs, options.evaluations, is_empty).map_err(device);
            if i == 0 {
                watches.push(watch(true)?);
            }
            watches.push(watch(false)?);
        }
        let times = times(&watches, options)?;
        if let Some(watch) = watches.first() {
            (evaluations, has_timestamps) = (watch.evaluations(), watch.has_timestamps());
        }
        rows.extend(rows_of(material, &subjects, times));
        bar.set(n as u64 + 1, materials.len() as u64);
    }
    drop(bar);
    let adapter =
        Adapter { name: gpu.adapter_name(), driver: gpu.driver(), backend: gpu.backend(), software: gpu.is_software() };
    let bench = Bench {
        schema: SCHEMA,
        generator: GENERATOR,
        adapter,
        clock: if has_timestamps { "device" } else { "host" },
        evaluations,
        warm_up: options.warm_up,
        repeats: options.repeats.get(),
        rows,
    };
    let text = if options.json {
        format!("{:#}\n", serde_json::to_value(&bench).map_err(Failure::input)?)
    } else {
        bench.to_text()
    };
    match &options.output {
        Some(path) => std::fs::write(path, text).map_err(files(path, "write")),
        None => print(&text),
    }
}

/// One shader on the device.
struct Subject {
    model: ShadingModel,
    form: Form,
    closed: bool,
    scene: Scene,
}

/// The forms of every model of a material, Phong's model first: ratios are to it.
fn subjects(gpu: &Gpu, material: &Material, options: &BenchOptions) -> Outcome<Vec<Subject>> {
    let mut models = vec![ShadingModel::Phong];
    let wanted: Vec<ShadingModel> =
        if options.model.is_empty() { ShadingModel::ALL.to_vec() } else { options.model.clone() };
    models.extend(wanted.into_iter().filter(|&model| model != ShadingModel::Phong));
    let mut subjects = Vec::new();
    for model in models {
        let mut shaded = material.clone();
        shaded.bake.model = Some(model);
        let mut package = bake(std::slice::from_ref(&shaded))?;
        let reads_d = reads_d(model);
        let styles = [(Form::Full, true), (Form::Baked, !reads_d), (Form::Baked, true)];
        // Without a table of D to read, closed or not is the same.
        let distinct = if reads_d { 3 } else { 2 };
        for (form, closed) in styles.into_iter().take(distinct) {
            if form == Form::Baked && closed && reads_d {
                package = with_closed(package)?;
            }
            let scene = gpu.scene(&package, form).map_err(device)?;
            subjects.push(Subject { model, form, closed, scene });
        }
    }
    Ok(subjects)
}

/// The bake with the shader `baked` that has D in closed form.
fn with_closed(mut package: Package) -> Outcome<Package> {
    let mut set = MaterialSet::from_manifest(&package.manifest);
    set.tables.retain(|table| table.kind != luthier_lut::TableKind::Distribution);
    let wgsl = luthier_shader::emit(&set, Form::Baked, Target::Wgsl).map_err(Failure::input)?;
    package.shaders = vec![Shader::wgsl(Form::Baked, wgsl)];
    Ok(package)
}

/// Times of each stopwatch. They take turns, so that a clock that drifts is nobody's advantage.
fn times(watches: &[Stopwatch<'_>], options: &BenchOptions) -> Outcome<Vec<Vec<f64>>> {
    let mut times = vec![Vec::new(); watches.len()];
    for round in 0..options.warm_up + options.repeats.get() {
        for (watch, times) in watches.iter().zip(&mut times) {
            let time = watch.run().map_err(device)?;
            if round >= options.warm_up {
                times.push(time);
            }
        }
    }
    Ok(times)
}

fn rows_of(material: &Material, subjects: &[Subject], times: Vec<Vec<f64>>) -> Vec<Row> {
    let mut times = times.into_iter();
    let harness = times.next().map_or(0.0, |times| quantile(&times, 0.5));
    let times: Vec<Vec<f64>> = times.collect();
    let net: Vec<f64> = times.iter().map(|times| quantile(times, 0.5) - harness).collect();
    let of = |wanted: &dyn Fn(&Subject) -> bool| subjects.iter().position(wanted).map_or(f64::NAN, |i| net[i]);
    let phong = of(&|s| s.model == ShadingModel::Phong);
    let mut rows = Vec::new();
    for (i, subject) in subjects.iter().enumerate() {
        let median = quantile(&times[i], 0.5);
        let apart: Vec<f64> = times[i].iter().map(|time| (time - median).abs()).collect();
        let full = of(&|s| s.model == subject.model && s.form == Form::Full);
        rows.push(Row {
            material: material.name.clone(),
            model: subject.model,
            form: subject.form.name(),
            closed: subject.closed,
            median_ns: median,
            mad_ns: quantile(&apart, 0.5),
            p10_ns: quantile(&times[i], 0.1),
            p90_ns: quantile(&times[i], 0.9),
            harness_ns: harness,
            net_ns: net[i],
            of_phong: net[i] / phong,
            of_full: net[i] / full,
        });
    }
    rows
}

/// A quantile, between the nearest two samples in proportion.
fn quantile(samples: &[f64], q: f64) -> f64 {
    let mut sorted = samples.to_vec();
    sorted.sort_by(f64::total_cmp);
    let Some(last) = sorted.len().checked_sub(1) else { return f64::NAN };
    let at = q * last as f64;
    let (below, above) = (sorted[at as usize], sorted[(at as usize + 1).min(last)]);
    below + (above - below) * at.fract()
}

impl Bench {
    fn to_text(&self) -> String {
        let Adapter { name, driver, backend, software } = &self.adapter;
        let kind = if *software { ", a program on the CPU" } else { "" };
        let mut out = format!(
            "{name} ({backend}, {driver}){kind}; clock: {}; {} evaluations, {} repeats\n\n\
             {:<24} {:<17} {:<16} {:>9} {:>8} {:>9} {:>7} {:>7}\n",
            self.clock,
            self.evaluations,
            self.repeats,
            "material",
            "model",
            "form",
            "median ns",
            "MAD",
            "net ns",
            "/phong",
            "/full"
        );
        for row in &self.rows {
            out.push_str(&format!(
                "{:<24} {:<17} {:<16} {:>9.4} {:>8.4} {:>9.4} {:>7.2} {:>7.2}\n",
                row.material,
                row.model.name(),
                label(row.model, row.form, row.closed, false),
                row.median_ns,
                row.mad_ns,
                row.net_ns,
                row.of_phong,
                row.of_full
            ));
        }
        out
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantiles_lie_between_samples() {
        let samples = [4.0, 1.0, 3.0, 2.0];
        assert_eq!([0.0, 0.5, 0.75, 1.0].map(|q| quantile(&samples, q)), [1.0, 2.5, 3.25, 4.0]);
        assert_eq!(quantile(&[7.0], 0.9), 7.0);
        assert!(quantile(&[], 0.5).is_nan());
    }
}
