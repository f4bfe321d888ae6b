//! A table that is ready to go, and how it is delivered.

use std::path::PathBuf;

use luthier_lut::{ErrorStats, Image};
use luthier_optics::stack::Distribution;
use luthier_report::{Certificate, ErrorMap};
use luthier_table::{Container, Nodes, Stored};
use luthier_terminal::{Outcome, files, print};
use serde_json::{Value as Json, json};

use super::container::encode;
use crate::cli::{Delivery, DistributionName, NodesName};

/// Files of a table, with a page and the outcome in words.
pub(super) struct Product {
    /// The table first, then its shaders.
    pub(super) files: Vec<(PathBuf, Vec<u8>)>,
    /// The page.
    pub(super) certificate: Certificate,
    /// The outcome for programs: an object, to which the names and sizes of files are added.
    pub(super) json: Json,
    /// The outcome for people, without the files.
    pub(super) text: String,
}

/// Writes the files and the page, and prints the outcome.
pub(super) fn deliver(product: Product, delivery: &Delivery) -> Outcome {
    let Product { files: mut written, certificate, mut json, text } = product;
    if let Some(path) = &delivery.report {
        written.push((path.clone(), certificate.html().into_bytes()));
    }
    let folder = &delivery.output;
    if written.iter().any(|(path, _)| path.parent() == Some(folder)) {
        std::fs::create_dir_all(folder).map_err(files(folder, "create"))?;
    }
    for (path, bytes) in &written {
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

/// A table whose reads are measured, before it becomes files.
pub(super) struct Sampled<'a> {
    /// Title of the page.
    pub(super) title: &'a str,
    /// The table in words.
    pub(super) words: String,
    /// The table for programs.
    pub(super) statement: Json,
    /// Texels as they are read.
    pub(super) texels: &'a Image,
    /// Container and number type.
    pub(super) file: (Container, Stored),
    /// Error of reads, the names of the quantities of its worst place, and where it counts.
    pub(super) error: (ErrorStats, &'a [&'a str], String),
    /// Limit of the errors, if one is asked for.
    pub(super) max_abs: Option<f64>,
    /// Rows of the page before those of the error.
    pub(super) facts: Vec<(String, String)>,
    /// Maps of the errors.
    pub(super) maps: Vec<ErrorMap>,
    /// How errors were measured.
    pub(super) method: &'a str,
}

/// The file of a table, its page and its words.
pub(super) fn sampled(table: Sampled<'_>, delivery: &Delivery) -> Outcome<Product> {
    let Sampled { title, words, statement, texels, file: (container, stored), error, max_abs, mut facts, maps, method } =
        table;
    let (error, quantities, domain) = error;
    let measured = error_json(&error, &domain);
    let metadata = json!({ "table": statement, "error": measured }).to_string();
    let comment = format!("{words}. Largest error as sampled: {:.2e}, over {domain}.", error.max_abs_err);
    let bytes = encode(container, texels, stored, &comment, &metadata, delivery.no_zstd)?;
    facts.push(fact("Domain", domain.clone()));
    facts.extend(error_facts(&error, quantities));
    let largest = format!("largest error as sampled {:.2e}", error.max_abs_err);
    let verdict = verdict(max_abs, largest);
    let certificate = Certificate { title: title.to_owned(), verdict, facts, maps, method: method.to_owned() };
    let held = max_abs.map_or(String::new(), |limit| format!("holds {limit}\n"));
    let text = format!("{words}\n{}{held}", error_text(&error, quantities, &domain));
    let json = json!({ "table": statement, "max_abs": max_abs, "error": measured });
    Ok(Product { files: vec![(delivery.output.clone(), bytes)], certificate, json, text })
}

/// The largest error in the words of a certificate, and whether it holds the limit, if there is one.
pub(super) fn verdict(max_abs: Option<f64>, largest: String) -> (String, Option<bool>) {
    match max_abs {
        Some(limit) => (format!("holds {limit}: {largest}"), Some(true)),
        None => (largest, None),
    }
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

/// The position of nodes in texels, in the words of `luthier audit --nodes`.
pub(super) fn nodes_name(nodes: Nodes) -> &'static str {
    if nodes == Nodes::Ends { "ends" } else { "centres" }
}

/// The position of nodes that the command line asks for.
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
