//! Pages: a judgement as HTML with its charts, and as a few lines of text.

mod chart;
mod page;
mod summary;

use crate::judge::evidence::Exhibits;
use crate::judge::report::Report;

impl Report {
    /// A self-contained page: charts are inline SVG, pictures are in it, no external resource; light, dark and print. It can be read
    /// without its script, which sorts, filters and reads out values. It is well-formed XML too.
    pub fn to_html(&self, exhibits: &Exhibits) -> String {
        page::html(self, exhibits)
    }

    /// A summary in Markdown, as for a pull request.
    pub fn to_markdown(&self) -> String {
        summary::markdown(self)
    }
}
