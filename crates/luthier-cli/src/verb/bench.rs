//! `bench`: shaders timed on the adapter at hand.

use luthier::{Bake, read_materials};
use luthier_cost::{StaticCounts, Timing};
use luthier_export::{GENERATOR, Package, Shader};
use luthier_gpu::{Gpu, Scene, Stopwatch};
use luthier_lut::TableKind;
use luthier_manifest::ShadingModel;
use luthier_material::Material;
use luthier_report::{ParitySet, Spread};
use luthier_shader::{Form, MaterialSet, Target, style_name};
use luthier_terminal::{Bar, Failure, Outcome, adapter_json, adapter_label, deliver, open, valid};
use serde::Serialize;
use serde_json::Value;

use crate::cli::BenchOptions;
use crate::materials::{is_shaded_by, models, shade_by};
use crate::store::store;
use crate::verb::bench_fit;

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

/// Nanoseconds per evaluation of one shader.
#[derive(Debug, Serialize)]
struct Row {
    material: String,
    model: ShadingModel,
    form: Form,
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
    if options.json && options.fit.as_deref().is_some_and(bench_fit::is_printed_alone) {
        return Err(Failure::Usage(anyhow::anyhow!("with --json, --fit writes the costs to a file: name it")));
    }
    let materials = valid(read_materials(&options.sources.paths)?, true)?;
    let gpu = open(options.adapter.as_deref())?;
    let bar = Bar::new("timing");
    let mut rows = Vec::new();
    let mut timings: Vec<Timing> = Vec::new();
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
        let own = rows_of(material, &subjects, &times);
        timings.extend(own.iter().zip(&subjects).filter_map(|(row, subject)| {
            let (material, model, time) = (row.material.clone(), row.model.name().to_owned(), 1e3 * row.net_ns);
            Some(Timing { material, model, counts: subject.counts?, time })
        }));
        rows.extend(own);
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
    let fit = options.fit.as_deref().map(|file| bench_fit::fitted(&gpu, &timings, file)).transpose()?;
    let text = if options.json {
        format!("{:#}\n", serde_json::to_value(&bench).map_err(Failure::input)?)
    } else {
        bench.to_text(&gpu) + &fit.map_or_else(String::new, |fit| format!("\n{fit}"))
    };
    deliver(&text, options.output.as_deref())
}

/// One shader on the device.
struct Subject {
    model: ShadingModel,
    form: Form,
    closed: bool,
    /// Counts of its text for a fit; `None` where none is asked for.
    counts: Option<StaticCounts>,
    scene: Scene,
}

/// The forms of every model of a material, Phong's model first where it has the material's facets: ratios are to it.
fn subjects(gpu: &Gpu, material: &Material, options: &BenchOptions) -> Outcome<Vec<Subject>> {
    let mut models = vec![ShadingModel::Phong];
    models
        .extend(self::models(&options.model, options.no_fit).into_iter().filter(|&model| model != ShadingModel::Phong));
    let mut subjects = Vec::new();
    for model in models.into_iter().filter(|&model| is_shaded_by(material, model, &options.model)) {
        let mut shaded = material.clone();
        shade_by(&mut shaded, model, options.fresnel)?;
        let mut package = Bake::lit().package(std::slice::from_ref(&shaded), store()?)?;
        let reads_d = model.reads_some(TableKind::Distribution);
        let styles = [(Form::Full, true), (Form::Baked, !reads_d), (Form::Baked, true)];
        // A shader without a table of D is the same in both styles.
        let distinct = if reads_d { 3 } else { 2 };
        for (form, closed) in styles.into_iter().take(distinct).filter(|(form, _)| model.has(*form)) {
            if form == Form::Baked && closed && reads_d {
                package = with_closed(package)?;
            }
            let scene = gpu.scene(&package, form)?;
            let counts = options.fit.is_some().then(|| bench_fit::counts(&package, form, 1)).transpose()?;
            subjects.push(Subject { model, form, closed, counts, scene });
        }
    }
    Ok(subjects)
}

/// The bake with the shader `baked` that has D in closed form.
fn with_closed(mut package: Package) -> Outcome<Package> {
    let set = MaterialSet::from_manifest(&package.manifest).with_closed_distribution();
    let wgsl = luthier_shader::emit(&set, Form::Baked, Target::Wgsl).map_err(Failure::input)?;
    package.shaders = vec![Shader::wgsl(Form::Baked, wgsl)];
    Ok(package)
}

fn rows_of(material: &Material, subjects: &[Subject], times: &[Vec<f64>]) -> Vec<Row> {
    let mut spreads = times.iter().map(|times| Spread::of(times));
    let harness = spreads.next().map_or(0.0, |spread| spread.median);
    let spreads: Vec<Spread> = spreads.collect();
    let net: Vec<f64> = spreads.iter().map(|spread| spread.median - harness).collect();
    let of = |wanted: &dyn Fn(&Subject) -> bool| subjects.iter().position(wanted).map_or(f64::NAN, |i| net[i]);
    let phong = of(&|s| s.model == ShadingModel::Phong);
    let mut rows = Vec::new();
    for (i, subject) in subjects.iter().enumerate() {
        let Spread { median, mad, p10, p90 } = spreads[i];
        let full = of(&|s| s.model == subject.model && s.form == Form::Full);
        rows.push(Row {
            material: material.name.clone(),
            model: subject.model,
            form: subject.form,
            closed: subject.closed,
            median_ns: median,
            mad_ns: mad,
            p10_ns: p10,
            p90_ns: p90,
            harness_ns: harness,
            net_ns: net[i],
            of_phong: net[i] / phong,
            of_full: net[i] / full,
        });
    }
    rows
}

impl Bench {
    fn to_text(&self, gpu: &Gpu) -> String {
        let kind = if gpu.is_software() { ", a program on the CPU" } else { "" };
        let mut out = format!(
            "{}{kind}; clock: {}; {} evaluations, {} repeats\n\n\
             {:<24} {:<17} {:<16} {:>9} {:>8} {:>9} {:>7} {:>7}\n",
            adapter_label(gpu),
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
                "{:<24} {:<17} {:<16} {:>9.4} {:>8.4} {:>9.4} {:>7} {:>7}\n",
                row.material,
                row.model.name(),
                style_name(row.model, row.form, row.closed, false),
                row.median_ns,
                row.mad_ns,
                row.net_ns,
                ratio(row.of_phong),
                ratio(row.of_full)
            ));
        }
        out
    }
}

/// A ratio to a shader; none where there is no such shader.
fn ratio(value: f64) -> String {
    if value.is_nan() { "-".to_owned() } else { format!("{value:.2}") }
}
