//! `models`: the list of reflectance models.

use luthier_layers::model::{Claims, Kind, ModelInfo};
use luthier_layers::registry::models;
use luthier_terminal::{Outcome, print};
use serde_json::{Value, json};

use crate::cli::ModelsOptions;

/// Lists the reflectance models.
pub(crate) fn run(options: &ModelsOptions) -> Outcome {
    let infos: Vec<ModelInfo> = models().iter().map(|model| model.info()).collect();
    if options.json {
        return print(&format!("{:#}", Value::from_iter(infos.iter().map(entry))));
    }
    let groups = Kind::ALL.map(|kind| {
        let blocks: Vec<String> = infos.iter().filter(|info| info.kind == kind).map(block).collect();
        format!("{}:\n\n{}", title(kind), blocks.join("\n"))
    });
    print(&groups.join("\n"))
}

fn title(kind: Kind) -> &'static str {
    match kind {
        Kind::Surface => "Single surfaces (the first interface, or the diffuse base)",
        Kind::Layered => "Layered models",
        Kind::Place => "Models that look different from place to place",
        Kind::Density => "Densities of sampling methods (in place of f cos theta_i)",
        Kind::Reference => "References",
    }
}

fn block(info: &ModelInfo) -> String {
    let ModelInfo { name, kind, claims, source, domain, leaves_out, inputs } = info;
    let mut text =
        format!("  {name}\n    source:     {source}\n    domain:     {domain}\n    leaves out: {leaves_out}\n");
    // A density is no reflectance.
    if *kind != Kind::Density {
        let keeps = match *claims {
            Claims { reciprocal: true, conserves_energy: true } => "reciprocity, energy",
            Claims { reciprocal: true, .. } => "reciprocity",
            Claims { conserves_energy: true, .. } => "energy",
            Claims { .. } => "neither reciprocity nor energy",
        };
        text.push_str(&format!("    keeps:      {keeps}\n"));
    }
    if !inputs.is_empty() {
        let options: Vec<String> = inputs.iter().map(|input| format!("--{}", input.name())).collect();
        text.push_str(&format!("    takes:      {}\n", options.join(", ")));
    }
    text
}

fn entry(info: &ModelInfo) -> Value {
    let ModelInfo { name, kind, claims, source, domain, leaves_out, inputs } = info;
    json!({
        "name": name,
        "kind": kind.name(),
        "source": source,
        "domain": domain,
        "leaves_out": leaves_out,
        "reciprocal": claims.reciprocal,
        "conserves_energy": claims.conserves_energy,
        "inputs": inputs.iter().map(|input| input.name()).collect::<Value>(),
    })
}
