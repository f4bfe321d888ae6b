//! Pages: a judgement as HTML with its charts, and as a few lines of text.

mod chart;
mod page;
mod summary;

use crate::judge::evidence::Exhibits;
use crate::judge::report::Report;

impl Report {
    /// A self-contained page: charts are inline SVG, pictures are embedded, nothing is loaded. It has styles for light, dark and print. Its script sorts,
    /// filters and reads out values; the page can be read without it. It is also well-formed XML.
    pub fn to_html(&self, exhibits: &Exhibits) -> String {
        page::html(self, exhibits)
    }

    /// A summary in Markdown, short enough for a pull request.
    pub fn to_markdown(&self) -> String {
        summary::markdown(self)
    }
}
