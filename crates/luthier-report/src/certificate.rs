//! A page that certifies one table: its statement, its error, and maps of the error over two quantities.

use std::fmt::Write;

use crate::text::format::{error, escape, number};

/// Decades of the colour scale, from the first colour to the last.
const DECADES: [i32; 2] = [-6, -1];
/// Colours of the scale, half a decade each: dark where the error is small. They rise evenly in lightness.
const COLORS: [&str; 11] = [
    "#0d1b3e", "#14305f", "#1b4a7d", "#216694", "#2b83a0", "#409fa3", "#69b99b", "#9fce8f", "#d5dd8a", "#f7e08f",
    "#fff3c4",
];
/// Sides of a map's frame, and the room left of it and below.
const FRAME: f64 = 300.0;
const LEFT: f64 = 46.0;
const BELOW: f64 = 40.0;

/// Values that axes name.
const TICKS: [f64; 13] = [0.001, 0.003, 0.01, 0.03, 0.1, 0.3, 1.0, 3.0, 10.0, 30.0, 100.0, 300.0, 1000.0];

/// An error over two quantities, on a grid that is even in the logarithms.
///
/// ```
/// use luthier_report::ErrorMap;
///
/// let worst = (1e-3, [0.01, 1.0]);
/// let map = ErrorMap::sample("mine", ["cos_theta", "alpha"], [[0.01, 1.0]; 2], worst, |[cos, _]| 1e-5 / cos);
/// // The first column of cells begins at the lower end, where the error is largest.
/// assert_eq!(map.errors.len(), ErrorMap::SIDE * ErrorMap::SIDE);
/// assert!(map.errors[0] > map.errors[1] && map.errors[0] < 1e-3);
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct ErrorMap {
    /// Title of the map: the name of the table.
    pub title: String,
    /// Names of the quantities, across and down.
    pub axes: [String; 2],
    /// Both ends of each quantity, above 0.
    pub ranges: [[f64; 2]; 2],
    /// Columns of the grid.
    pub columns: usize,
    /// Errors at the middles of the cells, row by row from the lower end of the second quantity on.
    pub errors: Vec<f64>,
    /// Largest error of the whole table, with its place in both quantities.
    pub worst: (f64, [f64; 2]),
}

impl ErrorMap {
    /// Columns and rows of [`Self::sample`].
    pub const SIDE: usize = 56;

    /// The map of a function of both quantities.
    pub fn sample(
        title: &str,
        axes: [&str; 2],
        ranges: [[f64; 2]; 2],
        worst: (f64, [f64; 2]),
        error: impl Fn([f64; 2]) -> f64,
    ) -> Self {
        let cells = (0..Self::SIDE).flat_map(|y| (0..Self::SIDE).map(move |x| [(x, ranges[0]), (y, ranges[1])]));
        let middles = cells
            .map(|cell| cell.map(|(i, [from, to])| from * libm::pow(to / from, (i as f64 + 0.5) / Self::SIDE as f64)));
        let errors = middles.map(error).collect();
        Self { title: title.to_owned(), axes: axes.map(str::to_owned), ranges, columns: Self::SIDE, errors, worst }
    }

    /// The map as SVG.
    fn svg(&self) -> String {
        let rows = self.errors.len() / self.columns.max(1);
        let (width, height) = (FRAME / self.columns as f64, FRAME / rows as f64);
        let mut out = format!(
            "<svg viewBox=\"0 0 {} {}\" role=\"img\" aria-label=\"{}\">",
            LEFT + FRAME + 8.0,
            FRAME + BELOW + 6.0,
            escape(&format!("errors of {} over {} and {}", self.title, self.axes[0], self.axes[1]))
        );
        for (y, row) in self.errors.chunks_exact(self.columns).enumerate() {
            // The second quantity rises from the bottom. Cells of one colour become one rectangle.
            let top = 4.0 + FRAME - height * (y + 1) as f64;
            let mut x = 0;
            while x < row.len() {
                let color = color_of(row[x]);
                let run = row[x..].iter().take_while(|error| color_of(**error) == color).count();
                let _ = write!(
                    out,
                    "<rect x=\"{:.1}\" y=\"{top:.1}\" width=\"{:.1}\" height=\"{:.1}\" fill=\"{color}\"/>",
                    LEFT + width * x as f64,
                    width * run as f64 + 0.2,
                    height + 0.2
                );
                x += run;
            }
        }
        for tick in TICKS {
            if let Some(at) = self.place(0, tick) {
                let (x, y) = (LEFT + FRAME * at, 4.0 + FRAME + 13.0);
                let _ = write!(out, "<text x=\"{x:.1}\" y=\"{y:.1}\" text-anchor=\"middle\">{tick}</text>");
            }
            if let Some(at) = self.place(1, tick) {
                let (x, y) = (LEFT - 4.0, 4.0 + FRAME * (1.0 - at) + 4.0);
                let _ = write!(out, "<text x=\"{x:.1}\" y=\"{y:.1}\" text-anchor=\"end\">{tick}</text>");
            }
        }
        let (x, y) = (LEFT + FRAME / 2.0, FRAME + 32.0);
        let _ = write!(out, "<text x=\"{x:.1}\" y=\"{y:.1}\" text-anchor=\"middle\">{}</text>", escape(&self.axes[0]));
        let y = 4.0 + FRAME / 2.0;
        let _ = write!(
            out,
            "<text x=\"10\" y=\"{y:.1}\" text-anchor=\"middle\" transform=\"rotate(-90 10 {y:.1})\">{}</text>",
            escape(&self.axes[1])
        );
        let (largest, at) = self.worst;
        if let (Some(x), Some(y)) = (self.place(0, at[0]), self.place(1, at[1])) {
            let _ = write!(
                out,
                "<circle class=\"worst\" cx=\"{:.1}\" cy=\"{:.1}\" r=\"7\"><title>largest: {}</title></circle>",
                LEFT + FRAME * x,
                4.0 + FRAME * (1.0 - y),
                error(largest)
            );
        }
        out.push_str("</svg>");
        out
    }

