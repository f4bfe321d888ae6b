//! The page, in Markdown.

use std::fmt::Write;

use super::{Level, Stability};

pub(super) fn markdown(stability: &Stability, _command: &str) -> String {
    let mut out = String::new();
    for cell in &stability.cells {
        if cell.verdict != super::Verdict::Holds {
            let _ = writeln!(out, "{} {} {} {:?} {:.3e} {:?}", cell.level.name(), cell.method, cell.case, cell.fault, cell.error, cell.explanation);
        }
    }
    for d in &stability.domains {
        let _ = writeln!(out, "{d:?}");
    }
    let _ = Level::ALL;
    out
}
