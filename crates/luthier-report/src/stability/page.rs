//! The page, in Markdown.

use std::fmt::Write;

use luthier_layers::domain::Quantity;

use super::explain::EXPLANATIONS;
use super::{Cell, FAILS, HOLDS, HOLDS_ALBEDO, Level, PITFALLS, Stability, Verdict};
use crate::format::{error, number};

/// Cases side by side in a table.
const COLUMNS: usize = 12;

/// The whole page.
pub(super) fn markdown(stability: &Stability, command: &str) -> String {
    let mut out = preamble(stability, command);
    summary(&mut out, stability);
    domains(&mut out, stability);
    for level in Level::ALL {
        heat_map(&mut out, stability, level);
    }
    explanations(&mut out, stability);
    formulas(&mut out, stability);
    cases(&mut out, stability);
    out
}

fn preamble(stability: &Stability, command: &str) -> String {
    let device = stability.device.as_ref().map_or("no adapter", String::as_str);
    format!(
        "# Where methods fail

Every method on stacks and directions at which formulas divide by little, overflow or stop being true. All of this page is made by

    {command}

on {device}, by {}. What runs where:

- **f64**: all registered models. First the laws: values are finite, not negative, 0 at and below the horizon; reciprocal and conserving where \
`luthier models` says so. Then the directional albedo at two angles against the truth of the case, at 525 nm.
- **table**: f64 arithmetic on the texels that ship (weights of 8 bits), against exact terms.
- **f32**: the shader without tables (`full`) on the adapter.
- **device**: the shader with tables (`baked`) on the adapter.

Rows named by a model alone are what ships where nobody asks for other tables: D is computed. Settings and budgets can choose rows of other \
formats, over Schlick's form or not, D from a table and computed phases: rows named by a model and its tables, of fixed sizes, for two models \
that read them. No other model and no albedo or film table is run in other formats.

f32 and device are against the same model in f64 with exact terms, slope parameters raised to 0.001 as all shaders do. On a software adapter \
(llvmpipe) both are IEEE single precision, so that f32 is what a correctly rounding CPU gives; a GPU fuses and reorders operations, and has coarser \
reciprocals and sines, within what WGSL allows.

**Holds**: albedo within {}, shader within {} (relative to the brightest channel, at least a tenth of a white diffuser). **Degrades**: by \
no more than {}. **Fails**: a law is broken, or the error is larger. No cell: the method is not for such stacks.
",
        stability.generator,
        number(HOLDS_ALBEDO),
        number(HOLDS),
        number(FAILS)
    )
}

fn summary(out: &mut String, stability: &Stability) {
    out.push_str("\n## Summary\n\n| level | cells | hold | degrade | fail | not finite | unexplained |\n|---|--:|--:|--:|--:|--:|--:|\n");
    for level in Level::ALL {
        let cells: Vec<&Cell> = stability.cells.iter().filter(|c| c.level == level).collect();
        let count = |verdict| cells.iter().filter(|c| c.verdict == verdict).count();
        let not_finite = cells.iter().filter(|c| c.fault == Some(super::Fault::NotFinite)).count();
        let unexplained = cells.iter().filter(|c| !c.is_explained()).count();
        let _ = writeln!(
            out,
            "| {} | {} | {} | {} | {} | {not_finite} | {unexplained} |",
            level.name(),
            cells.len(),
            count(Verdict::Holds),
            count(Verdict::Degrades),
            count(Verdict::Fails)
        );
    }
}

fn domains(out: &mut String, stability: &Stability) {
    out.push_str(
        "\n## Domains\n\nThe range of each quantity about its ordinary value over which no level of a model fails; in brackets that over which all hold. \
         `luthier bake` and `luthier check` warn of a material that leaves the first.\n\n| model |",
    );
    for quantity in Quantity::ALL {
        let _ = write!(out, " {} (ordinary {}) |", quantity.name(), number(quantity.ordinary()));
    }
    out.push_str("\n|---|");
    out.push_str(&"---|".repeat(Quantity::ALL.len()));
    out.push('\n');
    let mut models: Vec<&str> = stability.domains.iter().map(|d| d.model.as_str()).collect();
    models.dedup();
    for model in models {
        let _ = write!(out, "| {model} |");
        for quantity in Quantity::ALL {
            let domain = stability.domains.iter().find(|d| d.model == model && d.quantity == quantity.name());
            let range =
                |r: Option<[f64; 2]>| r.map_or("none".to_owned(), |[a, b]| format!("{} to {}", number(a), number(b)));
            let _ = match domain {
                Some(domain) => write!(out, " {} ({}) |", range(domain.usable), range(domain.holds)),
                None => write!(out, " – |"),
            };
        }
        out.push('\n');
    }
}

