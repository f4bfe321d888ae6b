//! The report as a page.

mod exceptions;
mod findings;
mod glance;
mod levels;
mod materials;
mod method;
mod pictures;
mod provenance;
mod stability;
mod summary;
mod tables;
mod trade;

use std::fmt::Write;

use crate::judge::evidence::Exhibits;
use crate::judge::report::Report;
use crate::text::format::escape;

/// The whole document.
pub(crate) fn html(report: &Report, exhibits: &Exhibits) -> String {
    let mut out = String::with_capacity(256 << 10);
    out.push_str("<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"/>");
    out.push_str("<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\"/>");
    out.push_str("<title>luthier: error report</title><style>\n");
    out.push_str(include_str!("style.css"));
    out.push_str("</style></head>\n<body><main>\n");
    summary::head(&mut out, report);
    glance::write(&mut out, report, exhibits);
    levels::write(&mut out, report);
    findings::write(&mut out, report);
    materials::write(&mut out, report, exhibits);
    summary::overview(&mut out, report);
    trade::write(&mut out, report);
    exceptions::write(&mut out, report);
    tables::write(&mut out, report);
    stability::write(&mut out, report, exhibits);
    method::write(&mut out, report);
    provenance::write(&mut out, report);
    // The marks make HTML read a script, and XML plain text.
    out.push_str("</main><script>//<![CDATA[\n");
    out.push_str(include_str!("page.js"));
    out.push_str("//]]></script></body></html>\n");
    out
}

/// Opens a section that folds, with its title and a line that sums it up. [`end_fold`] closes it.
fn fold(out: &mut String, id: &str, title: &str, says: &str) {
    let _ = write!(
        out,
        "<details class=\"fold\" id=\"{id}\"><summary><h2>{title}</h2><span class=\"sub\">{}</span></summary>",
        escape(says)
    );
}

/// Closes a section that folds.
fn end_fold(out: &mut String) {
    out.push_str("</details>\n");
}

/// A table cell with a number.
fn cell(text: &str) -> String {
    format!("<td class=\"n\">{}</td>", escape(text))
}

/// The attribute by which the page's filter knows the elements of a material.
fn of_material(name: &str) -> String {
    format!(" data-material=\"{}\"", escape(name))
}

/// The id of a material's section.
fn anchor(index: usize) -> String {
    format!("material-{index}")
}
