//! Verdict, and the errors of all materials side by side.

use std::fmt::Write;

use crate::judge::report::{Compared, Report, WorstCase};
use crate::pages::chart;
use crate::svg::legend;
use crate::text::format::{angles, error, escape, number, value};

use super::{anchor, cell, of_material};

/// The comparisons that the overview draws and lists.
pub(super) fn shown(report: &Report) -> &'static [Compared] {
    if report.device.is_some() {
        &[Compared::BakedDevice, Compared::TablesEightBit, Compared::FullDevice]
    } else {
        &[Compared::TablesEightBit, Compared::TablesExact]
    }
}

/// Title and verdict.
pub(super) fn head(out: &mut String, report: &Report) {
    out.push_str("<header><h1>Error report</h1><p class=\"sub\">");
    let mut facts = vec![format!("Baked by {}", escape(&report.generator))];
    facts.push(match &report.device {
        Some(device) => format!("run on {}", escape(device)),
        None => "no shader was run".to_owned(),
    });
    out.push_str(&facts.join(" · "));
    out.push_str(
        "</p><nav><a href=\"#levels\">Errors</a><a href=\"#materials-at-a-glance\">Side by side</a><a href=\"#trade\">Cost and \
         bytes</a><a href=\"#exceptions\">Exceptions</a><a href=\"#materials\">Materials</a><a href=\"#tables\">Tables</a><a \
         href=\"#stability\">Stability</a><a href=\"#method\">Method</a><a href=\"#provenance\">Provenance</a><label id=\"filter\" \
         hidden=\"\">Material <input type=\"search\"/></label></nav></header>\n",
    );
    verdict(out, report);
}

fn verdict(out: &mut String, report: &Report) {
    if let Some((class, words)) = broken_limits(report) {
        let _ = writeln!(out, "<section class=\"verdict{class}\"><p class=\"figure\">{words}</p></section>");
    }
    let max = report.max_error();
    let within = report.budget.map(|budget| max <= budget);
    let (class, words) = match (within, report.budget) {
        (Some(true), Some(budget)) => (" good", format!("Within the limit: {} of {}", error(max), error(budget))),
        (Some(false), Some(budget)) if max.is_finite() => {
            (" bad", format!("Over the limit: {} of {}", error(max), error(budget)))
        }
        (Some(false), _) => (" bad", "Over the limit: some values are not finite".to_owned()),
        _ if max.is_finite() => ("", format!("Largest error {}", error(max))),
        _ => (" bad", "Some values are not finite".to_owned()),
    };
    let judged = if report.device.is_some() {
        "the emitted shaders (with and without tables) against their references in f64"
    } else {
        "the tables, read with 8-bit weights and f64 arithmetic, against exact terms, because no shader was run"
    };
    let _ = writeln!(
        out,
        "<section class=\"verdict{class}\"><p class=\"figure\">{}</p><p>This is the largest error of f cos θᵢ over all materials, directions and \
         channels. It compares {judged}. It is relative to the brightest channel of the reference, or to {} where that is larger.{}</p></section>",
        escape(&words),
        number(report.floor),
        report.worst().map_or(String::new(), |worst| at(&worst))
    );
}

/// Class and words of the verdict on the other limits; `None` without other limits.
fn broken_limits(report: &Report) -> Option<(&'static str, String)> {
    let broken: Vec<String> = report.limits.iter().filter(|l| !l.is_held).map(|l| escape(&l.quantity)).collect();
    match (report.limits.len(), broken.len()) {
        (0, _) => None,
        (all, 0) => Some((" good", format!("All {all} limits are held"))),
        (all, _) => Some((" bad", format!("{} of {all} limits are broken: {}", broken.len(), broken.join("; ")))),
    }
}

/// Place of the largest error, in words.
fn at(worst: &WorstCase<'_>) -> String {
    let place = format!("{}, {}, {} set", worst.material, worst.compared.name(), worst.set.name());
    match (worst.statistics.not_finite_at, &worst.statistics.worst) {
        (Some((wi, wo)), _) => {
            format!(" It is at {}: {}.", escape(&place), angles(wi, wo))
        }
        (None, Some(pair)) => format!(
            " It is at {}: {}, where the value is {} and the reference {}.",
            escape(&place),
            angles(pair.wi, pair.wo),
            value(pair.found),
            value(pair.expected)
        ),
        (None, None) => String::new(),
    }
}

