//! Charts of errors of `f cos_theta_i`.

use crate::judge::profile::{ANGLE_BINS, Exceedance};
use crate::judge::report::{Compared, MaterialReport, Report};
use crate::svg::frame::{Frame, Margin, Mark, Series};
use crate::svg::scale::Scale;
use crate::text::format::error;

/// Errors below this share the end of an axis.
const SMALLEST: f64 = 1e-9;

/// Colour and mark of a comparison in all charts.
pub(crate) fn series(compared: Compared) -> Series {
    let (class, mark) = match compared {
        Compared::BakedDevice => ("s-baked", Mark::Circle),
        Compared::TablesEightBit => ("s-tables", Mark::Diamond),
        Compared::TablesExact => ("s-full", Mark::Square),
        Compared::FullDevice => ("s-full", Mark::Square),
        Compared::Arithmetic => ("s-arithmetic", Mark::Circle),
        Compared::ThreeWavelengths => ("s-model", Mark::Square),
    };
    Series { class, mark, name: compared.name() }
}

/// A row for each material, with a mark for the largest error of each comparison. A line shows the budget, or the target if there is none.
pub(crate) fn max_by_material(report: &Report, compared: &[Compared]) -> String {
    const ROW: f64 = 24.0;
    let comparisons = report.materials.iter().flat_map(|m| compared.iter().filter_map(|c| m.comparison(*c)));
    let (limit, named) = report.budget.map_or((report.target_max_rel_err, "target"), |budget| (budget, "limit"));
    let x = Scale::decades(comparisons.map(|c| c.max_error()).chain([limit]), SMALLEST);
    let margin = Margin { left: 210.0, right: 74.0, top: 20.0, bottom: 38.0 };
    let height = margin.top + margin.bottom + ROW * report.materials.len() as f64;
    let mut frame = Frame::new([1000.0, height], margin, x, Scale::linear(0.0, 1.0, 1.0));
    frame.x_axis("largest error, relative to max(brightest channel of the reference, floor); logarithmic");
    frame.rule_x(limit, &format!("{named} {}", error(limit)));
    for (row, material) in report.materials.iter().enumerate() {
        let y = margin.top + ROW * (row as f64 + 0.5);
        frame.begin(&material.name);
        frame.text(margin.left - 12.0, y + 4.0, "end", "label", &material.name);
        // An error of zero has no place on a logarithmic axis.
        let made = compared.iter().filter_map(|c| material.comparison(*c));
        let found: Vec<_> = made.filter(|c| c.max_error() > 0.0).collect();
        let pixels: Vec<f64> = found.iter().map(|c| frame.px(c.max_error())).collect();
        let ends = pixels.iter().fold((f64::INFINITY, 0.0_f64), |(lo, hi), &x| (lo.min(x), hi.max(x)));
        if ends.0 <= ends.1 {
            frame.span(ends.0, ends.1, y);
        }
        for (comparison, x) in found.iter().zip(pixels).rev() {
            let tip = format!("{}: {} {}", material.name, comparison.compared.name(), error(comparison.max_error()));
            frame.mark(series(comparison.compared), x, y, &tip);
        }
        let judged = found.iter().filter(|c| c.compared.is_judged(report.device.is_some()));
        let largest = judged.map(|c| c.max_error()).fold(0.0, f64::max);
        let over = report.budget.is_some_and(|budget| largest > budget);
        frame.text(992.0, y + 4.0, "end", if over { "value over" } else { "value" }, &error(largest));
        frame.end();
    }
    frame.finish("Largest relative error of every material, a mark per comparison")
}

/// The share of all samples whose error exceeds x, over all materials and sets; both axes logarithmic.
pub(crate) fn exceedance(report: &Report, compared: &[Compared]) -> String {
    let mut curves = Vec::new();
    for &compared in compared {
        let mut sum = Exceedance::new();
        for comparison in report.materials.iter().filter_map(|m| m.comparison(compared)) {
            sum.merge(&comparison.exceedance);
        }
        curves.push((compared, sum.shares()));
    }
    let points = curves.iter().flat_map(|(_, shares)| shares);
    let x = Scale::decades(points.clone().map(|p| p.0).chain(report.budget), SMALLEST);
    let y = Scale::decades(points.map(|p| p.1), 1e-7);
    let margin = Margin { left: 44.0, right: 14.0, top: 24.0, bottom: 38.0 };
    let mut frame = Frame::new([490.0, 290.0], margin, x, y);
    frame.x_axis("relative error, as above");
    frame.y_axis("share of samples with a larger error");
    if let Some(budget) = report.budget {
        frame.rule_x(budget, "");
    }
    for (compared, shares) in &curves {
        frame.line(series(*compared).class, compared.name(), shares.iter().copied().map(Some));
    }
    frame.finish("Share of samples that exceed an error")
}

/// The largest error by the larger angle to the normal, for one material.
pub(crate) fn by_angle(material: &MaterialReport, compared: &[Compared], budget: Option<f64>) -> String {
    let found: Vec<_> = compared.iter().filter_map(|c| material.comparison(*c)).collect();
    let values = found.iter().flat_map(|c| c.by_angle.max.iter().flatten().copied());
    let y = Scale::decades(values.chain(budget), SMALLEST);
    let margin = Margin { left: 44.0, right: 10.0, top: 24.0, bottom: 38.0 };
    let mut frame = Frame::new([490.0, 230.0], margin, Scale::linear(0.0, 90.0, 15.0), y);
    frame.x_axis("larger of the angles of wi and wo to the normal, degrees");
    frame.y_axis("largest relative error");
    if let Some(budget) = budget {
        frame.rule_y(budget, "budget");
    }
    let width = 90.0 / ANGLE_BINS as f64;
    for comparison in found {
        let points = comparison.by_angle.max.iter().enumerate();
        let points = points.map(|(bin, max)| max.map(|max| ((bin as f64 + 0.5) * width, max)));
        frame.line(series(comparison.compared).class, comparison.compared.name(), points);
    }
    frame.finish(&format!("{}: largest relative error by angle", material.name))
}
