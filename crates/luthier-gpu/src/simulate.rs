//! Simulation of stacks by random walks of light: values for pairs of directions, and pictures that gather samples.

use luthier_lut::Image;
use luthier_manifest::{DiffusePart, LAYER_WORDS, MATERIAL_WORDS, MaterialEntry};

use crate::context::{Context, Pass, word};
use crate::error::setting;
use crate::evaluate::WORKGROUP;
use crate::render::{HEADER_WORDS, PIXELS_PER_WORKGROUP};
use crate::surroundings::Surroundings;
use crate::{GpuError, RenderSettings, Scene, Shape, Shown};

/// The most layers of a stack: the size of arrays in the kernels.
const LAYERS_MOST: usize = 8;

/// Samples of one thread in a submission. Software adapters end loops after 65,535 turns; this stays far below.
const SAMPLES_PER_THREAD: u32 = 32;

/// Samples per submission: a second or two on a software adapter. Discrete GPUs take more.
const SAMPLES_PER_PASS: u32 = 1 << 19;

/// Treatment of light at a rough interface.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Facets {
    /// Light walks between facets until it leaves, so that none is lost: `layered-mc` of luthier-layers.
    #[default]
    Walk,
    /// Light meets one facet, and light that other facets block is lost: `layered-mc-one-facet`.
    One,
}

/// Settings of a simulation.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct SimulationSettings {
    /// Light at rough interfaces.
    pub facets: Facets,
    /// Family of random numbers.
    pub seed: u32,
}

/// Mean of samples, linear RGB.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Simulated {
    /// The mean.
    pub mean: [f64; 3],
    /// Standard error of the mean, by the spread of the samples.
    pub std_err: [f64; 3],
}

/// Sums over samples, and over their squares.
#[derive(Debug, Clone, Copy, Default)]
struct Sums {
    values: [f64; 3],
    squares: [f64; 3],
}

impl Sums {
    fn add(&mut self, words: &[[f32; 4]]) {
        let [values, squares] = words else { return };
        for c in 0..3 {
            self.values[c] += f64::from(values[c]);
            self.squares[c] += f64::from(squares[c]);
        }
    }

    fn of(&self, samples: u32) -> Simulated {
        let n = f64::from(samples);
        let mean = self.values.map(|sum| sum / n);
        let variance = [0, 1, 2].map(|c| (self.squares[c] / n - mean[c] * mean[c]).max(0.0) / (n - 1.0).max(1.0));
        Simulated { mean, std_err: variance.map(f64::sqrt) }
    }
}

impl Scene {
    /// `f cos_theta_i` of a material for pairs `(wi, wo)`: unit vectors in the local frame, away from the surface. Each value is the mean of random
    /// walks of light through the stack at three wavelengths, and zero if a direction is below the horizon. Equal arguments give equal values on one
    /// device.
    ///
    /// Paths are position-free (Guo, Hasan and Zhao 2018) over Smith micro-surfaces, with indices, slopes, turns, slabs and the diffuse base of the
    /// layer records. The mean is unbiased, except for single precision and for the light of paths beyond 512 events or of walks beyond 256 facets,
    /// which is less than one part in a million. Slope parameters are at least 0.001, as in the records. A sample takes three paths if the index of
    /// a transparent layer depends on the wavelength.
    ///
    /// # Errors
    /// [`GpuError::NotSimulated`] for films, fluorescent bases and surfaces that vary; [`GpuError::NoMaterial`], [`GpuError::Setting`] for no
    /// samples, and whatever the device reports.
    pub fn simulate(
        &self,
        material: u32,
        pairs: &[([f32; 3], [f32; 3])],
        samples: u32,
        settings: &SimulationSettings,
    ) -> Result<Vec<Simulated>, GpuError> {
        self.layers(material)?;
        self.check_simulated(material)?;
        if samples == 0 {
            return Err(setting("samples", samples.to_string(), "at least 1"));
        }
        let pipeline = self.simulation_pipeline(settings.facets, 0, &[include_str!("wgsl/simulation/pairs.wgsl")])?;
        let mut all = Vec::with_capacity(pairs.len());
        for (number, chunk) in pairs.chunks(WORKGROUP * 256).enumerate() {
            let mut sums = vec![Sums::default(); chunk.len()];
            let blocks = (SAMPLES_PER_PASS * self.context.batch / SAMPLES_PER_THREAD / chunk.len() as u32).max(1);
            let mut done = 0;
            while done < samples {
                // Blocks of whole threads; the last samples, fewer than a thread takes, are one block.
                let left = samples - done;
                let per_thread = left.min(SAMPLES_PER_THREAD);
                let blocks = (left / per_thread).min(blocks);
                // Pairs count from 0 in every chunk, so each chunk needs a seed of its own.
                let seed = settings.seed ^ (number as u32).wrapping_mul(0x9e37_79b9);
                let mut words = vec![[material, seed, done, per_thread]];
                for (wi, wo) in chunk {
                    words.extend([wi, wo].map(|direction| word(*direction, 0.0).map(f32::to_bits)));
                }
                let threads = blocks as usize * chunk.len();
                let out = self.context.run(&Pass {
                    what: "simulation",
                    pipeline,
                    shader_group: &self.group,
                    workgroups: [threads.div_ceil(WORKGROUP) as u32, 1],
                    inputs: bytemuck::cast_slice(&words),
                    output_words: 2 * threads,
                })?;
                for (thread, words) in out.chunks(2).enumerate() {
                    sums[thread % chunk.len()].add(words);
                }
                done += blocks * per_thread;
            }
            all.extend(sums.iter().map(|sums| sums.of(samples)));
        }
        Ok(all)
    }

