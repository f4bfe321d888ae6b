//! The heat map, drawn.

use std::fmt::Write;

use super::{Cell, Level, Stability, Verdict};
use crate::text::format::{error, escape};

/// Side of a cell, and room for the names, in SVG user units.
const SIDE: f64 = 13.0;
const NAMES: f64 = 260.0;
const HEADS: f64 = 130.0;

/// Width that the slanted head of the last column takes on the right.
const SLANT: f64 = 70.0;

/// The heat map as one SVG: a block of rows for each level, a row for each method, a column for each case. Every cell has a tooltip.
///
/// Text and frames have the current colour. Fills are the custom properties `--stability-holds`, `-degrades` and `-fails` of the page, with defaults for
/// light and dark. A dot marks a method that degrades, a cross one that fails, so that colour is not the only difference.
pub fn heat_map_svg(stability: &Stability) -> String {
    let levels: Vec<(Level, Vec<&str>)> =
        Level::ALL.into_iter().map(|level| (level, stability.methods(level))).filter(|(_, m)| !m.is_empty()).collect();
    let rows: usize = levels.iter().map(|(_, methods)| methods.len() + 1).sum();
    let width = NAMES + SIDE * stability.cases.len() as f64 + SLANT;
    let height = HEADS + SIDE * rows as f64 + 4.0;
    let mut out = format!(
        "<svg class=\"stability\" role=\"img\" aria-label=\"Stability: methods by cases\" viewBox=\"0 0 {width:.0} {height:.0}\" \
         font-size=\"9\" fill=\"currentColor\" style=\"max-width:100%\">"
    );
    for (column, case) in stability.cases.iter().enumerate() {
        let x = NAMES + SIDE * (column as f64 + 0.7);
        let y = HEADS - 5.0;
        let _ = write!(
            out,
            "<text x=\"{x:.1}\" y=\"{y:.1}\" transform=\"rotate(-55 {x:.1} {y:.1})\">{}<title>{}</title></text>",
            escape(&case.id),
            escape(&case.title)
        );
    }
    let mut y = HEADS;
    for (level, methods) in levels {
        let _ = write!(out, "<text x=\"2\" y=\"{:.1}\" font-weight=\"bold\">{}</text>", y + 10.0, level.name());
        y += SIDE;
        for method in methods {
            let _ = write!(
                out,
                "<text x=\"{:.1}\" y=\"{:.1}\" text-anchor=\"end\">{}</text>",
                NAMES - 5.0,
                y + 10.0,
                escape(method)
            );
            for (column, case) in stability.cases.iter().enumerate() {
                if let Some(cell) = stability.cell(level, method, &case.id) {
                    square(&mut out, cell, NAMES + SIDE * column as f64, y);
                }
            }
            y += SIDE;
        }
    }
    out.push_str("</svg>");
    out
}

fn square(out: &mut String, cell: &Cell, x: f64, y: f64) {
    let (fill, mark) = match cell.verdict {
        Verdict::Holds => ("var(--stability-holds, #3a9d6a)", ""),
        Verdict::Degrades => ("var(--stability-degrades, #d9a441)", "M6 4.5v3M4.5 6h3"),
        Verdict::Fails => ("var(--stability-fails, #c8503c)", "M3 3l6 6M9 3l-6 6"),
    };
    let fault = cell.fault.map_or_else(String::new, |fault| format!(", {} {}", fault.name(), error(cell.error)));
    let because = cell.explanation.as_ref().map_or_else(String::new, |name| format!(" ({name})"));
    let tip = format!("{}, {}, {}: {}{fault}{because}", cell.level.name(), cell.method, cell.case, cell.verdict.name());
    let _ = write!(
        out,
        "<g transform=\"translate({x:.1} {y:.1})\"><title>{}</title><rect width=\"12\" height=\"12\" style=\"fill:{fill}\"/>",
        escape(&tip)
    );
    if !mark.is_empty() {
        let _ = write!(out, "<path d=\"{mark}\" fill=\"none\" stroke=\"#111\" stroke-width=\"1.2\"/>");
    }
    out.push_str("</g>");
}
