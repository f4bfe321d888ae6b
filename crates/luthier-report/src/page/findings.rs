//! Findings that a reader should know before trusting the rest.

use crate::Report;
use crate::format::escape;

pub(super) fn write(out: &mut String, report: &Report) {
    let says = match report.findings.len() {
        0 => "none".to_owned(),
        count => format!("{count} that a reader should know before trusting the rest"),
    };
    super::fold(out, "findings", "Findings", &says);
    list(out, report);
    super::end_fold(out);
}

fn list(out: &mut String, report: &Report) {
    if report.findings.is_empty() {
        out.push_str(
            "<p>None: every value is finite, the layer records are those of the material files, and no table is \
             worse than its baker states.</p>\n",
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
