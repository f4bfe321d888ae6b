//! Why a method does not hold, and how far each reason goes.

use super::{Cell, Fault, Level, Verdict};

/// A reason, and the cells that it is for.
#[derive(Debug, Clone, Copy)]
pub struct Explanation {
    /// Its name.
    pub name: &'static str,
    /// Levels.
    pub levels: &'static [Level],
    /// Names of methods; one that ends in `*` stands for all that begin so.
    pub methods: &'static [&'static str],
    /// Identifiers of cases, likewise.
    pub cases: &'static [&'static str],
    /// Faults.
    pub faults: &'static [Fault],
    /// Largest error that it explains.
    pub limit: f64,
    /// The reason.
    pub reason: &'static str,
}

/// All reasons; the first that fits counts.
pub const EXPLANATIONS: &[Explanation] = &[];

fn matches(patterns: &[&str], name: &str) -> bool {
    patterns.iter().any(|p| p.strip_suffix('*').map_or(*p == name, |start| name.starts_with(start)))
}

/// The reason for a cell; `None` for a cell that holds, and for one that nobody can explain.
pub fn explanation(cell: &Cell) -> Option<&'static Explanation> {
    if cell.verdict == Verdict::Holds || (cell.level.ships() && cell.fault == Some(Fault::NotFinite)) {
        return None;
    }
    EXPLANATIONS.iter().find(|e| {
        e.levels.contains(&cell.level)
            && matches(e.methods, &cell.method)
            && matches(e.cases, &cell.case)
            && cell.fault.is_some_and(|fault| e.faults.contains(&fault))
            && cell.error <= e.limit
    })
}
