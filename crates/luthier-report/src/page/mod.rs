//! The report as a page.

mod exceptions;
mod findings;
mod levels;
mod materials;
mod method;
mod pictures;
mod provenance;
mod stability;
mod summary;
mod tables;
mod trade;

pub(crate) use exceptions::cause;
pub(crate) use materials::angles;

use crate::format::escape;
use crate::{Exhibits, Report};

/// The whole document.
pub(crate) fn html(report: &Report, exhibits: &Exhibits) -> String {
    let mut out = String::with_capacity(256 << 10);
    out.push_str("<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"/>");
    out.push_str("<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\"/>");
    out.push_str("<title>luthier: error report</title><style>\n");
    out.push_str(include_str!("style.css"));
    out.push_str("</style></head>\n<body><main>\n");
    summary::head(&mut out, report);
    levels::write(&mut out, report);
    summary::overview(&mut out, report);
    trade::write(&mut out, report);
    exceptions::write(&mut out, report);
    findings::write(&mut out, report);
    materials::write(&mut out, report, exhibits);
    tables::write(&mut out, report);
    stability::write(&mut out, report, exhibits);
    method::write(&mut out, report);
    provenance::write(&mut out, report);
    // Marked so that HTML takes it for a script and XML for text.
    out.push_str("</main><script>//<![CDATA[\n");
    out.push_str(include_str!("page.js"));
    out.push_str("//]]></script></body></html>\n");
    out
}

/// A table cell with a number.
fn cell(text: &str) -> String {
    format!("<td class=\"n\">{}</td>", escape(text))
}

/// Which material the page's filter takes an element for.
fn of_material(name: &str) -> String {
    format!(" data-material=\"{}\"", escape(name))
}

/// The id of a material's section.
fn anchor(index: usize) -> String {
    format!("material-{index}")
}
