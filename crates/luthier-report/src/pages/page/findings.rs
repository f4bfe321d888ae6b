//! Findings that a reader should know before trusting the rest.

use crate::judge::report::Report;
use crate::text::format::escape;

pub(super) fn write(out: &mut String, report: &Report) {
    let says = match report.findings.len() {
        0 => "none".to_owned(),
        count => format!("{count}, to be read before trusting the figures"),
    };
    super::fold(out, "findings", "Findings", &says);
    list(out, report);
    super::end_fold(out);
}

fn list(out: &mut String, report: &Report) {
    if report.findings.is_empty() {
        out.push_str(
            "<p>There are none: every value is finite, the layer records are those of the material files, and no table has a \
             larger error than the bake stated.</p>\n",
        );
        return;
    }
    out.push_str("<ul class=\"findings\">");
    for finding in &report.findings {
        out.push_str("<li>");
        out.push_str(&escape(finding));
        out.push_str("</li>");
    }
    out.push_str("</ul>\n");
}
