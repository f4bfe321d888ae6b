//! The chart of `ladder`: error against time of lobes, published models and coats of engines.

use luthier_cost::DeviceCost;
use luthier_report::{PlotColor, Scatter, ScatterPanel, ScatterPoint};

use super::Group;
use super::page::medians;
use super::rivals::Kind;
use super::steps::Ask;
use crate::lobes::ranks;

/// Larger errors end at the edge of the chart.
const MOST: f64 = 1.9;

/// Points of lobes whose numbers are nearer than these factors share a name: of cost, and of error.
const ALIKE: [f64; 2] = [1.04, 1.12];

/// The chart as SVG.
pub(super) fn chart(groups: &[Group], device: &DeviceCost) -> String {
    let panels = groups.iter().filter_map(|group| {
        let title = group.charted.clone()?;
        Some(ScatterPanel { title, points: points(group) })
    });
    let scatter = Scatter {
        title: format!("lobe error against predicted time on {}", device.device),
        axes: [
            format!(
                "predicted, not timed: picoseconds for one light on an {}; reads of rows are assumed",
                device.device
            ),
            "lobe error at the worst of nine views".to_owned(),
        ],
        untimed: "not counted yet".to_owned(),
        kinds: vec![
            (PlotColor::Blue, "lobes of luthier: the default, and the cheapest within a limit on the error".to_owned()),
            (PlotColor::Ink, "published models".to_owned()),
            (
                PlotColor::Red,
                "clear coats of engines and formats (marks: median of the stacks; lines: to the 95th percentile)"
                    .to_owned(),
            ),
            (PlotColor::Green, "the same over a base that is changed once for its coat".to_owned()),
        ],
        rules: vec![(0.5, "as wrong as a black surface".to_owned())],
        line: PlotColor::Blue,
        panels: panels.collect(),
    };
    scatter.to_svg()
}

fn points(group: &Group) -> Vec<ScatterPoint> {
    let point = |name: String, x, errors: [f64; 3], color| {
        let [y, reach, _] = errors;
        ScatterPoint { name, x, y: y.min(MOST), reach: reach.min(MOST), color }
    };
    let mut asks: Vec<ScatterPoint> = Vec::new();
    for (number, ask) in Ask::ALL.into_iter().enumerate() {
        let name = match ask {
            Ask::Default => "lobes, default".to_owned(),
            Ask::Least => "least error".to_owned(),
            Ask::Limit(limit) => format!("asked ≤ {limit}"),
        };
        let [one, ..] = medians(group.taken(number).map(|taken| &taken.costs));
        let errors = ranks(group.taken(number).map(|taken| taken.judged[0]));
        let here = point(name, Some(one), errors, PlotColor::Blue);
        match asks.iter_mut().find(|other| are_alike(other, &here)) {
            Some(other) => {
                other.name += &format!(", {}", here.name);
                other.reach = other.reach.max(here.reach);
            }
            None => asks.push(here),
        }
    }
    let first = group.stacks.first().map_or(&[][..], |stack| &stack.rivals);
    let rivals = first.iter().enumerate().filter_map(|(number, rival)| {
        let all = || group.stacks.iter().map(move |stack| &stack.rivals[number]);
        let x = rival.costs.map(|_| medians(all().filter_map(|rival| rival.costs.as_ref()))[0]);
        let color = match rival.kind {
            Kind::Published => PlotColor::Ink,
            Kind::Engine => PlotColor::Red,
            Kind::Changed => PlotColor::Green,
        };
        Some(point(rival.charted?.to_owned(), x, ranks(all().map(|rival| rival.judged[0])), color))
    });
    let mut points: Vec<ScatterPoint> = asks.into_iter().chain(rivals).collect();
    // The line joins lobes from the cheapest on.
    let x = |point: &ScatterPoint| point.x.unwrap_or(f64::INFINITY);
    points.sort_by(|a, b| x(a).total_cmp(&x(b)).then(b.y.total_cmp(&a.y)));
    points
}

/// Whether marks of two points would lie on each other.
fn are_alike(a: &ScatterPoint, b: &ScatterPoint) -> bool {
    let within = |a: f64, b: f64, factor: f64| a.max(b) <= factor * a.min(b);
    a.x.zip(b.x).is_some_and(|(a, b)| within(a, b, ALIKE[0])) && within(a.y, b.y, ALIKE[1])
}
