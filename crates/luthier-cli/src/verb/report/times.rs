//! Times of the shaders of a bake on the adapter that judges them.

use luthier_gpu::{GpuError, Stopwatch, Workload};
use luthier_layers::layers::Layers;
use luthier_report::{Device, Form, Pair, ParitySet, ShaderTime, Spread, Subject, Times};
use luthier_terminal::{Bar, Outcome, Shaders};

/// Pairs of directions, near the mirror direction and anywhere by halves: few enough for any cache.
const PAIRS: u32 = 1024;

/// Evaluations of a run: some tens of milliseconds on a program on the CPU, some tenths of one on a GPU.
const EVALUATIONS: u32 = 1 << 21;
const EVALUATIONS_SOFTWARE: u32 = 1 << 15;

/// Runs that do not count, and those that do.
const WARM_UP: u32 = 1;
const REPEATS: u32 = 5;

/// Times both shaders of every material.
pub(super) fn measure(shaders: &Shaders, subject: &Subject<'_>) -> Outcome<Times> {
    let evaluations = if shaders.is_software() { EVALUATIONS_SOFTWARE } else { EVALUATIONS };
    let bar = Bar::new("timing");
    let materials = &subject.manifest.materials;
    let mut out = Times {
        device: shaders.name(),
        is_software: shaders.is_software(),
        clock: String::new(),
        evaluations,
        repeats: REPEATS,
        rows: Vec::new(),
    };
    for ((number, entry), stack) in (0_u32..).zip(materials).zip(&subject.stacks) {
        bar.set(u64::from(number) + 1, materials.len() as u64);
        let layers = Layers::isotropic_rgb(stack).layers;
        let sets = [ParitySet::Uniform, ParitySet::NearSpecular];
        let pairs: Vec<Pair> = sets.iter().flat_map(|set| set.pairs(PAIRS / 2, &layers)).collect();
        let forms = [Form::Baked, Form::Full].into_iter().filter(|&form| entry.model.has(form));
        for (form, scene) in forms.filter_map(|form| Some((form, shaders.scene(form)?))) {
            let single = Workload::single(number, evaluations);
            let watches = [single, single.empty()].map(|workload| scene.stopwatch(&pairs, workload));
            let watches: Vec<Stopwatch<'_>> = watches.into_iter().collect::<Result<_, GpuError>>()?;
            let times = Stopwatch::in_turn(&watches, WARM_UP, REPEATS)?;
            let [run, harness] = [0, 1].map(|i: usize| Spread::of(&times[i]));
            out.evaluations = watches[0].evaluations();
            out.clock = if watches[0].has_timestamps() { "device" } else { "host" }.to_owned();
            let net_ns = run.median - harness.median;
            out.rows.push(ShaderTime { material: entry.name.clone(), form, net_ns, mad_ns: run.mad });
        }
    }
    Ok(out)
}