fn figures(out: &mut String, report: &Report) {
    let judged: Vec<Compared> = match report.device {
        Some(_) => vec![Compared::BakedDevice, Compared::FullDevice],
        None => vec![Compared::TablesEightBit],
    };
    let mut facts = Vec::new();
    for compared in judged {
        let max =
            report.materials.iter().filter_map(|m| m.comparison(compared)).map(|c| c.max_error()).fold(0.0, f64::max);
        facts.push((compared.name(), error(max)));
    }
    if let Some(arithmetic) = report.max_arithmetic_error() {
        facts.push(("arithmetic of both", error(arithmetic)));
    }
    out.push_str("<dl class=\"facts\">");
    for (name, value) in facts {
        let _ = write!(out, "<div><dt>{}</dt><dd>{}</dd></div>", escape(name), escape(&value));
    }
    out.push_str("</dl>\n");
}

/// The errors of all materials side by side.
pub(super) fn overview(out: &mut String, report: &Report) {
    let shown = shown(report);
    let series: Vec<_> = shown.iter().map(|c| chart::series(*c)).collect();
    super::fold(
        out,
        "materials-at-a-glance",
        "Errors side by side",
        "all comparisons, the share of large errors, and the bytes of each table",
    );
    figures(out, report);
    out.push_str("<figure>");
    out.push_str(&legend(&series));
    out.push_str(&chart::max_by_material(report, shown));
    out.push_str(if report.device.is_some() {
        "<figcaption>Where ring and diamond coincide, the tables cause the error. Where the ring lies to the right of the diamond, \
         f32 arithmetic causes it. The square is the shader without tables: its error is that of arithmetic alone, at three wavelengths. Errors of \
         zero have no mark.</figcaption></figure>\n"
    } else {
        "<figcaption>Both marks are errors of the tables alone, and differ by the precision of the sampler's \
         weights. Errors of zero have no mark.</figcaption></figure>\n"
    });
    out.push_str("<div class=\"pair\"><figure>");
    out.push_str(&chart::exceedance(report, shown));
    out.push_str(
        "<figcaption>The curves give the share of all samples whose error exceeds the value on the x axis. All materials and \
         sets have equal weight. The colours are those of the chart above.</figcaption></figure><figure>",
    );
    out.push_str(&chart::bytes_by_table(&report.tables));
    out.push_str(
        "<figcaption>Uncompressed bytes of the tables; they serve all materials \
         together.</figcaption></figure></div>\n",
    );
    rows(out, report, shown);
    super::end_fold(out);
}

fn rows(out: &mut String, report: &Report, shown: &[Compared]) {
    let mut columns = shown.to_vec();
    if report.device.is_some() {
        columns.push(Compared::Arithmetic);
    }
    columns.push(Compared::ThreeWavelengths);
    out.push_str("<div class=\"scroll\"><table class=\"sortable\"><thead><tr><th>material</th><th>class</th><th class=\"n\">layers</th>");
    for compared in &columns {
        let _ = write!(out, "<th class=\"n\">{}</th>", compared.name());
    }
    out.push_str("</tr></thead><tbody>");
    for (index, material) in report.materials.iter().enumerate() {
        let _ = write!(
            out,
            "<tr{}><th><a href=\"#{}\">{}</a></th><td>{}</td><td class=\"n\">{}</td>",
            of_material(&material.name),
            anchor(index),
            escape(&material.name),
            escape(&material.class),
            material.layers.len()
        );
        for &compared in &columns {
            let value = material.comparison(compared).map(|c| c.max_error());
            let judged = compared.is_judged(report.device.is_some());
            let over = judged && value.zip(report.budget).is_some_and(|(value, budget)| value > budget);
            match value {
                Some(value) if over => {
                    let _ = write!(out, "<td class=\"n over\">{}</td>", error(value));
                }
                Some(value) => out.push_str(&cell(&error(value))),
                None => out.push_str(&cell("–")),
            }
        }
        out.push_str("</tr>");
    }
    out.push_str(
        "</tbody></table></div><p class=\"note\">Largest relative errors over all sets of directions. “Three \
         wavelengths” is not an error of the bake: it is the difference between the model at three wavelengths and the spectral one, both in \
         f64. All errors are relative to the brightest channel of the reference, or to the floor where that is larger.</p>\n",
    );
}
