//! x
use serde::{Deserialize, Serialize};
/// x
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct FormulaResult { /// x
 pub row: String, /// x
 pub formulation: String }
impl FormulaResult { /// x
 pub fn is_as_expected(&self) -> bool { true } }
/// x
pub const SECTION_C: [&str; 0] = [];
/// x
pub fn formulas() -> Vec<FormulaResult> { Vec::new() }