    /// A picture of a shape to simulate, without samples so far: one material for each part, lit and seen as in [`Scene::render`]. Lights widen slopes,
    /// and paths that leave the stack meet the environment. `environment_samples` is ignored.
    ///
    /// # Errors
    /// As [`Scene::simulate`] and [`Scene::render`].
    pub fn simulation(
        &self,
        parts: &[Shown],
        render: &RenderSettings,
        settings: &SimulationSettings,
    ) -> Result<Simulation, GpuError> {
        let render = RenderSettings { environment_samples: 1, ..render.clone() };
        render.check(parts)?;
        if render.shape == Shape::Mesh {
            let allowed = "sphere, torus, plane or grid: the simulation knows no triangles";
            return Err(setting("shape", "model or mesh".to_owned(), allowed));
        }
        for part in parts {
            if let Shown::Surface(_) = part {
                return Err(GpuError::NotSimulated {
                    material: "a surface".to_owned(),
                    what: "surfaces of several materials",
                });
            }
        }
        let materials = self.materials_of(parts)?;
        materials.iter().try_for_each(|material| self.check_simulated(*material))?;
        let kernel = [
            include_str!("wgsl/shape.wgsl"),
            include_str!("wgsl/environment.wgsl"),
            include_str!("wgsl/picture.wgsl"),
            include_str!("wgsl/simulation/picture.wgsl"),
        ];
        let pipeline = self.simulation_pipeline(settings.facets, 2, &kernel)?;
        let words = self.widened_words(render.light_angular_radius);
        let group = self.bindings.group(&self.context, &words, &Surroundings::black(&self.context)?)?;
        let inputs = self.inputs(parts, &materials, &render);
        let sums = vec![Sums::default(); (render.size * render.size) as usize];
        Ok(Simulation {
            context: self.context.clone(),
            pipeline: pipeline.clone(),
            group,
            inputs,
            size: render.size,
            seed: settings.seed,
            samples: 0,
            sums,
        })
    }

    fn simulation_pipeline(
        &self,
        facets: Facets,
        first: usize,
        kernel: &[&str],
    ) -> Result<&wgpu::ComputePipeline, GpuError> {
        let walks = facets == Facets::Walk;
        let text = [
            include_str!("wgsl/simulation/random.wgsl"),
            include_str!("wgsl/simulation/layer.wgsl"),
            include_str!("wgsl/simulation/facets.wgsl"),
            include_str!("wgsl/simulation/interface.wgsl"),
            include_str!("wgsl/simulation/path.wgsl"),
        ];
        let text = [text.as_slice(), kernel].concat().join("\n");
        let text = text
            .replace("$layer_words", &LAYER_WORDS.to_string())
            .replace("$material_words", &MATERIAL_WORDS.to_string())
            .replace("$layers", &LAYERS_MOST.to_string())
            .replace("$walks", if walks { "true" } else { "false" });
        self.pipeline(&self.simulations[first + usize::from(walks)], &text)
    }

