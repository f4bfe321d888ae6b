use luthier_layers::model::ModelInfo;
use luthier_layers::registry::models;
use luthier_report::{ModelSettings, ModelSubject, judge_models};
use serde_json::{Value, json};

use crate::cli::{MODEL_SAMPLES, ModelsOptions};
use crate::failure::{Failure, Outcome};
use crate::materials::{read, valid};
use crate::output::print;
use crate::progress::Bar;

/// Lists the reflectance models, or judges them.
pub(crate) fn run(options: &ModelsOptions) -> Outcome {
    if !options.judge.is_empty() {
        return judge(options);
    }
    let infos: Vec<ModelInfo> = models().iter().map(|model| model.info()).collect();
    if options.json {
        return print(&format!("{:#}", Value::from_iter(infos.iter().map(entry))));
    }
    let blocks: Vec<String> = infos.iter().map(block).collect();
    print(&blocks.join("\n"))
}

fn block(info: &ModelInfo) -> String {
    let ModelInfo { name, source, domain, leaves_out } = info;
    format!("{name}\n  source:     {source}\n  domain:     {domain}\n  leaves out: {leaves_out}\n")
}

fn entry(info: &ModelInfo) -> Value {
    let ModelInfo { name, source, domain, leaves_out } = info;
    json!({"name": name, "source": source, "domain": domain, "leaves_out": leaves_out})
}

fn judge(options: &ModelsOptions) -> Outcome {
    let subjects: Vec<ModelSubject> = valid(read(&options.judge)?, false)?
        .into_iter()
        .map(|material| ModelSubject {
            wavelengths_nm: material.bake.wavelengths_nm(),
            name: material.name,
            stack: material.stack,
        })
        .collect();
    let bar = Bar::new("judging models");
    let settings = ModelSettings { samples: options.samples, seed: 0 };
    let report = judge_models(&subjects, settings, &|done, total| bar.set(done as u64, total as u64));
    drop(bar);
    if options.json {
        return print(&report.to_json().map_err(Failure::input)?);
    }
    print(&report.to_markdown(&command(options)))
}

/// The command line that makes the page.
fn command(options: &ModelsOptions) -> String {
    let mut words = vec!["luthier models --judge".to_owned()];
    words.extend(options.judge.iter().map(|path| path.display().to_string()));
    if options.samples != MODEL_SAMPLES {
        words.push(format!("--samples {}", options.samples));
    }
    words.join(" ")
}
