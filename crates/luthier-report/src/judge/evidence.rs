//! Evidence that a report shows beside the judgement of a bake, and its origin.

use luthier_manifest::{Check, Form, ShadingModel, Target};
use serde::{Deserialize, Serialize};

use crate::stability::{Stability, Verdict};

/// Costs of shaders on GPUs: the part of the output of `luthier cost --json` that a report needs.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Costs {
    /// Program and version.
    pub generator: String,
    /// Driver and version.
    pub driver: String,
    /// One for each shader and instruction set.
    pub rows: Vec<ShaderCost>,
}

/// The cost of one shader.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ShaderCost {
    /// Name of the material.
    pub material: String,
    /// Its model.
    pub model: ShadingModel,
    /// `baked` or `full`.
    pub form: String,
    /// Whether D is a closed form, or there is none.
    pub closed: bool,
    /// Whether the numbers of the material are in the code.
    pub constant: bool,
    /// Instruction set.
    pub family: String,
    /// Cycles per wave of 64, all waves in flight, without the harness.
    pub inverse_throughput: i64,
    /// Vector registers.
    pub vgprs: i64,
    /// Texture reads as issued.
    pub texture_reads: i64,
}

/// The cost of a shader that was compiled for a surface with layers of equal kinds: inverse throughput on RDNA 2, in cycles per wave of 64.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct ShapeCost {
    /// Cycles of the table-reading form.
    pub baked: u32,
    /// Cycles of the table-free form, if the model has it.
    pub full: Option<u32>,
    /// Whether the surface is only similar, because none with layers of these kinds was compiled.
    pub is_of_similar: bool,
}

/// Measured times of the shaders on the adapter of a report.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Times {
    /// The adapter.
    pub device: String,
    /// Whether the adapter is a program on the CPU: its times are those of the CPU, and say nothing of a GPU.
    pub is_software: bool,
    /// `device` for timestamp queries; `host` where the adapter has none, and submission and waiting are part of the times.
    pub clock: String,
    /// Evaluations of one run.
    pub evaluations: u32,
    /// Runs of each shader.
    pub repeats: u32,
    /// One for each material and form.
    pub rows: Vec<ShaderTime>,
}

/// Time of one shader, without the loop around it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ShaderTime {
    /// Name of the material.
    pub material: String,
    /// Form of the shader.
    pub form: Form,
    /// Nanoseconds per evaluation, median of the runs less that of the same kernel without an evaluation.
    pub net_ns: f64,
    /// Median absolute deviation of the runs.
    pub mad_ns: f64,
}

/// Number and seed of the paths of a reference.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct ReferencePaths {
    /// Per view and wavelength.
    pub paths: u32,
    /// Seed of the random numbers.
    pub seed: u64,
}

/// Differences between the pictures of a material in the forms `baked` and `full`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct PictureErrors {
    /// Side in pixels.
    pub size: u32,
    /// Root mean square of the difference, in linear radiance.
    pub rms_err: f64,
    /// Largest difference.
    pub max_abs_err: f64,
    /// Mean of FLIP, 0 to 1.
    pub flip_mean: f64,
    /// Its largest value.
    pub flip_max: f64,
    /// Mean CIEDE2000 difference of the pixels.
    pub delta_e_mean: f64,
    /// The largest.
    pub delta_e_max: f64,
    /// Factor on the difference picture.
    pub gain: u32,
}

/// Verdicts on the cells of the stability suite, counted.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct StabilitySummary {
    /// Program and version.
    pub generator: String,
    /// The adapter.
    pub device: Option<String>,
    /// Cells: a method on a case at a level.
    pub cells: u64,
    /// Cells that hold.
    pub holds: u64,
    /// Cells that degrade.
    pub degrades: u64,
    /// Cells that fail.
    pub fails: u64,
    /// Cells that do not hold and have no explanation.
    pub unexplained: u64,
    /// Cells of shaders and tables that are NaN or infinite somewhere.
    pub not_finite: u64,
}

impl StabilitySummary {
    /// Counts cells.
    pub fn of(suite: &Stability) -> Self {
        let [holds, degrades, fails] = [Verdict::Holds, Verdict::Degrades, Verdict::Fails]
            .map(|verdict| suite.cells.iter().filter(|c| c.verdict == verdict).count() as u64);
        Self {
            generator: suite.generator.clone(),
            device: suite.device.clone(),
            cells: suite.cells.len() as u64,
            holds,
            degrades,
            fails,
            unexplained: suite.unexplained().count() as u64,
            not_finite: suite.not_finite().count() as u64,
        }
    }
}

/// A shader of a bake, and the judges that it passed when it was emitted.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ShaderVerdict {
    /// Its language.
    pub target: Target,
    /// Its form.
    pub form: Form,
    /// The file, relative to the manifest.
    pub path: String,
    /// The judges, by the manifest; empty for earlier bakes.
    pub checks: Vec<Check>,
}

/// Exhibits of the page that are not part of the JSON.
#[derive(Debug, Clone, Default)]
pub struct Exhibits {
    /// Pictures, a list for each material in the order of the report; empty lists show nothing.
    pub pictures: Vec<Vec<Exhibit>>,
    /// A run of the stability suite.
    pub stability: Option<Stability>,
    /// Address, relative to the report, of a page that shows every material under its name.
    pub gallery: Option<String>,
}

/// A picture.
#[derive(Debug, Clone)]
pub struct Exhibit {
    /// Caption of the picture.
    pub caption: String,
    /// A PNG file.
    pub png: Vec<u8>,
}
