//! A plot area with axes, and marks on it.

use std::fmt::Write;

use super::scale::Scale;
use crate::text::format::escape;

/// A series: its class in the style sheet, its mark and its name in legends.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Series {
    /// Class name, `s-...`: colour and dashes.
    pub(crate) class: &'static str,
    /// Name for readers.
    pub(crate) name: &'static str,
    /// Shape of the mark, so that colour is never the only difference.
    pub(crate) mark: Mark,
}

/// Shapes of marks.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Mark {
    Circle,
    Diamond,
    Square,
}

/// A key to series, as HTML to stand above a chart.
pub(crate) fn legend(series: &[Series]) -> String {
    let mut out = String::from("<p class=\"legend\">");
    for s in series {
        let mut key = String::new();
        mark(&mut key, *s, 13.0, 6.0);
        let _ = write!(
            out,
            "<span><svg class=\"key\" viewBox=\"0 0 26 12\" aria-hidden=\"true\"><path class=\"line {}\" d=\"M0 \
             6H26\"/>{key}</svg>{}</span>",
            s.class,
            escape(s.name)
        );
    }
    out.push_str("</p>");
    out
}

/// A chart under construction. Sizes are in SVG user units, one CSS pixel at full width.
pub(crate) struct Frame {
    width: f64,
    height: f64,
    margin: Margin,
    x: Scale,
    y: Scale,
    body: String,
}

/// Space around the plot area.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Margin {
    pub(crate) left: f64,
    pub(crate) right: f64,
    pub(crate) top: f64,
    pub(crate) bottom: f64,
}

impl Frame {
    /// An empty plot area.
    pub(crate) fn new([width, height]: [f64; 2], margin: Margin, x: Scale, y: Scale) -> Self {
        Self { width, height, margin, x, y, body: String::new() }
    }

    /// Pixel of a value on x.
    pub(crate) fn px(&self, value: f64) -> f64 {
        self.px_fraction(self.x.fraction(value))
    }

    fn px_fraction(&self, fraction: f64) -> f64 {
        self.margin.left + fraction * (self.width - self.margin.left - self.margin.right)
    }

    /// Pixel of a value on y.
    pub(crate) fn py(&self, value: f64) -> f64 {
        self.py_fraction(self.y.fraction(value))
    }

    fn py_fraction(&self, fraction: f64) -> f64 {
        let bottom = self.height - self.margin.bottom;
        bottom - fraction * (bottom - self.margin.top)
    }

    /// Grid, tick labels and title of the x axis.
    pub(crate) fn x_axis(&mut self, title: &str) {
        let (top, bottom) = (self.margin.top, self.height - self.margin.bottom);
        for (fraction, label) in self.x.ticks() {
            let x = self.px_fraction(fraction);
            let _ = write!(self.body, "<path class=\"grid\" d=\"M{x:.1} {top:.1}V{bottom:.1}\"/>");
            self.text(x, bottom + 15.0, "middle", "tick", &label);
        }
        let middle = self.px_fraction(0.5);
        self.text(middle, self.height - 4.0, "middle", "title", title);
    }

    /// Grid, tick labels and title of the y axis; the title stands above it.
    pub(crate) fn y_axis(&mut self, title: &str) {
        let (left, right) = (self.margin.left, self.width - self.margin.right);
        for (fraction, label) in self.y.ticks() {
            let y = self.py_fraction(fraction);
            let _ = write!(self.body, "<path class=\"grid\" d=\"M{left:.1} {y:.1}H{right:.1}\"/>");
            self.text(left - 6.0, y + 3.5, "end", "tick", &label);
        }
        self.text(0.0, 11.0, "start", "title", title);
    }

    /// A line at a value of x, from top to bottom, with a label at its head.
    pub(crate) fn rule_x(&mut self, value: f64, label: &str) {
        let (x, top, bottom) = (self.px(value), self.margin.top, self.height - self.margin.bottom);
        let _ = write!(self.body, "<path class=\"rule\" d=\"M{x:.1} {top:.1}V{bottom:.1}\"/>");
        self.text(x, top - 4.0, "middle", "ruled", label);
    }

    /// A line at a value of y, from left to right, with a label at its end.
    pub(crate) fn rule_y(&mut self, value: f64, label: &str) {
        let (y, left, right) = (self.py(value), self.margin.left, self.width - self.margin.right);
        let _ = write!(self.body, "<path class=\"rule\" d=\"M{left:.1} {y:.1}H{right:.1}\"/>");
        self.text(right, y - 4.0, "end", "ruled", label);
    }

    /// A line through points of values, with a gap at each `None`. The page's script reads `name` out, unless it is empty.
    pub(crate) fn line(&mut self, class: &str, name: &str, points: impl Iterator<Item = Option<(f64, f64)>>) {
        let mut path = String::new();
        let mut pen_down = false;
        for point in points {
            if let Some((x, y)) = point {
                let command = if pen_down { 'L' } else { 'M' };
                let _ = write!(path, "{command}{:.1} {:.1}", self.px(x), self.py(y));
            }
            pen_down = point.is_some();
        }
        if !path.is_empty() {
            let name = if name.is_empty() { String::new() } else { format!(" data-name=\"{}\"", escape(name)) };
            let _ = write!(self.body, "<path class=\"line {class}\"{name} d=\"{path}\"/>");
        }
    }

