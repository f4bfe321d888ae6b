//! Sets of materials in one buffer, each thread with a material of its own.

use luthier_gpu::{Gpu, Scene, Threads, Workload};
use luthier_manifest::ShadingModel;
use luthier_material::Material;
use luthier_report::{Pair, Spread};
use luthier_shader::Form;
use luthier_terminal::{Bar, Failure, Outcome};
use serde::Serialize;

use super::subjects::bake;
use super::{Bench, pairs};
use crate::cli::BenchOptions;
use crate::materials::shade_by;
use crate::store::store;

/// Threads in a row that share a material, from pictures of a few things to noise: each material one run; two subgroups of 32, or one of 64; a
/// part of one; none.
const RUNS: [Option<u32>; 4] = [None, Some(64), Some(8), Some(1)];

/// Nanoseconds per evaluation of a set, for a number of lights.
#[derive(Debug, Clone, Serialize)]
pub(crate) struct PerPixel {
    /// Materials of the set.
    pub(crate) materials: u32,
    /// Model of all; absent where each has that of its file.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) model: Option<ShadingModel>,
    /// Models of the set, by how many there are.
    pub(crate) models: u32,
    pub(crate) form: Form,
    /// Lights on each prepared view.
    pub(crate) lights: u32,
    /// Threads in a row that share a material; absent where every material has one run of them.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) run: Option<u32>,
    /// Median, all included.
    pub(crate) median_ns: f64,
    /// Median absolute deviation from it.
    pub(crate) mad_ns: f64,
    /// Median of the same kernel without an evaluation.
    pub(crate) harness_ns: f64,
    /// Median less that.
    pub(crate) net_ns: f64,
    /// Mean of the materials' net times, each alone in a set of its own.
    pub(crate) alone_ns: f64,
    /// Net over that mean.
    pub(crate) of_alone: f64,
}

/// Refuses sizes of sets beyond the materials that there are.
pub(super) fn refuse(options: &BenchOptions, given: usize) -> Outcome {
    match options.per_pixel.iter().find(|&&size| size as usize > given) {
        Some(size) => Err(Failure::Usage(anyhow::anyhow!(
            "`--per-pixel {size}` wants {size} materials, and the files have {given}: name more, or a smaller number"
        ))),
        None => Ok(()),
    }
}

/// Times sets of the first materials, in the models of their files or in each model that is asked for.
pub(super) fn per_pixel(gpu: &Gpu, materials: &[Material], options: &BenchOptions, bench: &mut Bench) -> Outcome {
    let models: Vec<Option<ShadingModel>> = match options.model.as_slice() {
        [] => vec![None],
        models => models.iter().copied().map(Some).collect(),
    };
    let largest = options.per_pixel.iter().copied().max().unwrap_or(0) as usize;
    let materials = &materials[..largest];
    // All sets see the same directions.
    let pairs = pairs(&materials[0]);
    let bar = Bar::new("timing");
    let steps = (models.len() * (largest + options.per_pixel.len())) as u64;
    let mut done = 0;
    for model in models {
        let mut shaded = materials.to_vec();
        for material in &mut shaded {
            shade_by(material, model.unwrap_or_else(|| material.model()), options.fresnel)?;
        }
        let mut alone = Vec::new();
        for material in &shaded {
            let scene = scene(gpu, std::slice::from_ref(material))?;
            alone.push(bench.nets(&scene, &pairs, options, &[Threads::One(0)])?.remove(0));
            done += 1;
            bar.set(done, steps);
        }
        for &size in &options.per_pixel {
            let set = &shaded[..size as usize];
            let scene = scene(gpu, set)?;
            let threads = RUNS.map(|run| Threads::Mixed { count: size, run });
            let mut models: Vec<ShadingModel> = set.iter().map(Material::model).collect();
            models.sort_unstable();
            models.dedup();
            for (run, times) in RUNS.into_iter().zip(bench.nets(&scene, &pairs, options, &threads)?) {
                for (i, (&lights, (spread, harness))) in options.lights.iter().zip(times).enumerate() {
                    let net = |(spread, harness): &(Spread, f64)| spread.median - harness;
                    let alone_ns =
                        alone.iter().take(set.len()).map(|times| net(&times[i])).sum::<f64>() / f64::from(size);
                    let net_ns = net(&(spread, harness));
                    bench.per_pixel.push(PerPixel {
                        materials: size,
                        model,
                        models: models.len() as u32,
                        form: Form::Baked,
                        lights,
                        run,
                        median_ns: spread.median,
                        mad_ns: spread.mad,
                        harness_ns: harness,
                        net_ns,
                        alone_ns,
                        of_alone: net_ns / alone_ns,
                    });
                }
            }
            done += 1;
            bar.set(done, steps);
        }
    }
    Ok(())
}

/// The shader `baked` of a set, as `luthier bake` writes it.
fn scene(gpu: &Gpu, materials: &[Material]) -> Outcome<Scene> {
    let package = bake().in_forms(&[Form::Baked]).package(materials, store()?)?;
    Ok(gpu.scene(&package, Form::Baked)?)
}

impl Bench {
    /// Times of a scene and of its harness, for each choice of materials and each number of lights.
    fn nets(
        &mut self,
        scene: &Scene,
        pairs: &[Pair],
        options: &BenchOptions,
        threads: &[Threads],
    ) -> Outcome<Vec<Vec<(Spread, f64)>>> {
        let mut watches = Vec::new();
        for &materials in threads {
            for &lights in &options.lights {
                let workload = Workload { evaluations: options.evaluations, lights, is_empty: false, materials };
                watches.push(scene.stopwatch(pairs, workload.empty())?);
                watches.push(scene.stopwatch(pairs, workload)?);
            }
        }
        let times = self.time(&watches)?;
        let times: Vec<(Spread, f64)> =
            times.chunks(2).map(|pair| (Spread::of(&pair[1]), Spread::of(&pair[0]).median)).collect();
        Ok(times.chunks(options.lights.len()).map(<[_]>::to_vec).collect())
    }
}
