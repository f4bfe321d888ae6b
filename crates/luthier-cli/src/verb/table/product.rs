//! A table that is ready to go, and how it is delivered.

use std::path::PathBuf;

use luthier_lut::ErrorStats;
use luthier_optics::stack::Distribution;
use luthier_report::Certificate;
use luthier_table::Nodes;
use luthier_terminal::{Outcome, files, print};
use serde_json::{Value as Json, json};

use crate::cli::{Delivery, DistributionName, NodesName};

/// Files of a table, and all that is said of them.
pub(super) struct Product {
    /// The table first, then what belongs to it.
    pub(super) files: Vec<(PathBuf, Vec<u8>)>,
    /// The page.
    pub(super) certificate: Certificate,
    /// The outcome for programs: an object, to which the names and sizes of files are added.
    pub(super) json: Json,
    /// The outcome for people, without the files.
    pub(super) text: String,
}

/// Writes the files and the page, and says what they are.
pub(super) fn deliver(product: Product, delivery: &Delivery) -> Outcome {
    let Product { files: mut written, certificate, mut json, text } = product;
    if let Some(path) = &delivery.report {
        written.push((path.clone(), certificate.html().into_bytes()));
    }
    for (path, bytes) in &written {
        if let Some(folder) = path.parent().filter(|folder| !folder.as_os_str().is_empty()) {
            std::fs::create_dir_all(folder).map_err(files(folder, "create"))?;
        }
        std::fs::write(path, bytes).map_err(files(path, "write"))?;
    }
    if delivery.json {
        json["files"] = written.iter().map(|(path, bytes)| json!({ "file": path, "bytes": bytes.len() })).collect();
        return print(&format!("{json:#}"));
    }
    let listed: String =
        written.iter().map(|(path, bytes)| format!("{}: {} bytes\n", path.display(), bytes.len())).collect();
    print(&format!("{listed}{text}"))
}

/// A row of the page.
pub(super) fn fact(name: &str, value: impl Into<String>) -> (String, String) {
    (name.to_owned(), value.into())
}

/// The rows of the page that say how large errors are.
pub(super) fn error_facts(error: &ErrorStats, quantities: &[&str]) -> [(String, String); 2] {
    let ErrorStats { max_abs_err, p99_abs_err, rms_err, .. } = *error;
    [
        fact("Errors", format!("largest {max_abs_err:.2e}, 99 % below {p99_abs_err:.2e}, rms {rms_err:.2e}")),
        fact("Largest at", place(error, quantities)),
    ]
}

/// Where the largest error is.
fn place(error: &ErrorStats, quantities: &[&str]) -> String {
    let at = quantities.iter().zip(&error.worst.at).map(|(name, value)| format!("{name} {value:.4}"));
    at.collect::<Vec<_>>().join(", ")
}

/// An error in two lines.
pub(super) fn error_text(error: &ErrorStats, quantities: &[&str], domain: &str) -> String {
    format!(
        "error as sampled: max {:.2e} at {}; rms {:.2e}\n  over {domain}; linear between nodes, 8-bit weights\n",
        error.max_abs_err,
        place(error, quantities),
        error.rms_err,
    )
}

/// An error as sampled, and where it holds, for JSON and for metadata of files.
pub(super) fn error_json(error: &ErrorStats, domain: &str) -> Json {
    json!({
        "max_abs_err": error.max_abs_err, "rms_err": error.rms_err, "p99_abs_err": error.p99_abs_err, "worst": error.worst,
        "points": error.points, "domain": domain, "filter": "linear between nodes, 8-bit weights",
    })
}

/// The domain over cosines and alphas, in words.
pub(super) fn domain(min_cos: f64, min_alpha: f64) -> String {
    format!("cos_theta >= {min_cos}, alpha >= {min_alpha}")
}

/// Where nodes are, in the words of `luthier audit --nodes`.
pub(super) fn nodes_name(nodes: Nodes) -> &'static str {
    if nodes == Nodes::Ends { "ends" } else { "centres" }
}

/// Where nodes are, of the command line.
pub(super) fn nodes(name: NodesName) -> Nodes {
    match name {
        NodesName::Centres => Nodes::CENTRES,
        NodesName::Ends => Nodes::Ends,
    }
}

/// The slope distribution of the command line.
pub(super) fn distribution(name: DistributionName) -> Distribution {
    match name {
        DistributionName::Ggx => Distribution::Ggx,
        DistributionName::Beckmann => Distribution::Beckmann,
    }
}
