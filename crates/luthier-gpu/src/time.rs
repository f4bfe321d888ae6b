//! Timing of evaluations, by timestamp queries if the adapter has them.

use std::time::Instant;

use crate::context::TimedPass;
use crate::evaluate::{WORKGROUP, pair_words};
use crate::{GpuError, Scene};

const KERNEL: &str = include_str!("wgsl/time.wgsl");

/// Evaluations of one thread. The kernel has the same number.
const PER_THREAD: u32 = 16;

/// Work of a timed run.
#[derive(Debug, Clone, Copy)]
pub struct Workload {
    /// Least number of evaluations: each is of one light.
    pub evaluations: u32,
    /// Lights of a view, a divisor of 16. One light calls `luthier_eval`; more call `luthier_prepare` once and `luthier_light` for each.
    pub lights: u32,
    /// True where the kernel runs without evaluations, to measure the rest.
    pub is_empty: bool,
    /// Materials of the threads.
    pub materials: Threads,
}

/// Materials of the threads of a timed run.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Threads {
    /// One material, by its number, as in a draw call.
    One(u32),
    /// The first materials of the scene in turn, each for some threads in a row: numbers that each thread reads from a buffer.
    Mixed {
        /// Materials that take turns, at least 1.
        count: u32,
        /// Threads in a row that share a material; `None` for as many as give every material one run.
        run: Option<u32>,
    },
}

impl Workload {
    /// Evaluations of one material for one light, as in `luthier_eval`.
    pub fn single(material: u32, evaluations: u32) -> Self {
        Self { evaluations, lights: 1, is_empty: false, materials: Threads::One(material) }
    }

    /// This workload without evaluations.
    #[must_use]
    pub fn empty(self) -> Self {
        Self { is_empty: true, ..self }
    }

    fn workgroups(&self) -> u32 {
        self.evaluations.div_ceil(PER_THREAD * WORKGROUP as u32).clamp(1, 65_535)
    }

    fn kernel(&self) -> String {
        let call = match (self.is_empty, self.lights) {
            (true, _) => "kernel_empty(material, wi, pair.wo)",
            (false, 1) => "luthier_eval(material, wi, pair.wo)",
            (false, _) => "luthier_light(prepared, wi)",
        };
        let views = if self.lights == 1 {
            format!("        let wi = pair.wi;\n        sum += {call};\n")
        } else {
            let prepare =
                if self.is_empty { "" } else { "        let prepared = luthier_prepare(material, pair.wo);\n" };
            format!(
                "{prepare}        for (var l = 0u; l < {}u; l++) {{\n            let wi = kernel_inputs[(i + 97u * (k + l)) % count].wi;\n            \
                 sum += {call};\n        }}\n",
                self.lights
            )
        };
        let material = match self.materials {
            Threads::One(_) => "0",
            Threads::Mixed { .. } => "i / kernel_inputs[0].run % count",
        };
        KERNEL.replace("$material", material).replace("$lights", &self.lights.to_string()).replace("$views", &views)
    }

    /// The pairs as the kernel reads them. Where materials take turns there are as many pairs as give each an equal share.
    fn words(&self, pairs: &[([f32; 3], [f32; 3])]) -> Vec<[u32; 8]> {
        match self.materials {
            Threads::One(material) => pair_words(material, pairs),
            Threads::Mixed { count, run } => {
                let threads = self.workgroups() * WORKGROUP as u32;
                let run = run.unwrap_or_else(|| threads.div_ceil(count)).max(1);
                let shared = pairs.len().next_multiple_of(count as usize);
                let mut words = pair_words(0, pairs);
                words = words.iter().copied().cycle().take(shared).collect();
                for (number, word) in (0..).zip(&mut words) {
                    word[3] = number % count;
                    word[7] = run;
                }
                words
            }
        }
    }
}

/// An evaluation of one scene, prepared to be timed many times.
#[derive(Debug)]
pub struct Stopwatch<'a> {
    scene: &'a Scene,
    pipeline: wgpu::ComputePipeline,
    pass: TimedPass,
    workgroups: u32,
}

impl Scene {
    /// Prepares timing of evaluations for pairs `(wi, wo)`, which repeat. With several lights a view has the direction `wo` of one pair, and `wi` of
    /// as many.
    ///
    /// # Errors
    /// [`GpuError::NoMaterial`], and whatever the device reports: it refuses several lights where the shader has no `luthier_light`.
    pub fn stopwatch(&self, pairs: &[([f32; 3], [f32; 3])], workload: Workload) -> Result<Stopwatch<'_>, GpuError> {
        match workload.materials {
            Threads::One(material) => self.layers(material)?,
            Threads::Mixed { count, .. } => self.layers(count.max(1) - 1)?,
        };
        let pipeline = self.timed(&workload.kernel())?;
        let workgroups = workload.workgroups();
        let outputs = workgroups as usize * WORKGROUP;
        let words = workload.words(pairs);
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

#[cfg(test)]
mod tests {
    use super::*;

    const PAIR: ([f32; 3], [f32; 3]) = ([0.0, 0.0, 1.0], [0.6, 0.0, 0.8]);

    /// Threads 0..128 of two workgroups: each material is met as often as every other, for as many threads in a row as asked.
    #[test]
    fn materials_take_turns() {
        let single = Workload::single(7, 2048);
        assert_eq!(single.words(&[PAIR; 4]).iter().map(|word| word[3]).collect::<Vec<_>>(), [7; 4]);
        for (run, expected) in [(Some(8), 8), (Some(1), 1), (None, 43)] {
            let mixed = Workload { materials: Threads::Mixed { count: 3, run }, ..single };
            let words = mixed.words(&[PAIR; 4]);
            assert_eq!(words.iter().map(|word| word[3]).collect::<Vec<_>>(), [0, 1, 2, 0, 1, 2]);
            assert!(words.iter().all(|word| word[7] == expected), "{words:?}");
        }
    }

    #[test]
    fn several_lights_share_a_view() {
        let single = Workload::single(0, 2048);
        let calls = |workload: Workload, name: &str| workload.kernel().matches(&format!("{name}(")).count();
        assert_eq!((calls(single, "luthier_eval"), calls(single, "luthier_light")), (1, 0));
        let four = Workload { lights: 4, ..single };
        let [eval, prepare, light] = ["luthier_eval", "luthier_prepare", "luthier_light"].map(|name| calls(four, name));
        assert_eq!((eval, prepare, light), (0, 1, 1));
        assert!(four.kernel().contains("k += 4u") && four.kernel().contains("l < 4u"));
        for lights in [1, 4] {
            assert!(!Workload { lights, ..single }.empty().kernel().contains("luthier_eval("));
            assert!(!Workload { lights, ..single }.empty().kernel().contains("luthier_light("));
        }
    }
}
