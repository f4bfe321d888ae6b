//! The page, in Markdown.

use std::fmt::Write;

use luthier_model::Quantity;

use super::explain::explanations;
use super::{Cell, FAILS, HOLDS, HOLDS_ALBEDO, Level, PITFALLS, Stability, Verdict};
use crate::text::format::{error, number};

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
    reasons(&mut out, stability);
    formulas(&mut out, stability);
    cases(&mut out, stability);
    out
}

fn preamble(stability: &Stability, command: &str) -> String {
    let device = stability.device.as_ref().map_or("no adapter", String::as_str);
    format!(
        "# Where methods fail

luthier runs each method (a reflectance model, or the shader of one) on stacks and directions at which formulas divide by small numbers, overflow \
or stop being true. This command makes the whole page:

    {command}

It ran on {device}, by {}. Methods run at four levels:

- **f64**: all registered models, in double precision. The laws come first. Values must be finite, not negative, and 0 at and below the horizon; \
a model must be reciprocal and conserve energy if `luthier models` says that it does. Then the directional albedo at two angles, at 525 nm, is \
compared with the truth of the case, which the last section names.
- **table**: the arithmetic of the shader in f64, on the texels that a bake writes, filtered with weights of 8 bits.
- **f32**: the shader without tables (the form `full`) on the adapter.
- **device**: the shader with tables (the form `baked`) on the adapter.

Table, f32 and device are compared with the same model in f64, with exact terms in place of tables. Slope parameters are raised to 0.001 there, as \
in all shaders. On a software adapter (llvmpipe) f32 and device compute in IEEE single precision, so that their results are those of a CPU that rounds \
correctly. A GPU fuses and reorders operations and has coarser reciprocals and sines, within the limits of WGSL.

A row that is named by a model alone uses the tables that a bake chooses by default; the distribution D is computed there. Settings and budgets can \
choose other tables: reflectance rows in other texel formats, rows that store the difference from Schlick's form (Schlick rows), a table of D, or no \
phase rows, so that the shader computes the interference. A row that is named by a model and its tables shows one such choice, with tables of fixed \
sizes. Two models that read these tables are run with them. The other models, and albedo and film tables, are run in their default formats only.

A method gets one of three verdicts on a case:

- It **holds** if the error of the albedo is at most {}, or the error of the shader at most {}. The error of a shader is relative to the brightest \
channel of the reference, or to a tenth of a white diffuser where that is larger.
- It **degrades** if the error is larger, but at most {}.
- It **fails** if it breaks a law, or if the error is larger still.

A cell is empty where the method does not apply to the stack.
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
        let [hold, degrade, fail] = [Verdict::Holds, Verdict::Degrades, Verdict::Fails]
            .map(|verdict| cells.iter().filter(|c| c.verdict == verdict).count());
        let not_finite = cells.iter().filter(|c| c.fault == Some(super::Fault::NotFinite)).count();
        let unexplained = cells.iter().filter(|c| !c.is_explained()).count();
        let _ = writeln!(
            out,
            "| {} | {} | {hold} | {degrade} | {fail} | {not_finite} | {unexplained} |",
            level.name(),
            cells.len()
        );
    }
}

fn domains(out: &mut String, stability: &Stability) {
    out.push_str(
        "\n## Domains\n\nEach cell gives the range of a quantity, around its ordinary value, in which a model fails at no level. The range in brackets is the one in which \
         it holds at all levels. `luthier bake` and `luthier check` warn about a material outside the first range.\n\n| model |",
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
        "\n## {}\n\nA dot means that the method holds. A number is the error of a method that degrades. Bold text means that the method fails. The letters refer to the section Explanations.",
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
    let index = explanations().iter().position(|e| e.name == name).unwrap_or(explanations().len());
    let one = |i: usize| char::from(b'a' + (i % 26) as u8);
    if index < 26 { one(index).to_string() } else { format!("{}{}", one(index / 26 - 1), one(index)) }
}

fn reasons(out: &mut String, stability: &Stability) {
    out.push_str("\n## Explanations\n\nEach explanation covers the errors of certain methods on certain cases, up to a limit. A cell with an error beyond the limit counts as unexplained. The column *largest* has the largest error that an explanation covers.\n\n| | name | cells | largest | limit | reason |\n|---|---|--:|--:|--:|---|\n");
    for explanation in explanations() {
        let cells: Vec<&Cell> =
            stability.cells.iter().filter(|c| c.explanation.as_deref() == Some(&explanation.name)).collect();
        if cells.is_empty() {
            continue;
        }
        let largest = cells.iter().map(|c| c.error).fold(0.0, f64::max);
        let _ = writeln!(
            out,
            "| {} | {} | {} | {} | {} | {} |",
            letter(&explanation.name),
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
        "\n## Ways to write and to store a function\n\nThe table lists known pitfalls of layered models and of their tables. For each pitfall it has the formulation that luthier uses (*ships*) and those that were rejected, with their errors. The last column says why a formulation was rejected.\n\n\
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
    out.push_str("\nSome pitfalls are also cases of the tables of levels above:\n\n");
    for (row, cases) in PITFALLS.iter().filter(|(_, cases)| !cases.is_empty()) {
        let _ = writeln!(out, "- {row}: {}", cases.join(", "));
    }
}

fn cases(out: &mut String, stability: &Stability) {
    out.push_str("\n## Cases\n\nAlbedos are compared with the truth in the last column. `layered-mc` is the simulation with 16384 paths; four of its standard errors are taken off the error of a model. `laws only` means that no albedo is compared.\n\n| case | what it is | truth |\n|---|---|---|\n");
    for case in &stability.cases {
        let _ = writeln!(out, "| {} | {} | {} |", case.id, case.title, case.truth);
    }
}
