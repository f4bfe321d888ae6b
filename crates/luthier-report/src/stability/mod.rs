//! Stability: every method on stacks and directions at which methods fail.
//!
//! A *case* is a stack and directions at which some formula divides by little, overflows or stops being true ([`cases`]).
//! A *method* is a reflectance model or the shader of one; it is run on every case at four levels:
//!
//! - *f64*: all registered models. The laws come first: values are finite, not negative, and 0 at and below the horizon; models are reciprocal and
//!   conserve energy if they claim so. Then the directional albedo is compared with the truth: the closed form if all interfaces are smooth, else the
//!   paths of `layered-mc` (four of its standard errors are taken off the error).
//! - *table*: f64 arithmetic on the texels that ship, against exact terms.
//! - *f32*: the form `full` of the shader on the adapter: all of it is arithmetic in single precision.
//! - *device*: the form `baked` on the adapter: arithmetic and texture fetches.
//!
//! f32 and device are compared with the model in f64 with exact terms. On a software adapter both compute in IEEE single precision on the CPU.
//! A GPU fuses and reorders operations of the same WGSL, and has coarser reciprocals and sines, within the limits of WGSL.
//!
//! *Formulations* ([`formulas`]) complement the cases: ways to write or to store one function, shipped or rejected, each with its error against a named
//! truth.
//!
//! [`Shipped`] is the part of it that a report has: the levels of one material of a bake at the directions of the suite, and the light that they return.
//!
//! Everything that does not hold has an [`explain::Explanation`], with a limit: an error beyond it is unexplained.
//!
//! Out of scope: maps and places (flakes, patina and glitter as shaders), whose inner normals no case tilts.

mod aim;
mod case;
mod domains;
pub mod explain;
mod formulas;
mod models;
mod page;
mod shaders;
mod shipped;
mod svg;

use serde::{Deserialize, Serialize};

use crate::error::ReportError;
use crate::text::json;

pub use aim::Aim;
pub use case::{StressCase, cases};
pub use domains::{DomainRange, derived};
pub use formulas::{FormulaResult, PITFALLS, formulas};
pub use models::model_cells;
pub use shaders::shader_cells;
pub(crate) use shipped::shipped;
pub use shipped::{Shipped, ShippedAlbedo, Stressed};
pub use svg::heat_map_svg;

/// Error of a shader (relative, see [`crate::FLOOR`]) up to which it holds: the goal of 1%.
pub const HOLDS: f64 = 0.01;

/// Error of an albedo (absolute) up to which a model holds: just visible between two surfaces side by side.
pub const HOLDS_ALBEDO: f64 = 0.02;

/// Error of a shader beyond which it no longer shows its model, and of an albedo beyond which the surface adds more light than falls on it.
pub const FAILS: f64 = 1.0;

/// Largest relative difference on exchanging directions that counts as rounding. Beyond it a BRDF is not reciprocal.
pub const RECIPROCITY: f64 = 1e-6;

luthier_lut::named! {
    /// Level at which a method runs.
    #[derive(Serialize, Deserialize)]
    #[serde(rename_all = "kebab-case")]
    pub enum Level("level") {
        /// A model in double precision.
        F64 = "f64",
        /// The tables of a shader, read in double precision.
        Table = "table",
        /// The shader without tables on the adapter.
        F32 = "f32",
        /// The shader with tables on the adapter.
        Device = "device",
    }
}

impl Level {
    /// The part of a bake that runs at this level, as reports call it.
    pub fn shipped_name(self) -> &'static str {
        match self {
            Self::F64 => "model",
            Self::Table => "tables",
            Self::F32 => "full shader",
            Self::Device => "baked shader",
        }
    }

    /// Whether the code of this level ships.
    pub fn ships(self) -> bool {
        self != Self::F64
    }
}

/// Verdict on a method on a case.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize, PartialOrd, Ord)]
#[serde(rename_all = "kebab-case")]
pub enum Verdict {
    /// The error is within [`HOLDS`] or [`HOLDS_ALBEDO`].
    Holds,
    /// The error is within [`FAILS`].
    Degrades,
    /// A law is broken, or the value is beyond use.
    Fails,
}

impl Verdict {
    /// The name in reports.
    pub fn name(self) -> &'static str {
        match self {
            Self::Holds => "holds",
            Self::Degrades => "degrades",
            Self::Fails => "fails",
        }
    }
}

/// Way in which a method fails or degrades.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize, PartialOrd, Ord)]
#[serde(rename_all = "kebab-case")]
pub enum Fault {
    /// A value is NaN or infinite.
    NotFinite,
    /// A value is negative where the truth is not, or there is light at or below the horizon.
    Negative,
    /// The albedo is above 1, though the method claims that it never is.
    Gains,
    /// The BRDF changes when directions are exchanged, though the method claims that it does not.
    NotReciprocal,
    /// Too bright or too dark.
    Wrong,
}

impl Fault {
    /// The name in reports.
    pub fn name(self) -> &'static str {
        match self {
            Self::NotFinite => "not finite",
            Self::Negative => "negative",
            Self::Gains => "gains energy",
            Self::NotReciprocal => "not reciprocal",
            Self::Wrong => "wrong",
        }
    }
}

