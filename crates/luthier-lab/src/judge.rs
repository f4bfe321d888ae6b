//! The reflectance models against the reference, on materials.

use luthier::read_materials;
use luthier_report::{ModelSettings, ModelSubject, judge_models};
use luthier_terminal::{Bar, Failure, Outcome, print, valid};

use crate::cli::{JUDGE_SAMPLES, JudgeOptions, call};
use crate::lobes::of;

/// Judges every model on materials.
pub(crate) fn run(options: &JudgeOptions) -> Outcome {
    let materials = valid(read_materials(&options.sources.paths)?, false)?;
    let subjects: Vec<ModelSubject> = materials.iter().map(|material| of(material, false)).collect();
    let bar = Bar::new("judging models");
    let settings = ModelSettings { samples: options.samples, seed: 0 };
    let report = judge_models(&subjects, settings, &|done, total| bar.set(done as u64, total as u64));
    drop(bar);
    if options.format.json {
        return print(&report.to_json().map_err(Failure::input)?);
    }
    print(&report.to_markdown(&command(options)))
}

/// The command line that makes the page.
fn command(options: &JudgeOptions) -> String {
    let mut command = call("judge", &options.sources.paths);
    if options.samples != JUDGE_SAMPLES {
        command += &format!(" --samples {}", options.samples);
    }
    command
}
