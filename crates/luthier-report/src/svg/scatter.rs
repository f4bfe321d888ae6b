//! Points of error over cost, in panels side by side, on a page of their own.

use super::frame::{Frame, Margin, Mark, Series};
use super::plot::PlotColor;
use super::scale::Scale;
use crate::text::format::escape;

/// Panels of points over the same logarithmic axes, as an SVG file that stands alone.
///
/// ```
/// use luthier_report::{Scatter, ScatterPanel, ScatterPoint, PlotColor};
///
/// let point = |name: &str, x| ScatterPoint { name: name.to_owned(), x, y: 0.1, reach: 0.2, color: PlotColor::Red };
/// let panel = ScatterPanel { title: "coats".to_owned(), points: vec![point("a", Some(2.0)), point("b", None)] };
/// let svg = Scatter {
///     title: "error over time".to_owned(),
///     axes: ["ps".to_owned(), "error".to_owned()],
///     untimed: "no shader".to_owned(),
///     kinds: vec![(PlotColor::Red, "engines".to_owned())],
///     line: PlotColor::Blue,
///     rules: vec![(0.5, "black".to_owned())],
///     panels: vec![panel],
/// }
/// .to_svg();
/// assert!(svg.starts_with("<svg xmlns=") && svg.contains(">coats<") && svg.contains(">no shader<"));
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Scatter {
    /// Description of the picture, for screen readers.
    pub title: String,
    /// Quantities across and up.
    pub axes: [String; 2],
    /// Heading of the column of points without a place across.
    pub untimed: String,
    /// Kinds of points by their colour, for the legend.
    pub kinds: Vec<(PlotColor, String)>,
    /// The kind whose points a line connects, in their order.
    pub line: PlotColor,
    /// Values up with a line across, and its words.
    pub rules: Vec<(f64, String)>,
    /// The panels, from left to right.
    pub panels: Vec<ScatterPanel>,
}

/// A panel.
#[derive(Debug, Clone, PartialEq)]
pub struct ScatterPanel {
    /// Heading.
    pub title: String,
    /// Its points.
    pub points: Vec<ScatterPoint>,
}

/// A named point.
#[derive(Debug, Clone, PartialEq)]
pub struct ScatterPoint {
    /// Name beside its mark; empty for none.
    pub name: String,
    /// Place across; `None` puts it into a column of its own at the right.
    pub x: Option<f64>,
    /// Place up.
    pub y: f64,
    /// Upper end of a thin line from the mark.
    pub reach: f64,
    /// Colour, which has its own mark.
    pub color: PlotColor,
}

/// Width and height of a panel.
const PANEL: [f64; 2] = [560.0, 470.0];

const MARGIN: Margin = Margin { left: 46.0, right: 16.0, top: 52.0, bottom: 44.0 };

/// Width of the column of points without a place across.
const COLUMN: f64 = 226.0;

/// Height of the legend above the panels.
const LEGEND: f64 = 30.0;

/// Half the side of the square that a mark takes, and the distance of a name from its mark.
const MARK: f64 = 6.0;

/// Height of a name, and width of a letter.
const LETTER: [f64; 2] = [14.0, 7.4];

/// Distance of two marks in the column of points without a place across.
const APART: f64 = 9.0;

/// A rectangle: left, top, right, bottom.
type Area = [f64; 4];

fn meet(a: &Area, b: &Area) -> bool {
    a[0] < b[2] && b[0] < a[2] && a[1] < b[3] && b[1] < a[3]
}

fn series(color: PlotColor) -> Series {
    let mark = match color {
        PlotColor::Blue => Mark::Circle,
        PlotColor::Ink => Mark::Diamond,
        PlotColor::Red | PlotColor::Green => Mark::Square,
    };
    Series { class: color.class(), name: "", mark }
}