fn heat_map(out: &mut String, stability: &Stability, level: Level) {
    let methods = stability.methods(level);
    if methods.is_empty() {
        return;
    }
    let _ = writeln!(
        out,
        "\n## {}\n\n`.` holds; a number is an error that degrades; **bold** fails. The letters are the explanations below.",
        level.name()
    );
    for cases in stability.cases.chunks(COLUMNS) {
        out.push_str("\n| method |");
        for case in cases {
            let _ = write!(out, " {} |", case.id);
        }
        out.push_str("\n|---|");
        out.push_str(&"--:|".repeat(cases.len()));
        out.push('\n');
        for method in &methods {
            let cells: Vec<Option<&Cell>> = cases.iter().map(|case| stability.cell(level, method, &case.id)).collect();
            if cells.iter().all(Option::is_none) {
                continue;
            }
            let _ = write!(out, "| {method} |");
            for cell in cells {
                let _ = write!(out, " {} |", cell.map_or_else(String::new, text));
            }
            out.push('\n');
        }
    }
}

fn text(cell: &Cell) -> String {
    if cell.verdict == Verdict::Holds {
        return ".".to_owned();
    }
    let fault = match cell.fault {
        Some(super::Fault::Wrong) | None => error(cell.error),
        Some(super::Fault::NotFinite) => "not finite".to_owned(),
        Some(fault) => format!("{} {}", fault.name(), error(cell.error)),
    };
    let mark = cell.explanation.as_deref().map_or("?".to_owned(), letter);
    if cell.verdict == Verdict::Fails { format!("**{fault}** {mark}") } else { format!("{fault} {mark}") }
}

/// The letter of an explanation, in the order of the list.
fn letter(name: &str) -> String {
    let index = EXPLANATIONS.iter().position(|e| e.name == name).unwrap_or(EXPLANATIONS.len());
    let one = |i: usize| char::from(b'a' + (i % 26) as u8);
    if index < 26 { one(index).to_string() } else { format!("{}{}", one(index / 26 - 1), one(index)) }
}

fn explanations(out: &mut String, stability: &Stability) {
    out.push_str("\n## Explanations\n\nEach is for named methods and cases, up to a limit; beyond it a cell counts as unexplained.\n\n| | name | cells | largest | limit | reason |\n|---|---|--:|--:|--:|---|\n");
    for explanation in EXPLANATIONS {
        let cells: Vec<&Cell> =
            stability.cells.iter().filter(|c| c.explanation.as_deref() == Some(explanation.name)).collect();
        if cells.is_empty() {
            continue;
        }
        let largest = cells.iter().map(|c| c.error).fold(0.0, f64::max);
        let _ = writeln!(
            out,
            "| {} | {} | {} | {} | {} | {} |",
            letter(explanation.name),
            explanation.name,
            cells.len(),
            error(largest),
            number(explanation.limit),
            explanation.reason
        );
    }
}

fn formulas(out: &mut String, stability: &Stability) {
    out.push_str(
        "\n## Ways to write and to store a function\n\nKnown pitfalls of layered models and of their tables: for each what ships, and what was rejected, with the error.\n\n\
         | pitfall | formulation | ships | error of | error | verdict | |\n|---|---|---|---|--:|---|---|\n",
    );
    for formula in &stability.formulas {
        let verdict = if formula.holds() { "holds" } else { "fails" };
        let _ = writeln!(
            out,
            "| {} | {} | {} | {} | {} | {verdict} | {} |",
            formula.row,
            formula.formulation,
            if formula.ships { "yes" } else { "no" },
            formula.measure,
            formula.error.map_or("not finite".to_owned(), error),
            if formula.holds() { "" } else { &formula.reason }
        );
    }
    out.push_str("\nPitfalls that are cases of the heat maps:\n\n");
    for (row, cases) in PITFALLS.iter().filter(|(_, cases)| !cases.is_empty()) {
        let _ = writeln!(out, "- {row}: {}", cases.join(", "));
    }
}

fn cases(out: &mut String, stability: &Stability) {
    out.push_str("\n## Cases\n\nAlbedos are compared with the truth: `layered-mc` is 16384 paths, and a model is not charged for four standard errors of them.\n\n| case | what it is | truth |\n|---|---|---|\n");
    for case in &stability.cases {
        let _ = writeln!(out, "| {} | {} | {} |", case.id, case.title, case.truth);
    }
}
