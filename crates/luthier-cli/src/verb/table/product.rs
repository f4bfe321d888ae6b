//! A table that is ready to go, and how it is delivered.

use std::path::PathBuf;

use luthier_lut::ErrorStats;
use luthier_report::Certificate;
use luthier_table::{DfgTable, Layout, Nodes};
use luthier_terminal::{Outcome, files, print};
use serde_json::{Value as Json, json};

use crate::cli::Delivery;

/// Files of a table, and all that is said of them.
pub(super) struct Product {
    /// The table first, then what belongs to it.
    pub(super) files: Vec<(PathBuf, Vec<u8>)>,
    /// The page.
    pub(super) certificate: Certificate,
    /// The outcome for programs; the names and sizes of files are added.
    pub(super) json: serde_json::Map<String, Json>,
    /// The outcome for people, without the files.
    pub(super) text: String,
}

/// Writes the files and the page, and says what they are.
pub(super) fn deliver(product: Product, delivery: &Delivery) -> Outcome {
    let Product { mut files, certificate, mut json, text } = product;
    if let Some(path) = &delivery.report {
        files.push((path.clone(), certificate.html().into_bytes()));
    }
    for (path, bytes) in &files {
        std::fs::write(path, bytes).map_err(self::files(path, "write"))?;
    }
    if delivery.json {
        let listed = files.iter().map(|(path, bytes)| json!({ "file": path, "bytes": bytes.len() }));
        json.insert("files".to_owned(), listed.collect());
        return print(&format!("{:#}", Json::Object(json)));
    }
    let listed: String =
        files.iter().map(|(path, bytes)| format!("{}: {} bytes\n", path.display(), bytes.len())).collect();
    print(&format!("{listed}{text}"))
}

/// The split-sum table in words.
pub(super) fn words(table: &DfgTable) -> String {
    let DfgTable { distribution, masking, layout, values, size: [width, height], stored } = table;
    let values = values.iter().map(|value| value.name()).collect::<Vec<_>>().join(",");
    let (name, masking, stored) = (distribution.name(), masking.name(), stored.name());
    format!(
        "Split sum, {name}, masking {masking}; {values} over {layout}, nodes at {}; {width} x {height}, {stored}",
        nodes(layout)
    )
}

/// Where the nodes of a layout are, in the words of `luthier audit --nodes`.
pub(super) fn nodes(layout: &Layout) -> &'static str {
    if layout.angle.nodes == Nodes::Ends { "ends" } else { "centres" }
}

/// An error as sampled, and where it holds, for JSON and for metadata of files.
pub(super) fn error_json(error: &ErrorStats, [min_cos, min_alpha]: [f64; 2]) -> Json {
    json!({
        "max_abs_err": error.max_abs_err, "rms_err": error.rms_err, "p99_abs_err": error.p99_abs_err, "worst": error.worst,
        "points": error.points, "min_cos": min_cos, "min_alpha": min_alpha, "filter": "bilinear, 8-bit weights",
    })
}
