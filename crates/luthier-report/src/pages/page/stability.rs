//! The heat map of the stability suite.

use std::fmt::Write;

use crate::judge::evidence::Exhibits;
use crate::judge::report::Report;
use crate::stability::{FAILS, HOLDS, HOLDS_ALBEDO, heat_map_svg};
use crate::text::format::escape;

pub(super) fn write(out: &mut String, report: &Report, exhibits: &Exhibits) {
    let says = report.stability.as_ref().map_or_else(
        || "not in this report".to_owned(),
        |s| format!("{} of {} cells hold, {} degrade, {} fail", s.holds, s.cells, s.degrades, s.fails),
    );
    super::fold(out, "stability", "Stability", &says);
    map(out, report, exhibits);
    super::end_fold(out);
}

fn map(out: &mut String, report: &Report, exhibits: &Exhibits) {
    let Some((suite, summary)) = exhibits.stability.as_ref().zip(report.stability.as_ref()) else {
        out.push_str(
            "<p>This report has no results of the suite. <code>luthier-lab stability --json -o stability.json</code> runs it, and <code>luthier report \
             --stability stability.json</code> shows its results.</p>\n",
        );
        return;
    };
    let _ = write!(
        out,
        "<p>The suite runs each model, and the shader of each model that has one, on stacks and directions at which formulas divide by small \
         numbers, overflow or stop being true. Of {} cells {} hold, {} degrade and {} fail. {} have no explanation. {} cells of shaders and tables \
         are not finite. A shader holds up to a relative error of {HOLDS}, and the albedo of a model up to an absolute error of {HOLDS_ALBEDO}; \
         beyond {FAILS} both fail. Made by {} on {}.</p>",
        summary.cells,
        summary.holds,
        summary.degrades,
        summary.fails,
        summary.unexplained,
        summary.not_finite,
        escape(&summary.generator),
        escape(summary.device.as_deref().unwrap_or("no adapter"))
    );
    out.push_str(
        "<p class=\"legend\"><span class=\"heat holds\">holds</span><span class=\"heat degrades\">· degrades</span><span class=\"heat \
         fails\">× fails</span>Rows are methods, grouped by level; columns are cases. Hover over a cell for its error and the explanation, and over the name of a \
         case for its description.</p><figure class=\"heat-map\">",
    );
    out.push_str(&heat_map_svg(suite));
    out.push_str("</figure>\n");
}
