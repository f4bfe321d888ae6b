//! Chart of all materials: cost against error.

use super::frame::{Frame, Margin, Series};
use super::scale::Scale;

/// Errors below this share the end of an axis.
const SMALLEST: f64 = 1e-9;

/// Size of the chart.
const SIZE: [f64; 2] = [1064.0, 300.0];

/// Advance of a letter, and height of a line.
const LETTER: [f64; 2] = [6.2, 13.0];

/// Room that a mark takes to each side.
const MARK: f64 = 6.0;

/// A shader or the tables of a material.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Spot {
    /// Name of the material.
    pub(crate) material: String,
    /// Anchor of the material's section of the page.
    pub(crate) anchor: String,
    /// Cycles or bytes.
    pub(crate) price: f64,
    /// Largest relative error.
    pub(crate) error: f64,
    /// Description of the spot.
    pub(crate) tip: String,
    /// Colour and mark of the spot.
    pub(crate) series: Series,
    /// Whether the name stands beside the mark, if there is room.
    pub(crate) is_named: bool,
}

/// A chart with a mark for each spot, linked to its material. Names stand beside marks if there is room; a line shows the limit on the error.
pub(crate) fn field(label: &str, x_title: &str, spots: &[Spot], limit: (f64, &str)) -> String {
    let x = Scale::fine(spots.iter().map(|s| s.price));
    let y = Scale::decades(spots.iter().map(|s| s.error).chain([limit.0]), SMALLEST);
    let margin = Margin { left: 46.0, right: 24.0, top: 24.0, bottom: 38.0 };
    let mut frame = Frame::new(SIZE, margin, x, y);
    frame.x_axis(x_title);
    frame.y_axis("largest relative error");
    frame.rule_y(limit.0, limit.1);
    let places: Vec<[f64; 2]> = spots.iter().map(|s| [frame.px(s.price), frame.py(s.error)]).collect();
    let mut taken: Vec<Rect> = places.iter().map(|&[x, y]| Rect([x - MARK, y - MARK, x + MARK, y + MARK])).collect();
    let rule = frame.py(limit.0);
    taken.push(Rect([margin.left, rule - 2.0, SIZE[0], rule + 2.0]));
    for (spot, &[x, y]) in spots.iter().zip(&places) {
        frame.begin_link(&spot.anchor, &spot.material);
        frame.mark(spot.series, x, y, &spot.tip);
        let width = LETTER[0] * spot.material.chars().count() as f64;
        let room = Rect([margin.left, margin.top - 6.0, SIZE[0], SIZE[1] - margin.bottom]);
        let around =
            [("start", x + 9.0, y + 4.0), ("end", x - 9.0, y + 4.0), ("middle", x, y - 9.0), ("middle", x, y + 17.0)];
        let free = around.into_iter().filter(|_| spot.is_named).find_map(|(anchor, left, base)| {
            let start =
                left - width * ["start", "middle", "end"].iter().position(|a| *a == anchor).unwrap_or(0) as f64 / 2.0;
            let rect = Rect([start, base - LETTER[1] + 3.0, start + width, base + 3.0]);
            let is_free = rect.is_within(&room) && taken.iter().all(|other| !rect.meets(other));
            is_free.then_some((anchor, left, base, rect))
        });
        if let Some((anchor, left, base, rect)) = free {
            frame.text(left, base, anchor, "tick", &spot.material);
            taken.push(rect);
        }
        frame.end_link();
    }
    frame.finish(label)
}

/// Left, top, right, bottom.
struct Rect([f64; 4]);

impl Rect {
    fn meets(&self, other: &Self) -> bool {
        let (Self([l, t, r, b]), Self([ol, ot, or, ob])) = (self, other);
        l < or && ol < r && t < ob && ot < b
    }

    fn is_within(&self, other: &Self) -> bool {
        let (Self([l, t, r, b]), Self([ol, ot, or, ob])) = (self, other);
        l >= ol && t >= ot && r <= or && b <= ob
    }
}

#[cfg(test)]
mod tests {
    use super::super::frame::Mark;
    use super::*;

    fn spot(material: &str, price: f64, error: f64) -> Spot {
        let series = Series { class: "s-baked", name: "", mark: Mark::Circle };
        let (anchor, tip) = (format!("of-{material}"), format!("about {material}"));
        Spot { material: material.to_owned(), anchor, price, error, tip, series, is_named: true }
    }

    /// Every spot has its mark, its link and its tip; a name that would lie on another is left to the tip.
    #[test]
    fn every_spot_is_a_link() {
        let spots = [spot("gold", 10.0, 3e-3), spot("lacquer", 400.0, 1e-2), spot("none", 100.0, 0.0)];
        let svg = field("all", "cycles", &spots, (1e-3, "target"));
        for s in &spots {
            assert!(svg.contains(&format!("<a href=\"#of-{}\"", s.material)), "{svg}");
            assert!(
                svg.contains(&format!("<title>about {}</title>", s.material))
                    && svg.contains(&format!(">{}<", s.material))
            );
        }
        assert_eq!(svg.matches("<circle class=\"mark").count(), 3);
        let crowd: Vec<Spot> = (0..40).map(|i| spot(&format!("a-long-name-{i}"), 100.0, 1e-3)).collect();
        let svg = field("all", "cycles", &crowd, (1e-3, "target"));
        let named = svg.matches("class=\"tick\" ").count() - svg.matches("text-anchor=\"middle\">1").count();
        assert!(svg.matches("<title>").count() == 40 && named < 20, "{named}");
    }
}