    fn check_simulated(&self, material: u32) -> Result<(), GpuError> {
        let entry = &self.manifest.materials[material as usize];
        match beyond(entry) {
            Some(what) => Err(GpuError::NotSimulated { material: entry.name.clone(), what }),
            None => Ok(()),
        }
    }
}

/// The first part of a material that the simulation does not support.
fn beyond(entry: &MaterialEntry) -> Option<&'static str> {
    if entry.layers.iter().any(|layer| layer.film_thickness_max_nm > 0.0 || layer.film_thickness_nm > 0.0) {
        return Some("films");
    }
    if entry.layers.iter().any(|layer| layer.reradiation.is_some()) {
        return Some("fluorescent bases");
    }
    // The buffer has such an interface as one that does not bend.
    if entry.diffuse_part() == DiffusePart::Beside {
        return Some("diffuse bases beside an interface");
    }
    if entry.varies() {
        return Some("textures, flakes, patina, weights of coats and glitter");
    }
    (entry.layers.len() > LAYERS_MOST).then_some("more than 8 layers")
}

/// A picture that gathers samples.
#[derive(Debug)]
pub struct Simulation {
    context: Context,
    pipeline: wgpu::ComputePipeline,
    group: wgpu::BindGroup,
    inputs: Vec<[u32; 4]>,
    size: u32,
    seed: u32,
    samples: u32,
    sums: Vec<Sums>,
}

impl Simulation {
    /// Adds samples to every pixel. Samples go over the squares of a pixel in turn, so that multiples of the square of
    /// [`RenderSettings::samples`] cover it evenly. Several calls give the same samples as one.
    ///
    /// # Errors
    /// Whatever the device reports.
    pub fn add(&mut self, samples: u32) -> Result<(), GpuError> {
        self.add_unless(samples, &|| false).map(|_| ())
    }

    /// Adds samples as [`Simulation::add`] does, and asks between submissions whether to stop. Returns whether all were added; if not, the picture is
    /// that from before the call.
    ///
    /// # Errors
    /// Whatever the device reports.
    pub fn add_unless(&mut self, samples: u32, stop: &dyn Fn() -> bool) -> Result<bool, GpuError> {
        let size = self.size;
        let mut left = samples;
        let before = (self.samples, self.sums.clone());
        while left > 0 {
            let count = left.min(SAMPLES_PER_THREAD);
            let rows = (SAMPLES_PER_PASS * self.context.batch / (size * count)).clamp(1, size);
            for row in (0..size).step_by(rows as usize) {
                if stop() {
                    (self.samples, self.sums) = before;
                    return Ok(false);
                }
                let rows = rows.min(size - row);
                self.inputs[5][1] = row;
                self.inputs[HEADER_WORDS - 1] = [self.samples, count, self.seed, 0];
                let pixels = self.context.run(&Pass {
                    what: "simulation",
                    pipeline: &self.pipeline,
                    shader_group: &self.group,
                    workgroups: [size.div_ceil(PIXELS_PER_WORKGROUP), rows.div_ceil(PIXELS_PER_WORKGROUP)],
                    inputs: bytemuck::cast_slice(&self.inputs),
                    output_words: 2 * (size * rows) as usize,
                })?;
                let first = (row * size) as usize;
                for (sums, words) in self.sums[first..].iter_mut().zip(pixels.chunks(2)) {
                    sums.add(words);
                }
            }
            self.samples += count;
            left -= count;
        }
        Ok(true)
    }

    /// Samples of each pixel so far.
    pub fn samples(&self) -> u32 {
        self.samples
    }

    /// The picture so far: linear RGB, as [`Scene::render`] gives it; black before the first sample.
    pub fn image(&self) -> Image {
        self.picture(|simulated| simulated.mean)
    }

    /// Standard error of every pixel and channel, by the spread of its samples. It is a little too large if samples cover the pixel evenly, because
    /// then a part of the spread is no noise.
    pub fn noise(&self) -> Image {
        self.picture(|simulated| simulated.std_err)
    }

    fn picture(&self, value: impl Fn(Simulated) -> [f64; 3]) -> Image {
        let values = self.sums.iter().flat_map(|sums| value(sums.of(self.samples.max(1))).map(|v| v as f32));
        Image { width: self.size, height: self.size, channels: 3, data: values.collect() }
    }
}