impl Scatter {
    /// The file.
    pub fn to_svg(&self) -> String {
        let points = || self.panels.iter().flat_map(|panel| &panel.points);
        let x = Scale::fine(points().filter_map(|point| point.x));
        let y = Scale::fine(points().flat_map(|point| [point.y, point.reach]));
        let mut body = self.legend();
        let [mut width, height] = [0.0, PANEL[1] + LEGEND];
        for panel in &self.panels {
            let column = if panel.points.iter().any(|point| point.x.is_none()) { COLUMN } else { 0.0 };
            let size = [PANEL[0] + column, PANEL[1]];
            let inner = self.panel(panel, (size, column), (x, y));
            let place =
                format!("<svg x=\"{width:.0}\" y=\"{LEGEND:.0}\" width=\"{:.0}\" height=\"{:.0}\"", size[0], size[1]);
            body += &inner.replacen("<svg", &place, 1);
            width += size[0];
        }
        format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width:.0}\" height=\"{height:.0}\" viewBox=\"-10 -6 {:.0} {:.0}\" \
             role=\"img\" aria-label=\"{}\"><style>{}</style>{body}</svg>\n",
            width + 20.0,
            height + 12.0,
            escape(&self.title),
            include_str!("scatter.css"),
        )
    }

    fn legend(&self) -> String {
        let whole = Scale::linear(0.0, 1.0, 1.0);
        let margin = Margin { left: 0.0, right: 0.0, top: 0.0, bottom: 0.0 };
        let mut frame = Frame::new([PANEL[0] * 2.0, LEGEND], margin, whole, whole);
        let mut left = 8.0;
        for (color, words) in &self.kinds {
            frame.mark(series(*color), left, 10.0, words);
            frame.text(left + 12.0, 14.5, "start", "name", words);
            left += 36.0 + LETTER[1] * words.chars().count() as f64;
        }
        frame.into_body()
    }

    fn panel(&self, panel: &ScatterPanel, (size, column): ([f64; 2], f64), (x, y): (Scale, Scale)) -> String {
        let margin = Margin { right: MARGIN.right + column, ..MARGIN };
        let mut frame = Frame::new(size, margin, x, y);
        frame.x_axis(&self.axes[0]);
        frame.y_axis("");
        frame.text(margin.left, 18.0, "start", "head", &panel.title);
        frame.text(0.0, 40.0, "start", "title", &self.axes[1]);
        let edge = size[0] - margin.right;
        if panel.points.iter().any(|point| point.x.is_none()) {
            frame.text(edge + 20.0, 40.0, "start", "title", &self.untimed);
        }
        for (value, words) in &self.rules {
            frame.rule_y(*value, words);
        }
        let joined = panel.points.iter().filter(|point| point.color == self.line);
        let joined: Vec<(f64, f64)> = joined.filter_map(|point| Some((point.x?, point.y))).collect();
        frame.line(self.line.class(), "", joined.iter().copied().map(Some));
        // Points without a place across stand side by side, the lowest error first.
        let mut column: Vec<f64> = panel.points.iter().filter(|point| point.x.is_none()).map(|point| point.y).collect();
        column.sort_by(f64::total_cmp);
        let beside = |y: f64| edge + 26.0 + APART * column.iter().take_while(|other| **other < y).count() as f64;
        let places: Vec<[f64; 2]> = panel
            .points
            .iter()
            .map(|point| [point.x.map_or_else(|| beside(point.y), |x| frame.px(x)), frame.py(point.y)])
            .collect();
        let bottom = size[1] - margin.bottom;
        let mut taken: Vec<Area> = places.iter().map(|[at, up]| [at - MARK, up - MARK, at + MARK, up + MARK]).collect();
        for (point, &[at, up]) in panel.points.iter().zip(&places) {
            let class = format!("line reach {}", point.color.class());
            let reach = frame.py(point.reach);
            frame.upright(&class, at, [up, reach]);
            frame.mark(series(point.color), at, up, &point.name);
            taken.push([at - 1.0, reach, at + 1.0, up]);
        }
        for (value, words) in &self.rules {
            let up = frame.py(*value);
            taken.push([edge - LETTER[1] * words.chars().count() as f64, up - LETTER[0] - 4.0, edge, up]);
        }
        let along = joined.windows(2).flat_map(|ends| {
            let [from, to] = [ends[0], ends[1]].map(|(x, y)| [frame.px(x), frame.py(y)]);
            [0.1, 0.3, 0.5, 0.7, 0.9].map(|t: f64| [0, 1].map(|axis: usize| from[axis] + t * (to[axis] - from[axis])))
        });
        taken.extend(along.map(|[x, y]| [x - 1.0, y - 1.0, x + 1.0, y + 1.0]));
        // Names keep off marks, lines and each other, as far as there is room.
        let named = panel.points.iter().zip(&places).filter(|(point, _)| !point.name.is_empty());
        let (inside, outside): (Vec<_>, Vec<_>) = named.partition(|(point, _)| point.x.is_some());
        for (point, &[at, up]) in inside {
            let (area, anchor, place) = free(&point.name, [at, up], [margin.left, edge, bottom], &taken);
            frame.text(place[0], place[1], anchor, "name", &point.name);
            taken.push(area);
        }
        // Those of the column stand below each other at its right, each with a line to its mark.
        let right = edge + 26.0 + APART * column.len() as f64;
        let mut outside: Vec<_> = outside.into_iter().map(|(point, &place)| (point, place)).collect();
        outside.sort_by(|(_, a), (_, b)| a[1].total_cmp(&b[1]));
        let mut last = f64::NEG_INFINITY;
        for (point, [at, up]) in outside {
            last = up.max(last + LETTER[0] + 1.0);
            frame.leader([at + MARK, up], [right - 3.0, last]);
            frame.text(right, last + 4.5, "start", "name", &point.name);
        }
        frame.finish_still(&panel.title)
    }
}

