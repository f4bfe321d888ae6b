//! One section per material.

use luthier_manifest::ColorMode;
use std::fmt::Write;

use super::{anchor, cell, glance, of_material, pictures, summary, trade};
use crate::judge::evidence::Exhibits;
use crate::judge::report::{Compared, MaterialReport, Report};
use crate::measure::directions::DirectionSet;
use crate::measure::statistics::{ErrorSummary, Statistics};
use crate::pages::chart;
use crate::svg::legend;
use crate::text::format::{angles, error, escape, none, value};

pub(super) fn write(out: &mut String, report: &Report, exhibits: &Exhibits) {
    out.push_str(
        "<h2 id=\"materials\">Materials</h2><p class=\"sub\">The section of a material has its pictures, costs, colour differences and worst pairs of directions. Its table gives the largest relative \
         error of f cos θᵢ in each set of directions, and below it the 99th percentile and the root mean square. <a href=\"#method\">Method</a> defines \
         the sets and the floors.</p>",
    );
    let mut drawn = summary::shown(report).to_vec();
    if report.device.is_some() {
        drawn.push(Compared::Arithmetic);
    }
    let series: Vec<_> = drawn.iter().map(|c| chart::series(*c)).collect();
    for (index, material) in report.materials.iter().enumerate() {
        let _ = write!(
            out,
            "<article{}><details class=\"fold\" id=\"{}\"><summary><h3>{}</h3><span class=\"sub\">class {}, {}</span><span \
             class=\"sub figures\">{}</span></summary><p class=\"sub\">{} · <code>{}</code> · SHA-256 \
             <code>{}</code><br/>{}</p>",
            of_material(&material.name),
            anchor(index),
            escape(&material.name),
            escape(&material.class),
            material.model.name(),
            escape(&glance::line(report, material)),
            color(material.color),
            escape(&material.source),
            escape(material.source_hash.get(..12).unwrap_or(&material.source_hash)),
            escape(&material.layers.join(" / "))
        );
        if let Some(gallery) = &exhibits.gallery {
            let name = escape(&material.name);
            let _ = write!(out, "<p><a href=\"{}#{name}\">{name} in the gallery</a></p>", escape(gallery));
        }
        pictures::write(out, material, exhibits.pictures.get(index).map_or(&[], Vec::as_slice));
        out.push_str("<div class=\"split\"><figure>");
        if report.device.is_some() {
            out.push_str(&legend(&series));
        }
        out.push_str(&chart::by_angle(material, &drawn, report.budget));
        out.push_str("</figure><div>");
        sets(out, material, report.budget);
        out.push_str("</div></div>");
        trade::of_material(out, report, material);
        seen(out, material);
        worst(out, material, report.device.is_some());
        out.push_str("</details></article>\n");
    }
}

/// Comparisons down, sets across.
fn sets(out: &mut String, material: &MaterialReport, budget: Option<f64>) {
    out.push_str("<div class=\"scroll\"><table><thead><tr><th></th>");
    for set in DirectionSet::ALL {
        let _ = write!(out, "<th class=\"n\">{}</th>", set.name());
    }
    out.push_str("</tr></thead><tbody>");
    for comparison in &material.comparisons {
        let judged = matches!(comparison.compared, Compared::BakedDevice | Compared::FullDevice);
        let _ = write!(out, "<tr><th>{}</th>", comparison.compared.name());
        for (_, statistics) in &comparison.sets {
            let max = statistics.max_error();
            let class = if judged && budget.is_some_and(|b| max > b) { "n over" } else { "n" };
            let ErrorSummary { p99, rms, .. } = statistics.relative;
            let _ =
                write!(out, "<td class=\"{class}\">{}<small>{} · {}</small></td>", error(max), error(p99), error(rms));
        }
        out.push_str("</tr>");
    }
    out.push_str("</tbody></table></div>");
}

/// Colour differences by light.
fn seen(out: &mut String, material: &MaterialReport) {
    out.push_str(
        "<details><summary>Colour differences (CIEDE2000)</summary><div class=\"scroll\"><table><thead><tr><th></th><th>light</th><th \
         class=\"n\">max</th><th class=\"n\">99%</th><th class=\"n\">mean</th><th class=\"n\">above 1</th><th>worst \
         pair</th></tr></thead><tbody>",
    );
    for comparison in &material.comparisons {
        for (i, seen) in comparison.seen.iter().enumerate() {
            out.push_str("<tr>");
            if i == 0 {
                let _ = write!(out, "<th rowspan=\"{}\">{}</th>", comparison.seen.len(), comparison.compared.name());
            }
            let _ = write!(out, "<td>{}</td>", seen.light.name());
            for value in [seen.max, seen.p99, seen.mean] {
                out.push_str(&cell(&error(value)));
            }
            out.push_str(&cell(&format!("{:.2} %", 100.0 * seen.above_one)));
            let at = seen.worst.map_or_else(none, |(wi, wo)| angles(wi, wo));
            let _ = write!(out, "<td>{at}</td></tr>");
        }
    }
    out.push_str("</tbody></table></div></details>");
}

/// Errors over other floors, and the worst pairs, of the judged comparisons.
fn worst(out: &mut String, material: &MaterialReport, with_device: bool) {
    let shown =
        if with_device { &[Compared::BakedDevice, Compared::FullDevice][..] } else { &[Compared::TablesEightBit] };
    out.push_str(
        "<details><summary>Other floors and worst directions</summary><div class=\"scroll\"><table><thead><tr><th></th><th>set</th><th class=\"n\">peak</th><th class=\"n\">max, \
         floor white/10</th>",
    );
    out.push_str(
        "<th class=\"n\">floor white/1000</th><th class=\"n\">floor peak/10</th><th class=\"n\">max \
         absolute</th><th>worst pair</th></tr></thead><tbody>",
    );
    for comparison in shown.iter().filter_map(|c| material.comparison(*c)) {
        for (i, (set, s)) in comparison.sets.iter().enumerate() {
            out.push_str("<tr>");
            if i == 0 {
                let _ = write!(out, "<th rowspan=\"{}\">{}</th>", comparison.sets.len(), comparison.compared.name());
            }
            let _ = write!(out, "<td>{}</td>", set.name());
            for value in [s.peak, s.relative.max, s.relative_dim.max, s.relative_peak.max, s.max_abs_err] {
                out.push_str(&cell(&error(value)));
            }
            let _ = write!(out, "<td>{}</td></tr>", pair(s));
        }
    }
    out.push_str("</tbody></table></div></details>");
}

fn pair(statistics: &Statistics) -> String {
    match (statistics.not_finite_at, &statistics.worst) {
        (Some((wi, wo)), _) => format!("{} values not finite, first at {}", statistics.not_finite, angles(wi, wo)),
        (None, Some(w)) => format!(
            "{}, {}: {}, reference {}",
            angles(w.wi, w.wo),
            ["R", "G", "B"].get(w.channel as usize).unwrap_or(&"?"),
            value(w.found),
            value(w.expected)
        ),
        (None, None) => none(),
    }
}

/// Colour mode of the tables of a material, in words.
fn color(color: ColorMode) -> &'static str {
    match color {
        ColorMode::Spectral => "spectral",
        ColorMode::ThreeWavelengths => "three wavelengths",
    }
}