/// One method on one case.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Cell {
    /// Level at which it runs.
    pub level: Level,
    /// Name of the model.
    pub method: String,
    /// Identifier of the case.
    pub case: String,
    /// Verdict on the method.
    pub verdict: Verdict,
    /// Fault of the method, unless it holds.
    pub fault: Option<Fault>,
    /// Size of the fault, or the largest error; 0 for values that are not finite, and for a case without comparisons.
    pub error: f64,
    /// Name of the explanation; `None` for a cell that holds, and for an unexplained one.
    pub explanation: Option<String>,
}

impl Cell {
    fn new(level: Level, method: &str, case: &str, fault: Option<Fault>, error: f64) -> Self {
        let holds = if level == Level::F64 { HOLDS_ALBEDO } else { HOLDS };
        let (verdict, fault) = match fault {
            Some(fault) => (Verdict::Fails, Some(fault)),
            None if error <= holds => (Verdict::Holds, None),
            None if error <= FAILS => (Verdict::Degrades, Some(Fault::Wrong)),
            None => (Verdict::Fails, Some(Fault::Wrong)),
        };
        let error = if error.is_finite() { error } else { 0.0 };
        let mut cell =
            Self { level, method: method.to_owned(), case: case.to_owned(), verdict, fault, error, explanation: None };
        cell.explanation = explain::explanation(&cell).map(|e| e.name.clone());
        cell
    }

    /// Whether the cell holds or has an explanation.
    pub fn is_explained(&self) -> bool {
        self.verdict == Verdict::Holds || self.explanation.is_some()
    }
}

/// Description of a case for a reader.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct CaseInfo {
    /// Identifier.
    pub id: String,
    /// Description of the case.
    pub title: String,
    /// Name of the quantity that it sweeps, and its value.
    pub swept: Option<(String, f64)>,
    /// Truth that albedos are compared with.
    pub truth: String,
}

/// A run of the suite.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Stability {
    /// Program and version.
    pub generator: String,
    /// The adapter; `None` without one.
    pub device: Option<String>,
    /// The cases.
    pub cases: Vec<CaseInfo>,
    /// Every method on every case that it applies to.
    pub cells: Vec<Cell>,
    /// Ways to write or to store one function.
    pub formulas: Vec<FormulaResult>,
    /// Domain of each model, by quantity.
    pub domains: Vec<DomainRange>,
}

impl Stability {
    /// A run of some cells.
    pub fn new(generator: &str, device: Option<String>, cells: Vec<Cell>) -> Self {
        let all = cases();
        let domains = derived(&all, &cells);
        let cases = all.iter().map(|case| CaseInfo {
            id: case.id.clone(),
            title: case.title.clone(),
            swept: case.swept.map(|(quantity, value)| (quantity.name().to_owned(), value)),
            truth: models::truth_name(case).to_owned(),
        });
        let cases = cases.collect();
        Self { generator: generator.to_owned(), device, cases, cells, formulas: formulas(), domains }
    }

    /// Cells that neither hold nor have an explanation.
    pub fn unexplained(&self) -> impl Iterator<Item = &Cell> {
        self.cells.iter().filter(|cell| !cell.is_explained())
    }

    /// Cells of shaders and tables that are NaN or infinite somewhere.
    pub fn not_finite(&self) -> impl Iterator<Item = &Cell> {
        self.cells.iter().filter(|cell| cell.level.ships() && cell.fault == Some(Fault::NotFinite))
    }

    /// Formulations that ship and do not hold, or that have no explanation.
    pub fn broken_formulas(&self) -> impl Iterator<Item = &FormulaResult> {
        self.formulas.iter().filter(|formula| !formula.is_as_expected())
    }

    /// Whether shaders and tables are finite everywhere, and every cell and formulation is explained.
    pub fn holds(&self) -> bool {
        self.unexplained().next().is_none()
            && self.not_finite().next().is_none()
            && self.broken_formulas().next().is_none()
    }

    /// JSON, objects indented and arrays in a line, with a final newline.
    ///
    /// # Errors
    /// [`ReportError::Json`], should the writer fail.
    pub fn to_json(&self) -> Result<String, ReportError> {
        json::to_string(self)
    }

    /// Reads what [`Stability::to_json`] wrote.
    ///
    /// # Errors
    /// [`ReportError::Json`] for other JSON.
    pub fn from_json(json: &str) -> Result<Self, ReportError> {
        Ok(serde_json::from_str(json)?)
    }

    /// A page in Markdown; `command` is the command line that makes it.
    pub fn to_markdown(&self, command: &str) -> String {
        page::markdown(self, command)
    }

    fn cell(&self, level: Level, method: &str, case: &str) -> Option<&Cell> {
        self.cells.iter().find(|c| c.level == level && c.method == method && c.case == case)
    }

    /// Methods of a level, in the order of the cells.
    fn methods(&self, level: Level) -> Vec<&str> {
        let mut names: Vec<&str> = Vec::new();
        for cell in self.cells.iter().filter(|c| c.level == level) {
            if !names.contains(&cell.method.as_str()) {
                names.push(&cell.method);
            }
        }
        names
    }
}