/// The area of a name beside a mark, the anchor of its text and the place of that: the first of some that meets nothing and is within the panel, or else the first.
fn free(
    name: &str,
    [at, up]: [f64; 2],
    [left, right, bottom]: [f64; 3],
    taken: &[Area],
) -> (Area, &'static str, [f64; 2]) {
    let width = LETTER[1] * name.chars().count() as f64;
    let [height, apart] = [LETTER[0], MARK + 3.0];
    let shifts = [0.0, -1.0, 1.0, -2.0, 2.0, -3.0, 3.0].map(|shift| shift * height);
    let beside = shifts.into_iter().flat_map(|shift| {
        let reach = if shift.abs() > height { 0.5 } else { 1.0 };
        [("start", apart * reach), ("end", -apart * reach)].map(|(anchor, x)| (anchor, [at + x, up + shift]))
    });
    let mut places = beside.map(|(anchor, [x, y])| {
        let from = if anchor == "start" { x } else { x - width };
        ([from, y - 0.5 * height, from + width, y + 0.5 * height], anchor, [x, y + 4.5])
    });
    let first = places.clone().next();
    let found = places.find(|(area, ..)| {
        area[0] >= left && area[2] <= right && area[3] <= bottom && !taken.iter().any(|t| meet(t, area))
    });
    found.or(first).unwrap_or_else(|| unreachable!("there are places"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_keep_off_each_other() {
        let point =
            |name: &str, x: Option<f64>, color| ScatterPoint { name: name.to_owned(), x, y: 0.1, reach: 0.3, color };
        let scatter = Scatter {
            title: "t".to_owned(),
            axes: ["time".to_owned(), "error".to_owned()],
            untimed: "no time".to_owned(),
            kinds: vec![(PlotColor::Blue, "ours".to_owned())],
            line: PlotColor::Blue,
            rules: vec![(0.2, "a fifth".to_owned())],
            panels: vec![ScatterPanel {
                title: "p".to_owned(),
                points: vec![
                    point("one", Some(2.0), PlotColor::Blue),
                    point("two", Some(2.02), PlotColor::Blue),
                    point("three", None, PlotColor::Red),
                    ScatterPoint { y: 0.101, ..point("four", None, PlotColor::Red) },
                ],
            }],
        };
        let text = scatter.to_svg();
        let document = roxmltree::Document::parse(&text).unwrap();
        let place = |name: &str| {
            let node =
                document.descendants().find(|n| n.tag_name().name() == "text" && n.text() == Some(name)).unwrap();
            ["x", "y"].map(|axis| node.attribute(axis).unwrap().parse::<f64>().unwrap())
        };
        let [one, two, three, four] = ["one", "two", "three", "four"].map(place);
        assert!(one != two, "{one:?} {two:?}");
        // Marks that nearly lie on each other have names below each other, and lines to these.
        assert!((three[1] - four[1]).abs() >= LETTER[0], "{three:?} {four:?}");
        assert_eq!(text.matches("class=\"leader\"").count(), 2);
        assert!(place("a fifth")[1] < three[1]);
        assert!(three[0] > PANEL[0] - MARGIN.right && place("no time")[0] > PANEL[0] - MARGIN.right, "{three:?}");
        // Two joined points, and no other line across.
        assert_eq!(text.matches("class=\"line p-blue\"").count(), 1);
        assert_eq!(text.matches("class=\"mark p-blue\"").count(), 3, "two points and the legend");
    }
}
