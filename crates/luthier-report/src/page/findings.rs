//! What a reader should know before trusting the rest.

use crate::Report;
use crate::format::escape;

pub(super) fn write(out: &mut String, report: &Report) {
    out.push_str("<h2 id=\"findings\">Findings</h2>");
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
