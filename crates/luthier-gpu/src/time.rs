//! Timing of evaluations, by timestamp queries if the adapter has them.

use std::time::Instant;

use crate::context::TimedPass;
use crate::evaluate::{WORKGROUP, pair_words};
use crate::{GpuError, Scene};

const KERNEL: &str = include_str!("wgsl/time.wgsl");

/// Evaluations of one thread. The kernel has the same number.
const PER_THREAD: u32 = 16;

/// An evaluation of one scene, prepared to be timed many times.
#[derive(Debug)]
pub struct Stopwatch<'a> {
    scene: &'a Scene,
    pipeline: wgpu::ComputePipeline,
    pass: TimedPass,
    workgroups: u32,
}

impl Scene {
    /// Prepares timing of `luthier_eval` for pairs `(wi, wo)` of a material. With `is_empty` the kernel runs without `luthier_eval`, to measure the
    /// rest. The pairs repeat until there are at least `evaluations`.
    ///
    /// # Errors
    /// [`GpuError::NoMaterial`], and whatever the device reports.
    pub fn stopwatch(
        &self,
        material: u32,
        pairs: &[([f32; 3], [f32; 3])],
        evaluations: u32,
        is_empty: bool,
    ) -> Result<Stopwatch<'_>, GpuError> {
        self.layers(material)?;
        let kernel = if is_empty { KERNEL.replace("+= luthier_eval(", "+= kernel_empty(") } else { KERNEL.to_owned() };
        let pipeline = self.pipeline(&self.timed[usize::from(is_empty)], &kernel)?.clone();
        let words = pair_words(material, pairs);
        let workgroups = evaluations.div_ceil(PER_THREAD * WORKGROUP as u32).clamp(1, 65_535);
        let outputs = workgroups as usize * WORKGROUP;
        let pass = self.context.timed_pass(&pipeline, bytemuck::cast_slice(&words), outputs)?;
        Ok(Stopwatch { scene: self, pipeline, pass, workgroups })
    }
}

impl Stopwatch<'_> {
    /// Nanoseconds per evaluation of several watches: `repeats` runs of each, after `warm_up` runs that do not count. The watches take turns, so
    /// that a drifting clock favours none.
    ///
    /// # Errors
    /// Whatever the device reports.
    pub fn in_turn(watches: &[Self], warm_up: u32, repeats: u32) -> Result<Vec<Vec<f64>>, GpuError> {
        let mut times = vec![Vec::new(); watches.len()];
        for round in 0..warm_up + repeats {
            for (watch, times) in watches.iter().zip(&mut times) {
                let time = watch.run()?;
                if round >= warm_up {
                    times.push(time);
                }
            }
        }
        Ok(times)
    }

    /// Evaluations of one run.
    pub fn evaluations(&self) -> u32 {
        self.workgroups * WORKGROUP as u32 * PER_THREAD
    }

    /// Whether the device's own clock times the runs. If not, the host's clock does, and times include submission and waiting.
    pub fn has_timestamps(&self) -> bool {
        self.pass.has_timestamps()
    }

    /// Runs once and waits: nanoseconds per evaluation.
    ///
    /// # Errors
    /// Whatever the device reports.
    pub fn run(&self) -> Result<f64, GpuError> {
        let start = Instant::now();
        let nanoseconds =
            self.scene.context.run_timed(&self.pass, &self.pipeline, &self.scene.group, self.workgroups)?;
        let nanoseconds = nanoseconds.unwrap_or_else(|| start.elapsed().as_secs_f64() * 1e9);
        Ok(nanoseconds / f64::from(self.evaluations()))
    }
}
