//! Costs of many shaders, as JSON and as Markdown.

use std::fmt::Write as _;

use luthier_manifest::{Form, ShadingModel};
use luthier_shader::style_name;
use serde::Serialize;

use crate::{Compiled, CostError, Counts, Family};

/// Version of the JSON.
const SCHEMA: u32 = 1;

/// Counts of many shaders. docs/measurements/README.md describes the JSON.
///
/// ```
/// use luthier_cost::{Compiled, CostReport, Counts, Family};
///
/// let compiled = Compiled { driver: "radv 25".to_owned(), device: "null".to_owned(), counts: Vec::new() };
/// let mut report = CostReport::default();
/// report.add_family(Family::Gcn5, &compiled, Counts::default());
/// let json: serde_json::Value = serde_json::from_str(&report.to_json()?)?;
/// assert_eq!((&json["driver"], &json["families"][0]["chip"]), (&"radv 25".into(), &"vega10".into()));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Default)]
pub struct CostReport {
    /// Program and version.
    pub generator: String,
    /// Driver and version.
    pub driver: String,
    /// The instruction sets.
    pub families: Vec<FamilyCost>,
    /// The shaders on them.
    pub rows: Vec<CostRow>,
}

/// One instruction set.
#[derive(Debug, Serialize)]
pub struct FamilyCost {
    /// Its name.
    pub family: Family,
    /// The chip, as RADV names it.
    pub chip: String,
    /// The device that the driver stands in for.
    pub device: String,
    /// Counts of the harness, subtracted from every row.
    pub harness: Counts,
}

/// One shader on one instruction set, without the harness.
#[derive(Debug, Serialize)]
pub struct CostRow {
    /// The material, or a set of them in words.
    pub material: String,
    /// The model.
    pub model: ShadingModel,
    /// The form.
    pub form: Form,
    /// D comes in closed form, or there is none.
    pub closed: bool,
    /// The material is constants of the code.
    pub constant: bool,
    /// The instruction set.
    pub family: Family,
    /// Counts beyond those of the harness.
    #[serde(flatten)]
    pub counts: Counts,
}

impl CostReport {
    /// Adds a family that kernels were compiled for. `harness` has the counts that are subtracted from every row of the family.
    pub fn add_family(&mut self, family: Family, compiled: &Compiled, harness: Counts) {
        self.driver.clone_from(&compiled.driver);
        let (chip, device) = (family.chip().to_owned(), compiled.device.clone());
        self.families.push(FamilyCost { family, chip, device, harness });
    }

    /// JSON, a row of it per line.
    ///
    /// # Errors
    /// [`CostError::Exchange`], should a value have no JSON.
    pub fn to_json(&self) -> Result<String, CostError> {
        Ok(format!(
            "{{\n  \"schema\": {SCHEMA},\n  \"generator\": {},\n  \"driver\": {},\n  \"families\": {},\n  \"rows\": {}\n}}\n",
            serde_json::to_string(&self.generator)?,
            serde_json::to_string(&self.driver)?,
            json_lines(&self.families)?,
            json_lines(&self.rows)?,
        ))
    }

    /// A page on every model; `command` is the command line that makes it.
    pub fn to_markdown(&self, command: &str) -> String {
        let mut out = self.introduction("What the shaders cost on GPUs", command);
        out.push_str(" All counts are in `docs/measurements/gpu-cost.json`.\n");
        for family in &self.families {
            self.models(&mut out, family.family);
        }
        out
    }

    /// The beginning of a page: its title, the command line that makes it, and the meaning of counts. It ends without a line break.
    pub fn introduction(&self, title: &str, command: &str) -> String {
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
        format!(
            "# {title}\n\n\
             Made by `{command}`, {}. No GPU is needed: Mesa's driver `{}` compiles every shader for chips that this machine does not have, \
             and reports the cycles that its own model of each chip predicts. One driver always gives the same numbers for a shader. The page subtracts the cost \
             of the harness (the code around the evaluation) unless it says otherwise. That cost is in brackets: {}.\n\n\
             *Inverse throughput* is the number of cycles per wave of 64 threads by that model, with all waves in flight. Read it with two reservations. \
             Code in a branch counts three quarters of its cycles (half, where all threads agree), and the factors of nested branches multiply, so that \
             a second layer looks cheaper than the first. A short kernel is charged its latency divided by the number of waves.\n\n\
             *Issue* is the number of cycles that one SIMD takes to issue the vector instructions of all branches, counted in the machine code: no branch \
             is skipped, and no instruction waits. A plain instruction takes 4 cycles on GCN5 and 2 on RDNA; a reciprocal, root, exponential or logarithm takes \
             16 and 8, and overlaps with other instructions on RDNA.\n\n\
             A fetch counts as one issued instruction. Caches are not modelled, which makes tables look cheaper than they are; `docs/measurements/` has times \
             on devices.\n\n\
             *constants* means that the numbers of the one material are in the code instead of a buffer (`luthier shader --constant`). *closed D* means that \
             Fresnel's reflectance comes from its table and the slope distribution from its closed form (`luthier shader --closed`).",
            self.generator,
            self.driver,
            chips.join(", "),
        )
    }

    /// Every model of every material on one family.
    fn models(&self, out: &mut String, family: Family) {
        let _ = writeln!(
            out,
            "\n## Every model on {family}\n\n\
             The columns are inverse throughput, *issue*, vector registers and reads of textures: the smallest and the largest number over the materials.\n\n\
             | model | form | inverse throughput | issue | registers | reads |\n|---|---|--:|--:|--:|--:|"
        );
        let mut seen: Vec<(ShadingModel, Form, bool, bool)> = Vec::new();
        for row in self.rows.iter().filter(|row| row.family == family) {
            let key = (row.model, row.form, row.closed, row.constant);
            if seen.contains(&key) {
                continue;
            }
            seen.push(key);
            let same = self.rows.iter().filter(|other| other.family == family);
            let same = same.filter(|other| (other.model, other.form, other.closed, other.constant) == key);
            let counts: Vec<Counts> = same.map(|other| other.counts).collect();
            let _ = writeln!(
                out,
                "| {} | {} | {} | {} | {} | {} |",
                row.model.name(),
                style_name(row.model, row.form, row.closed, row.constant),
                range(&counts, |c| c.inverse_throughput),
                range(&counts, |c| c.issue_cycles),
                range(&counts, |c| c.vgprs),
                range(&counts, |c| c.texture_reads),
            );
        }
        let spilling = self.rows.iter().filter(|row| row.family == family && row.counts.spills > 0).count();
        let _ = writeln!(out, "\nShaders that spill registers: {spilling}.");
    }
}

/// A JSON list with one value per line.
fn json_lines(values: &[impl Serialize]) -> Result<String, CostError> {
    let values = values.iter().map(serde_json::to_string).collect::<Result<Vec<_>, _>>()?;
    Ok(format!("[\n    {}\n  ]", values.join(",\n    ")))
}

/// The smallest and the largest of some counts.
fn range(counts: &[Counts], count: fn(&Counts) -> i64) -> String {
    let least = counts.iter().map(count).min().unwrap_or(0);
    let most = counts.iter().map(count).max().unwrap_or(0);
    if least == most { least.to_string() } else { format!("{least}..{most}") }
}
