//! Results of `luthier cost`, as JSON and as Markdown.

use std::fmt::Write as _;

use luthier_cost::{Counts, Family};
use luthier_manifest::ShadingModel;
use serde::Serialize;

/// Version of the JSON.
const SCHEMA: u32 = 1;

/// All that was counted. The JSON of it is described in docs/measurements/README.md.
#[derive(Debug, Default)]
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
    /// Counts of the harness, subtracted from every row.
    pub(crate) harness: Counts,
}

/// One shader on one instruction set, without the harness.
#[derive(Debug, Serialize)]
pub(crate) struct CostRow {
    pub(crate) material: String,
    pub(crate) model: ShadingModel,
    pub(crate) form: String,
    /// D comes in closed form, or there is none.
    pub(crate) closed: bool,
    /// The material is constants of the code.
    pub(crate) constant: bool,
    pub(crate) family: Family,
    #[serde(flatten)]
    pub(crate) counts: Counts,
}

/// Whether shaders of a model read D from a table.
pub(crate) fn reads_d(model: ShadingModel) -> bool {
    matches!(model, ShadingModel::Elek | ShadingModel::WeidlichWilkie | ShadingModel::Microfacet)
}

/// How a row of the page is called.
pub(crate) fn label(model: ShadingModel, form: &str, closed: bool, constant: bool) -> String {
    let d = if form == "baked" && closed && reads_d(model) { ", closed D" } else { "" };
    let numbers = if constant { ", constants" } else { "" };
    format!("{form}{d}{numbers}")
}

impl CostReport {
    /// JSON, a row of it per line.
    pub(crate) fn to_json(&self) -> Result<String, serde_json::Error> {
        let lines = |values: Vec<String>| format!("[\n    {}\n  ]", values.join(",\n    "));
        let families = self.families.iter().map(serde_json::to_string).collect::<Result<Vec<_>, _>>()?;
        let rows = self.rows.iter().map(serde_json::to_string).collect::<Result<Vec<_>, _>>()?;
        Ok(format!(
            "{{\n  \"schema\": {SCHEMA},\n  \"generator\": {},\n  \"driver\": {},\n  \"families\": {},\n  \"rows\": {}\n}}\n",
            serde_json::to_string(&self.generator)?,
            serde_json::to_string(&self.driver)?,
            lines(families),
            lines(rows),
        ))
    }

    pub(crate) fn to_markdown(&self, command: &str, papers: &str) -> String {
        let chips: Vec<String> = self
            .families
            .iter()
            .map(|f| {
                let Counts { instructions, inverse_throughput, issue_cycles, .. } = f.harness;
                format!(
                    "{} ({}: {instructions} instructions, {inverse_throughput} and {issue_cycles} cycles)",
                    f.family, f.chip
                )
            })
            .collect();
        let mut out = format!(
            "# What the shaders cost on GPUs\n\n\
             Made by `{command}`, luthier {}. No GPU is involved: Mesa's driver `{}` compiles every shader for chips that are not there, \
             and reports what its own model of them says. Same driver, same shaders, same numbers. In brackets what the harness alone \
             costs, which is subtracted unless said otherwise: {}.\n\n\
             *Inverse throughput* is cycles per wave of 64 by that model, all waves in flight. It has two habits to know: what lies \
             under a branch counts three quarters (half, where all threads agree), nested ones multiplied, so that a second layer looks \
             cheaper than a first; and a short kernel is charged its latency over the number of waves. *Issue* is cycles that the vector \
             instructions of all branches take to issue on one SIMD (a plain instruction 4 on GCN5 and 2 on RDNA, a reciprocal, root, \
             exponential or logarithm 16 and 8, overlapping with the others on RDNA), counted in the machine code: no branch \
             is skipped and nothing waits. A fetch counts as issued: no cache is modelled, which flatters tables; time on a device is in \
             `docs/measurements/`.\n\n\
             *constants*: the numbers of the one material are in the code instead of a buffer (`luthier shader --constant`). *closed D*: \
             Fresnel from its table, the slope distribution in closed form (`luthier shader --closed`). All counts are in \
             `docs/measurements/gpu-cost.json`.\n",
            env!("CARGO_PKG_VERSION"),
            self.driver,
            chips.join(", "),
        );
        out.push_str(papers);
        for family in &self.families {
            self.models(&mut out, family.family);
        }
        out
    }

    /// Every model of every material on one family.
    fn models(&self, out: &mut String, family: Family) {
        let _ = writeln!(
            out,
            "\n## Every model on {family}\n\n\
             Inverse throughput, *issue*, vector registers and reads of textures, the least and the most of the materials.\n\n\
             | model | form | inverse throughput | issue | registers | reads |\n|---|---|--:|--:|--:|--:|"
        );
        let mut seen: Vec<(ShadingModel, &str, bool, bool)> = Vec::new();
        for row in self.rows.iter().filter(|row| row.family == family) {
            let key = (row.model, row.form.as_str(), row.closed, row.constant);
            if seen.contains(&key) {
                continue;
            }
            seen.push(key);
            let same = || {
                let of = |other: &&CostRow| (other.model, other.form.as_str(), other.closed, other.constant) == key;
                self.rows.iter().filter(|other| other.family == family).filter(of)
            };
            let range = |count: &dyn Fn(&Counts) -> i64| {
                let values = || same().map(|other| count(&other.counts));
                let (least, most) = (values().min().unwrap_or(0), values().max().unwrap_or(0));
                if least == most { least.to_string() } else { format!("{least}..{most}") }
            };
            let _ = writeln!(
                out,
                "| {} | {} | {} | {} | {} | {} |",
                row.model.name(),
                label(row.model, &row.form, row.closed, row.constant),
                range(&|c| c.inverse_throughput),
                range(&|c| c.issue_cycles),
                range(&|c| c.vgprs),
                range(&|c| c.texture_reads),
            );
        }
        let spilling = self.rows.iter().filter(|row| row.family == family && row.counts.spills > 0).count();
        let _ = writeln!(out, "\nShaders that spill registers: {spilling}.");
    }
}
