//! The report as a page.

mod exceptions;
mod findings;
mod materials;
mod method;
mod summary;
mod tables;

pub(crate) use exceptions::cause;
pub(crate) use materials::angles;

use crate::Report;
use crate::format::escape;

/// The whole document.
pub(crate) fn html(report: &Report) -> String {
    let mut out = String::with_capacity(256 << 10);
    out.push_str("<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"/>");
    out.push_str("<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\"/>");
    out.push_str("<title>luthier: error report</title><style>\n");
    out.push_str(include_str!("style.css"));
    out.push_str("</style></head>\n<body><main>\n");
    summary::head(&mut out, report);
    exceptions::write(&mut out, report);
    summary::overview(&mut out, report);
    findings::write(&mut out, report);
    tables::write(&mut out, report);
    materials::write(&mut out, report);
    method::write(&mut out, report);
    out.push_str("</main></body></html>\n");
    out
}

/// A table cell with a number.
fn cell(text: &str) -> String {
    format!("<td class=\"n\">{}</td>", escape(text))
}

/// The id of a material's section.
fn anchor(index: usize) -> String {
    format!("material-{index}")
}
