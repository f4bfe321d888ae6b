//! The tables and shaders of the bake where methods fail, and the heat map of the whole suite.

use std::fmt::Write;

use super::{cell, of_material};
use crate::judge::evidence::Exhibits;
use crate::judge::report::Report;
use crate::stability::{Aim, FAILS, HOLDS, HOLDS_ALBEDO, Level, Shipped, Stressed, heat_map_svg};
use crate::text::format::{error, escape, none};

/// Sets of directions with a column.
const AIMS: [Aim; 4] = [Aim::Grazing, Aim::Mirror, Aim::Retro, Aim::Opposite];

pub(super) fn write(out: &mut String, report: &Report, exhibits: &Exhibits) {
    super::fold(out, "stability", "Stability", &says(report));
    shipped(out, report);
    map(out, report, exhibits);
    super::end_fold(out);
}

fn all(report: &Report) -> impl Iterator<Item = &Shipped> {
    report.materials.iter().filter_map(|m| m.stability.as_ref())
}

fn says(report: &Report) -> String {
    if all(report).next().is_none() {
        return "not in this report".to_owned();
    }
    let not_finite: u64 = all(report).map(Shipped::not_finite).sum();
    let values: u64 = all(report).flat_map(|s| &s.stressed).map(|s| s.values).sum();
    let worst = all(report).flat_map(|s| &s.stressed).map(|s| s.error).fold(0.0, f64::max);
    format!(
        "where formulas divide by little: {not_finite} of {values} values not finite, largest error {}",
        error(worst)
    )
}

fn shipped(out: &mut String, report: &Report) {
    if all(report).next().is_none() {
        return;
    }
    let _ = write!(
        out,
        "<h3 id=\"shipped\">This bake</h3><p>The tables and shaders of this bake at directions where formulas divide by small numbers: {}. Errors are against the model in f64 with exact \
         terms, relative, with the floor of the other sections. Negative light counts where the model has none, and light at or below the horizon as well. f32 is what single precision adds: \
         the baked shader against f64 on the same tables; of the full shader it is the whole error. The albedo is the light that comes back in all, in the brightest channel, the largest of \
         those seen from 0°, 45°, 75° and 89°, ± the difference of two quadratures; above 1 it is a gain, and a defect where the model claims that there is none.</p>",
        AIMS.map(|aim| format!("<b>{}</b> ({})", aim.name(), escape(aim.title()))).join(", ")
    );
    out.push_str(
        "<div class=\"scroll\"><table class=\"sortable\"><thead><tr><th>material</th><th>level</th><th class=\"n\">values</th><th class=\"n\">not finite</th><th \
         class=\"n\">negative</th>",
    );
    AIMS.iter().for_each(|aim| out.push_str(&format!("<th class=\"n\">{}</th>", aim.name())));
    out.push_str("<th class=\"n\">f32</th><th class=\"n\">largest albedo</th><th>claims ≤ 1</th></tr></thead><tbody>");
    for material in &report.materials {
        let Some(stability) = &material.stability else { continue };
        for level in [Level::Table, Level::Device, Level::F32] {
            row(out, &material.name, stability, level);
        }
    }
    let _ = write!(
        out,
        "</tbody></table></div><p class=\"legend\">An error holds up to {HOLDS}, and beyond {FAILS} a shader no longer shows its model.</p>"
    );
}

fn row(out: &mut String, name: &str, stability: &Shipped, level: Level) {
    let here: Vec<&Stressed> = stability.stressed.iter().filter(|s| s.level == level).collect();
    if here.is_empty() {
        return;
    }
    let values: u64 = here.iter().map(|s| s.values).sum();
    let not_finite: u64 = here.iter().map(|s| s.not_finite).sum();
    let negative = here.iter().map(|s| s.negative).fold(0.0, f64::max);
    let marked = |text: &str, is_bad: bool| {
        if is_bad { format!("<td class=\"n over\">{}</td>", escape(text)) } else { cell(text) }
    };
    let _ = write!(out, "<tr{}><th>{}</th><td>{}</td>", of_material(name), escape(name), level.shipped_name());
    out.push_str(&cell(&values.to_string()));
    out.push_str(&marked(&not_finite.to_string(), not_finite > 0));
    out.push_str(&marked(&error(negative), negative > 0.0));
    for aim in AIMS {
        let found = here.iter().find(|s| s.directions == aim);
        out.push_str(&found.map_or_else(|| cell(&none()), |s| marked(&error(s.error), s.error > HOLDS)));
    }
    let arithmetic = here.iter().filter_map(|s| s.arithmetic).reduce(f64::max);
    let whole = here.iter().map(|s| s.error).fold(0.0, f64::max);
    let arithmetic = if level == Level::F32 { Some(whole) } else { arithmetic };
    out.push_str(&cell(&arithmetic.map_or_else(none, error)));
    let albedos = stability.albedos.iter().filter(|a| a.level == level);
    let worst = albedos.filter_map(|a| Some((a, a.albedo?))).max_by(|a, b| a.1.total_cmp(&b.1));
    let albedo =
        worst.map_or_else(none, |(a, albedo)| format!("{albedo:.3} ± {:.0e} at {}°", a.uncertainty, a.theta_deg));
    out.push_str(&marked(&albedo, worst.is_some_and(|(a, _)| stability.claims_energy && a.gain() > 0.0)));
    let _ = write!(out, "<td>{}</td></tr>", if stability.claims_energy { "yes" } else { "no" });
}

fn map(out: &mut String, report: &Report, exhibits: &Exhibits) {
    out.push_str("<h3 id=\"suite\">The whole suite</h3>");
    let Some((suite, summary)) = exhibits.stability.as_ref().zip(report.stability.as_ref()) else {
        out.push_str(
            "<p>This report has no results of the suite, which runs every model on stacks that make methods fail. <code>luthier-lab stability --json -o stability.json</code> runs it, and \
             <code>luthier report --stability stability.json</code> shows its results.</p>\n",
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
