use luthier_layers::model::ModelInfo;
use luthier_layers::registry::models;
use serde_json::{Value, json};

use crate::cli::ModelsOptions;
use crate::failure::Outcome;
use crate::output::print;

/// Lists the reflectance models.
pub(crate) fn run(options: &ModelsOptions) -> Outcome {
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
