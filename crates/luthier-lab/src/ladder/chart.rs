//! The chart of `ladder`: error against time of lobes, published models and coats of engines. It draws tables of the page, so that a page is enough.

use luthier_report::{PlotColor, Scatter, ScatterPanel, ScatterPoint};

/// Groups whose stacks are judged: their heading on the page, and the words behind their number on the chart.
const PANELS: [(&str, &str); 2] =
    [("Coats of engines", "clear coats over metals and plastics"), ("Random stacks", "random stacks of 2 to 5 layers")];

/// Larger errors end at the edge of the chart.
const MOST: f64 = 1.9;

/// Points of lobes whose numbers are nearer than these factors share a name: of cost, and of error.
const ALIKE: [f64; 2] = [1.04, 1.12];

/// The chart of a page as SVG; `None` if the page has no stacks that were judged.
pub(super) fn chart(page: &str, device: &str) -> Option<String> {
    let panels: Vec<ScatterPanel> =
        PANELS.into_iter().filter_map(|(heading, words)| panel(page, heading, words)).collect();
    let scatter = Scatter {
        title: format!("lobe error against predicted time on {device}"),
        axes: [
            format!("predicted ps for one light on an {device}; reads are assumed"),
            "lobe error at the worst of nine views".to_owned(),
        ],
        untimed: "not counted yet".to_owned(),
        kinds: vec![
            (PlotColor::Blue, "lobes of luthier: the default, and the cheapest within a limit".to_owned()),
            (PlotColor::Ink, "published models".to_owned()),
            (PlotColor::Red, "clear coats of engines and formats".to_owned()),
            (PlotColor::Green, "the same over a base that is changed once".to_owned()),
        ],
        rules: vec![(0.5, "as wrong as a black surface".to_owned())],
        line: PlotColor::Blue,
        panels,
    };
    (!scatter.panels.is_empty()).then(|| scatter.to_svg())
}

/// A group of the page: from the first row of what limits take the number of stacks, and a point for each row of the table beside models.
fn panel(page: &str, heading: &str, words: &str) -> Option<ScatterPanel> {
    let (_, limits) = page.split_once(&format!("\n## {heading}\n"))?;
    let (_, first) = limits.split_once("\n| none | ")?;
    let (count, _) = first.split_once(" of ")?;
    let (_, judged) = page.split_once(&format!("\n### {heading}\n"))?;
    let rows = judged.lines().skip_while(|line| !line.starts_with('|')).take_while(|line| line.starts_with('|'));
    // Below the heading of the table, and the line under that.
    let mut points: Vec<ScatterPoint> = Vec::new();
    for here in rows.skip(2).filter_map(point) {
        match points.iter_mut().find(|other| are_alike(other, &here)) {
            Some(other) => {
                other.name += &format!(", {}", here.name);
                other.reach = other.reach.max(here.reach);
            }
            None => points.push(here),
        }
    }
    // The line joins lobes from the cheapest on.
    let x = |point: &ScatterPoint| point.x.unwrap_or(f64::INFINITY);
    points.sort_by(|a, b| x(a).total_cmp(&x(b)).then(b.y.total_cmp(&a.y)));
    Some(ScatterPanel { title: format!("{count} {words}"), points })
}

/// The point of a row: name, three ranks of the lobe error and of the albedo error, and the costs of one light and of each of several.
fn point(row: &str) -> Option<ScatterPoint> {
    let mut cells = row.trim_matches('|').split('|').map(str::trim);
    let (name, color) = charted(cells.next()?)?;
    let [y, reach] = [cells.next()?, cells.next()?].map(|cell| cell.parse::<f64>().map(|error| error.min(MOST)));
    let x = cells.nth(4)?.parse().ok();
    Some(ScatterPoint { name, x, y: y.ok()?, reach: reach.ok()?, color })
}

/// Name and colour on the chart. Two models are left out, because they lie on others.
fn charted(name: &str) -> Option<(String, PlotColor)> {
    let published = |short: &str| Some((short.to_owned(), PlotColor::Ink));
    let engine = |short: &str| Some((short.to_owned(), PlotColor::Red));
    match name {
        "lobes" => Some(("lobes, default".to_owned(), PlotColor::Blue)),
        "lobes, least error" => Some(("least error".to_owned(), PlotColor::Blue)),
        "phong" => published("Phong 1975"),
        "microfacet" => published("top layer alone"),
        "elek" => published("Elek 2010"),
        "belcour" => published("Belcour 2018"),
        "weidlich-wilkie" | "yamaguchi" => None,
        "glTF KHR_materials_clearcoat" => engine("glTF clear coat"),
        "Filament" => engine("Filament clear coat"),
        "Standard Surface in MaterialX" => engine("Standard Surface"),
        "OpenPBR in MaterialX" => engine("OpenPBR (MaterialX)"),
        "adobe/openpbr-bsdf" => engine("OpenPBR (Adobe)"),
        other => match other.strip_prefix("lobes within ") {
            Some(limit) => Some((format!("asked ≤ {limit}"), PlotColor::Blue)),
            None if other.ends_with("base changed") => Some((other.to_owned(), PlotColor::Green)),
            None => engine(other),
        },
    }
}

/// Whether both are lobes whose marks would lie on each other.
fn are_alike(a: &ScatterPoint, b: &ScatterPoint) -> bool {
    let within = |a: f64, b: f64, factor: f64| a.max(b) <= factor * a.min(b);
    let are_lobes = a.color == PlotColor::Blue && b.color == PlotColor::Blue;
    are_lobes && a.x.zip(b.x).is_some_and(|(a, b)| within(a, b, ALIKE[0])) && within(a.y, b.y, ALIKE[1])
}

#[cfg(test)]
mod tests {
    use super::*;

    const PAGE: &str = "# A ladder

## Random stacks

| limit | stacks that hold it |
|--:|--:|
| none | 7 of 8 |

## Beside models

### Random stacks

| | median | 95th percentile | largest | albedo: median | 95th percentile | largest | one light | each of 4 |
|---|--:|--:|--:|--:|--:|--:|--:|--:|
| lobes | 0.014 | 0.052 | 0.091 | 0.001 | 0.006 | 0.013 | 8.7 | 4.7 |
| lobes within 0.02 | 0.015 | 0.060 | 0.068 | 0.002 | 0.010 | 0.052 | 8.8 | 5.1 |
| phong | 0.885 | 4.247 | 12.989 | 0.419 | 0.709 | 0.821 | 1.6 | 1.7 |
| yamaguchi | 0.223 | 0.484 | 0.655 | 0.049 | 0.270 | 0.672 | 45.2 | 16.5 |
| Disney 2012 | 0.432 | 0.806 | 0.913 | 0.251 | 0.460 | 0.472 | – | – |

A word.
";

    #[test]
    fn tables_of_a_page_are_points() {
        let panel = panel(PAGE, "Random stacks", "stacks").unwrap();
        let point = |name: &str, x, y, reach, color| ScatterPoint { name: name.to_owned(), x, y, reach, color };
        assert_eq!(panel.title, "7 stacks");
        // Marks of lobes that lie on each other are one. The longest line ends at the edge.
        let expected = [
            point("Phong 1975", Some(1.6), 0.885, MOST, PlotColor::Ink),
            point("lobes, default, asked ≤ 0.02", Some(8.7), 0.014, 0.06, PlotColor::Blue),
            point("Disney 2012", None, 0.432, 0.806, PlotColor::Red),
        ];
        assert_eq!(panel.points, expected);
        assert!(chart("# A ladder\n", "GPU").is_none());
    }
}