    /// A piece of a line between two pixels of a row, for a legend.
    pub(crate) fn key(&mut self, class: &str, [x0, x1]: [f64; 2], y: f64) {
        let _ = write!(self.body, "<path class=\"line {class}\" d=\"M{x0:.1} {y:.1}H{x1:.1}\"/>");
    }

    /// A bar from the left edge of the plot to a value of x, `height` pixels about pixel `y`.
    pub(crate) fn bar(&mut self, class: &str, value: f64, y: f64, height: f64) {
        let (left, right) = (self.margin.left, self.px(value));
        let _ = write!(
            self.body,
            "<rect class=\"bar {class}\" x=\"{left:.1}\" y=\"{:.1}\" width=\"{:.1}\" height=\"{height:.1}\" rx=\"2\"/>",
            y - 0.5 * height,
            right - left
        );
    }

    /// A mark at pixel coordinates, with a tooltip.
    pub(crate) fn mark(&mut self, series: Series, x: f64, y: f64, tip: &str) {
        let _ = write!(self.body, "<g><title>{}</title>", escape(tip));
        mark(&mut self.body, series, x, y);
        self.body.push_str("</g>");
    }

    /// A thin line between two pixels of a row.
    pub(crate) fn span(&mut self, x0: f64, x1: f64, y: f64) {
        let _ = write!(self.body, "<path class=\"span\" d=\"M{x0:.1} {y:.1}H{x1:.1}\"/>");
    }

    /// A thin line from a mark to its name, between two places in pixels.
    pub(crate) fn leader(&mut self, [x0, y0]: [f64; 2], [x1, y1]: [f64; 2]) {
        let _ = write!(self.body, "<path class=\"leader\" d=\"M{x0:.1} {y0:.1}L{x1:.1} {y1:.1}\"/>");
    }

    /// A line between two pixels of a column.
    pub(crate) fn upright(&mut self, class: &str, x: f64, [y0, y1]: [f64; 2]) {
        let _ = write!(self.body, "<path class=\"{class}\" d=\"M{x:.1} {y0:.1}V{y1:.1}\"/>");
    }

    /// Text at pixel coordinates.
    pub(crate) fn text(&mut self, x: f64, y: f64, anchor: &str, class: &str, text: &str) {
        let text = escape(text);
        let _ = write!(
            self.body,
            "<text class=\"{class}\" x=\"{x:.1}\" y=\"{y:.1}\" text-anchor=\"{anchor}\">{text}</text>"
        );
    }

    /// Opens a group of the elements of a material, for the page's filter. [`Frame::end`] closes it.
    pub(crate) fn begin(&mut self, material: &str) {
        let _ = write!(self.body, "<g data-material=\"{}\">", escape(material));
    }

    /// Closes a group.
    pub(crate) fn end(&mut self) {
        self.body.push_str("</g>");
    }

    /// Opens a link to the section of a material. [`Frame::end_link`] closes it.
    pub(crate) fn begin_link(&mut self, anchor: &str, material: &str) {
        let _ = write!(self.body, "<a href=\"#{}\" data-material=\"{}\">", escape(anchor), escape(material));
    }

    /// Closes a link.
    pub(crate) fn end_link(&mut self) {
        self.body.push_str("</a>");
    }

    /// A ring about pixel coordinates.
    pub(crate) fn ring(&mut self, x: f64, y: f64) {
        let _ = write!(self.body, "<circle class=\"chosen\" cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"9\"/>");
    }

    /// The SVG element, with `label` for screen readers and the scales for the page's script.
    pub(crate) fn finish(self, label: &str) -> String {
        let (x, y) = (self.x.describe(), self.y.describe());
        let ends = [self.px_fraction(0.0), self.px_fraction(1.0), self.py_fraction(0.0), self.py_fraction(1.0)];
        let [left, right, bottom, top] = ends;
        let scales = format!(" data-x=\"{x} {left:.1} {right:.1}\" data-y=\"{y} {bottom:.1} {top:.1}\"");
        self.element(label, &scales)
    }

    /// The elements so far, for another SVG element.
    pub(crate) fn into_body(self) -> String {
        self.body
    }

    /// The SVG element for a file of its own, which has no script.
    pub(crate) fn finish_still(self, label: &str) -> String {
        self.element(label, "")
    }

    fn element(self, label: &str, scales: &str) -> String {
        format!(
            "<svg class=\"chart\" role=\"img\" aria-label=\"{}\"{scales} viewBox=\"0 0 {:.0} {:.0}\">{}</svg>",
            escape(label),
            self.width,
            self.height,
            self.body
        )
    }
}

fn mark(out: &mut String, series: Series, x: f64, y: f64) {
    let class = series.class;
    let _ = match series.mark {
        Mark::Circle => write!(out, "<circle class=\"mark {class}\" cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"5.4\"/>"),
        Mark::Diamond => {
            write!(out, "<path class=\"mark {class}\" d=\"M{x:.1} {:.1}l4.8 4.8l-4.8 4.8l-4.8 -4.8z\"/>", y - 4.8)
        }
        Mark::Square => write!(
            out,
            "<rect class=\"mark {class}\" x=\"{:.1}\" y=\"{:.1}\" width=\"7.2\" height=\"7.2\"/>",
            x - 3.6,
            y - 3.6
        ),
    };
}
