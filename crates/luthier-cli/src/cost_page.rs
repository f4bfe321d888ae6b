//! What `luthier cost` found, as JSON and as Markdown.

use std::fmt::Write as _;

use luthier_cost::{Counts, Family};
use luthier_lut::ShadingModel;
use serde::Serialize;

/// All that was counted.
#[derive(Debug, Serialize)]
pub(crate) struct CostReport {
    pub(crate) generator: String,
    /// Driver and version.
    pub(crate) driver: String,
    pub(crate) families: Vec<FamilyCost>,
    pub(crate) rows: Vec<CostRow>,
}

/// One instruction set.
#[derive(Debug, Serialize)]
pub(crate) struct FamilyCost {
    pub(crate) family: Family,
    pub(crate) chip: String,
    pub(crate) device: String,
    /// What is subtracted from every row.
    pub(crate) harness: Counts,
}

/// One shader on one instruction set, without the harness.
#[derive(Debug, Serialize)]
pub(crate) struct CostRow {
    pub(crate) material: String,
    pub(crate) model: ShadingModel,
    pub(crate) form: String,
    pub(crate) family: Family,
    #[serde(flatten)]
    pub(crate) counts: Counts,
}

impl CostReport {
    pub(crate) fn to_markdown(&self, command: &str) -> String {
        let mut out = format!("# What the shaders cost\n\n    {command}\n\n{}\n", self.driver);
        for row in &self.rows {
            let c = &row.counts;
            let _ = writeln!(
                out,
                "| {} | {} | {} | {} | {} | {} | {} | {} | {} | {} | {} | {} | {} | {} |",
                row.material,
                row.model.name(),
                row.form,
                row.family,
                c.instructions,
                c.inverse_throughput,
                c.latency,
                c.vgprs,
                c.waves,
                c.code_bytes,
                c.spills,
                c.texture_reads,
                c.buffer_reads,
                c.branches
            );
        }
        out
    }
}