    /// Position of a value along an axis, 0..=1.
    fn place(&self, axis: usize, value: f64) -> Option<f64> {
        let [from, to] = self.ranges[axis];
        let at = libm::log(value.max(1e-300) / from) / libm::log(to / from);
        (-1e-9..=1.0 + 1e-9).contains(&at).then_some(at.clamp(0.0, 1.0))
    }
}

/// The page of one table.
#[derive(Debug, Clone, PartialEq)]
pub struct Certificate {
    /// Title: the table in words.
    pub title: String,
    /// The verdict in a line; and whether the limit is held, if one is stated.
    pub verdict: (String, Option<bool>),
    /// Facts: name and value.
    pub facts: Vec<(String, String)>,
    /// Maps of the error; the first is the table's.
    pub maps: Vec<ErrorMap>,
    /// How errors were measured.
    pub method: String,
}

impl Certificate {
    /// The page: HTML without scripts, in one file.
    pub fn html(&self) -> String {
        let mut out = String::with_capacity(128 << 10);
        out.push_str("<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"/>");
        out.push_str("<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\"/>");
        let _ = writeln!(out, "<title>luthier: {}</title><style>", escape(&self.title));
        out.push_str(include_str!("pages/page/style.css"));
        out.push_str(include_str!("certificate.css"));
        out.push_str("</style></head>\n<body><main>\n");
        let (verdict, held) = &self.verdict;
        let class = held.map_or("", |held| if held { "good" } else { "bad" });
        let _ = write!(
            out,
            "<h1>{}</h1>\n<div class=\"verdict {class}\"><p class=\"figure\">{}</p></div>\n<div class=\"maps\">",
            escape(&self.title),
            escape(verdict)
        );
        for map in &self.maps {
            let (largest, [x, y]) = map.worst;
            let _ = writeln!(
                out,
                "<figure class=\"map\">{}<figcaption><b>{}</b><br/>largest {} at {} {}, {} {}</figcaption></figure>",
                map.svg(),
                escape(&map.title),
                error(largest),
                escape(&map.axes[0]),
                number(x),
                escape(&map.axes[1]),
                number(y)
            );
        }
        out.push_str("</div>\n<p class=\"scale\">");
        for (i, color) in COLORS.iter().enumerate() {
            let label = if i % 2 == 0 { format!("1e{}", DECADES[0] + i as i32 / 2) } else { String::new() };
            let _ = write!(out, "<span><i style=\"background:{color}\"></i>{label}</span>");
        }
        out.push_str("</p>\n<table class=\"statement\"><tbody>\n");
        for (name, value) in &self.facts {
            let _ = writeln!(out, "<tr><th scope=\"row\">{}</th><td>{}</td></tr>", escape(name), escape(value));
        }
        let _ =
            write!(out, "</tbody></table>\n<p class=\"note\">{}</p>\n</main></body></html>\n", escape(&self.method));
        out
    }
}

/// The colour of an error.
fn color_of(error: f64) -> &'static str {
    if error.is_nan() {
        return COLORS[COLORS.len() - 1];
    }
    let step = 2.0 * (libm::log10(error.max(1e-300)) - f64::from(DECADES[0]));
    COLORS[step.clamp(0.0, (COLORS.len() - 1) as f64) as usize]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn map() -> ErrorMap {
        let worst = (2e-2, [0.02, 0.5]);
        ErrorMap::sample("mine", ["cos_theta", "alpha"], [[0.01, 1.0], [0.01, 1.0]], worst, |[cos, alpha]| {
            if cos < 0.1 { 2e-2 } else { 1e-5 * alpha }
        })
    }

    /// Half of a logarithmic axis lies below 0.1; the page holds each map, its worst place, and no script.
    #[test]
    fn a_map_shows_where_errors_are() {
        let map = map();
        assert_eq!(map.errors.iter().filter(|error| **error == 2e-2).count(), ErrorMap::SIDE * ErrorMap::SIDE / 2);
        assert_eq!((map.place(0, 0.1), map.place(1, 1.0), map.place(1, 2.0)), (Some(0.5), Some(1.0), None));
        let facts = vec![("size".to_owned(), "8 x 8 <half>".to_owned())];
        let certificate = Certificate {
            title: "A table".to_owned(),
            verdict: ("holds 0.05".to_owned(), Some(true)),
            facts,
            maps: vec![map.clone(), map],
            method: "bilinear".to_owned(),
        };
        let page = certificate.html();
        assert_eq!(page.matches("class=\"worst\"").count(), 2);
        assert!(page.contains("largest 0.0200 at cos_theta 0.02, alpha 0.5") && page.contains("8 x 8 &lt;half&gt;"));
        assert!(!page.contains("<script") && page.len() < 200_000, "{}", page.len());
    }

    #[test]
    fn colours_are_those_of_half_decades() {
        let at = |error: f64| COLORS.iter().position(|color| *color == color_of(error)).unwrap();
        assert_eq!([0.0, 1e-9, 2e-6, 1.1e-5, 4e-5, 1.1e-1, 9.0].map(at), [0, 0, 0, 2, 3, 10, 10]);
    }
}
