//! Curves on a page of their own.

use super::frame::{Frame, Margin};
use super::scale::Scale;

/// Curves over one quantity, as an SVG file that stands alone.
///
/// ```
/// use luthier_report::{Curve, Plot, PlotAxis, PlotColor};
///
/// let curve = Curve { name: "u^2".to_owned(), color: PlotColor::Red, points: vec![[0.0, 0.0], [0.5, 0.25], [1.0, 1.0]] };
/// let [x, y] = ["u", "square"].map(|label| PlotAxis::new(label, [0.0, 1.0], 0.5));
/// let svg = Plot { title: "a square".to_owned(), x, y, curves: vec![curve] }.to_svg();
/// assert!(svg.starts_with("<svg xmlns=") && svg.contains(">u^2<"));
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Plot {
    /// Description of the picture, for screen readers.
    pub title: String,
    /// The quantity.
    pub x: PlotAxis,
    /// The quantity of the curves.
    pub y: PlotAxis,
    /// The curves.
    pub curves: Vec<Curve>,
}

/// An axis of a plot.
#[derive(Debug, Clone, PartialEq)]
pub struct PlotAxis {
    /// Quantity and unit.
    pub label: String,
    /// Ends. A logarithmic axis ignores them and takes the decades of the values.
    pub range: [f64; 2],
    /// Step from one labelled tick to the next; 0 makes the axis logarithmic.
    pub step: f64,
}

impl PlotAxis {
    /// An axis from its parts.
    pub fn new(label: &str, range: [f64; 2], step: f64) -> Self {
        Self { label: label.to_owned(), range, step }
    }
}

/// A named line.
#[derive(Debug, Clone, PartialEq)]
pub struct Curve {
    /// Name, for the legend.
    pub name: String,
    /// Colour of the curve.
    pub color: PlotColor,
    /// Points (x, y), in the order of the line.
    pub points: Vec<[f64; 2]>,
}

/// Colours of curves; each has its own dashes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PlotColor {
    /// Black.
    Ink,
    /// Red.
    Red,
    /// Green.
    Green,
    /// Blue.
    Blue,
}

impl PlotColor {
    pub(super) fn class(self) -> &'static str {
        match self {
            Self::Ink => "p-ink",
            Self::Red => "p-red",
            Self::Green => "p-green",
            Self::Blue => "p-blue",
        }
    }
}

/// Values below this share the end of a logarithmic axis.
const SMALLEST: f64 = 1e-9;

/// Width and height.
const SIZE: [f64; 2] = [640.0, 340.0];

/// Height of a line of the legend.
const LEGEND: f64 = 17.0;

impl Plot {
    /// The file.
    pub fn to_svg(&self) -> String {
        let [x, y] = [(&self.x, 0), (&self.y, 1)].map(|(axis, i): (_, usize)| {
            let [min, max] = axis.range;
            let values = self.curves.iter().flat_map(|curve| curve.points.iter().map(move |p| p[i]));
            // `Scale` counts its ticks from the lower end.
            if axis.step > 0.0 { Scale::linear(min, max, axis.step) } else { Scale::decades(values, SMALLEST) }
        });
        let legend = LEGEND * self.curves.len() as f64;
        let margin = Margin { left: 50.0, right: 16.0, top: 26.0 + legend, bottom: 40.0 };
        let [width, height] = [SIZE[0], SIZE[1] + legend];
        let mut frame = Frame::new([width, height], margin, x, y);
        frame.x_axis(&self.x.label);
        frame.y_axis(&self.y.label);
        for (i, curve) in self.curves.iter().enumerate() {
            let class = curve.color.class();
            let y = 26.0 + LEGEND * i as f64;
            frame.key(class, [margin.left, margin.left + 30.0], y);
            frame.text(margin.left + 38.0, y + 4.0, "start", "name", &curve.name);
            frame.line(class, "", curve.points.iter().map(|&[x, y]| Some((x, y))));
        }
        let chart = frame.finish_still(&self.title);
        let head = format!("<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width:.0}\" height=\"{height:.0}\"");
        let style = format!("<style>{}</style>", include_str!("plot.css"));
        let chart = chart.replacen("<svg", &head, 1);
        // Titles and ticks touch the edges of the frame.
        let (inner, outer) =
            (format!("\"0 0 {width:.0} {height:.0}\""), format!("\"-10 -6 {:.0} {:.0}\"", width + 20.0, height + 12.0));
        let chart = chart.replacen(&inner, &outer, 1);
        chart.replacen('>', &format!(">{style}"), 1) + "\n"
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_plot_is_a_file_with_all_its_curves() {
        let curve = |name: &str, color| Curve { name: name.to_owned(), color, points: vec![[0.0, 1e-3], [2.0, 1.0]] };
        let plot = Plot {
            title: "t".to_owned(),
            x: PlotAxis::new("a < b", [0.0, 2.0], 1.0),
            y: PlotAxis::new("a < b", [0.0, 2.0], 0.0),
            curves: vec![curve("one", PlotColor::Ink), curve("two", PlotColor::Red)],
        };
        let text = plot.to_svg();
        let document = roxmltree::Document::parse(&text).unwrap();
        let paths: Vec<_> = document.descendants().filter_map(|n| n.attribute("class")).collect();
        // A key and a line for each.
        assert_eq!(paths.iter().filter(|class| **class == "line p-red").count(), 2);
        let texts: Vec<_> = document.descendants().filter_map(|n| n.text()).collect();
        assert!(texts.contains(&"two") && texts.contains(&"10⁻³") && texts.contains(&"a < b"), "{texts:?}");
        // From the lower left to the upper right of the plot.
        assert!(text.contains("M50.0 334.0L624.0 60.0"), "{text}");
    }
}
