//! The tables: size, format and axes, and the error of every tile.

use std::fmt::Write;

use luthier_lut::{ErrorStats, TableKind};

use super::cell;
use crate::judge::report::Report;
use crate::measure::scan::report::{AlphaPoint, Curves, TableReport, TileReport};
use crate::measure::scan::{DOMAIN_ALPHA, DOMAIN_COS_THETA, REPEATS, points};
use crate::measure::statistics::TARGET_MAX_REL_ERR;
use crate::pages::chart;
use crate::text::format::{axis, bytes, error, escape, none, number, uncertain};

pub(super) fn write(out: &mut String, report: &Report) {
    let total: u64 = report.tables.iter().map(|t| t.texel_bytes).sum();
    let says = format!("{} of {}, and the error of every tile", report.tables.len(), bytes(total));
    super::fold(out, "tables", "Tables", &says);
    list(out, report);
    super::end_fold(out);
}

fn list(out: &mut String, report: &Report) {
    if report.tables.is_empty() {
        out.push_str("<p>None: no material of this bake needs one.</p>\n");
        return;
    }
    out.push_str(
        "<div class=\"scroll\"><table class=\"sortable\"><thead><tr><th>table</th><th class=\"n\">texels</th><th>format</th><th \
         class=\"n\">bytes</th>",
    );
    out.push_str("<th class=\"n\">tiles</th><th>axes</th><th>file</th></tr></thead><tbody>");
    for table in &report.tables {
        let mut axes = escape(&axis(&table.layout.x));
        if let Some(y) = &table.layout.y {
            axes.push_str("<br/>");
            axes.push_str(&escape(&axis(y)));
        }
        let [width, height] = table.size;
        let _ = write!(
            out,
            "<tr><th><a href=\"#table-{0}\">{0}</a></th><td class=\"n\">{width} × {height}</td><td>{1}</td><td \
             class=\"n\" data-v=\"{5}\">{2}</td><td class=\"n\">{3}</td><td>{axes}</td><td><code>{4}</code></td></tr>",
            table.kind.name(),
            table.format,
            bytes(table.texel_bytes),
            table.tiles.len(),
            escape(&table.path),
            table.texel_bytes
        );
    }
    out.push_str("</tbody></table></div>\n");
    for table in &report.tables {
        section(out, table, points(report.pairs_per_set));
    }
}

fn section(out: &mut String, table: &TableReport, points: u32) {
    let _ = write!(out, "<h3 id=\"table-{0}\">{0}</h3>", table.kind.name());
    let _ = write!(out, "<p>{}</p>", table.kind.facts().holds);
    reflectances(out, table);
    alphas(out, table);
    out.push_str(
        "<div class=\"scroll\"><table><thead><tr><th>tile</th><th>read by</th><th>measured</th><th \
         class=\"n\">max</th><th class=\"n\">99%</th>",
    );
    out.push_str("<th class=\"n\">rms</th><th class=\"n\">points</th><th>worst at</th></tr></thead><tbody>");
    for tile in &table.tiles {
        let rows = if tile.judge.is_some() { 2 } else { 1 };
        let _ = write!(
            out,
            "<tr><th rowspan=\"{rows}\">{}<small>{}</small></th><td rowspan=\"{rows}\">{}</td>",
            escape(&tile.name),
            escape(&tile.model),
            users(tile)
        );
        match &tile.judge {
            Some(judge) => {
                stats(out, "here", judge, tile.uncertainty, table);
                out.push_str("</tr><tr>");
                stats(out, "by the baker", &tile.baker, None, table);
            }
            None => stats(out, "by the baker", &tile.baker, None, table),
        }
        out.push_str("</tr>");
    }
    let _ = writeln!(
        out,
        "</tbody></table></div><p class=\"note\">Absolute errors of a sampled read: quantised texels, bilinear, at nodes \
         and between them. {}</p>",
        escape(&how(table, points))
    );
}

/// Origin and meaning of the figures of a table, in words.
fn how(table: &TableReport, points: u32) -> String {
    let here = "“Here” is this report's own scan of the shipped texels at other points, without local refinement; a \
                baker's maximum, which is refined, should not be smaller.";
    match table.kind {
        TableKind::Fgd => {
            let measured: Vec<_> = table.tiles.iter().filter_map(|t| t.judge.as_ref()).collect();
            let within = measured.iter().filter(|j| j.max_abs_err <= TARGET_MAX_REL_ERR).count();
            format!(
                "“Here” is an independent estimate at {points} points with cos θ from {DOMAIN_COS_THETA} and α from \
                 {DOMAIN_ALPHA}: exact quadrature of the first bounce, walks for the others, light that crosses and \
                 returns followed at every wavelength; ± is the standard error of {REPEATS} repetitions at the worst \
                 point. {within} of {} tiles are within {}.",
                measured.len(),
                number(TARGET_MAX_REL_ERR)
            )
        }
        TableKind::Thickness => {
            "“Here” is the map of the material file, evaluated anew between nodes and at nodes: thickness over twice the largest one, slopes, and the factor that normalises them. The \
             range of the film and that factor are checked in every texel, too; what does not fit is a finding."
                .to_owned()
        }
        _ => here.to_owned(),
    }
}

fn users(tile: &TileReport) -> String {
    if tile.users.is_empty() {
        return none();
    }
    const SHOWN: usize = 3;
    let mut text = escape(&tile.users.iter().take(SHOWN).cloned().collect::<Vec<_>>().join(", "));
    if tile.users.len() > SHOWN {
        let _ = write!(text, " and {} more", tile.users.len() - SHOWN);
    }
    text
}

fn stats(out: &mut String, by: &str, stats: &ErrorStats, uncertainty: Option<f64>, table: &TableReport) {
    let _ = write!(out, "<td class=\"by\">{by}</td>");
    let over = table.kind == TableKind::Fgd && stats.max_abs_err > TARGET_MAX_REL_ERR;
    let class = if over { "n over" } else { "n" };
    let _ = write!(out, "<td class=\"{class}\">{}</td>", uncertain(stats.max_abs_err, uncertainty));
    for value in [stats.p99_abs_err, stats.rms_err] {
        out.push_str(&cell(&error(value)));
    }
    out.push_str(&cell(&stats.points.to_string()));
    let quantities = [Some(&table.layout.x), table.layout.y.as_ref()].into_iter().flatten();
    let at: Vec<String> =
        quantities.zip(&stats.worst.at).map(|(axis, v)| format!("{} {}", axis.quantity, number(*v))).collect();
    let channel = if table.format.channels() > 1 {
        ["R", "G", "B", "A"].get(stats.worst.channel as usize).map_or(String::new(), |c| format!(" ({c})"))
    } else {
        String::new()
    };
    let _ = write!(
        out,
        "<td>{}{channel}: {}, read {}",
        escape(&at.join(", ")),
        number(stats.worst.expected),
        number(stats.worst.sampled)
    );
    if stats.slack > 0.0 {
        let _ = write!(out, "<small>of the error, slack of the function itself: {}</small>", error(stats.slack));
    }
    out.push_str("</td>");
}

fn reflectances(out: &mut String, table: &TableReport) {
    let rows = table.tiles.iter().filter_map(|tile| match &tile.curves {
        Curves::Reflectance(curve) => Some((tile, curve)),
        Curves::ByAlpha(_) | Curves::None => None,
    });
    let mut figures = String::new();
    for (tile, curve) in rows {
        let max = tile
            .judge
            .as_ref()
            .map_or_else(|| "not measured".to_owned(), |j| format!("max error {}", error(j.max_abs_err)));
        let _ = write!(
            figures,
            "<figure>{}<figcaption><b>{}</b><br/>{max}</figcaption></figure>",
            chart::reflectance(&tile.name, curve),
            escape(&tile.name)
        );
    }
    if !figures.is_empty() {
        let _ = write!(
            out,
            "<div class=\"many\">{figures}</div><p class=\"note\">Every row as a shader reads it: reflectance (red \
             solid, green dashed, blue dotted) over the angle in degrees. Rows of dielectrics lie low and rise \
             steeply past 60°; metals start high and keep their colour until they whiten at 90°.</p>"
        );
    }
}

fn alphas(out: &mut String, table: &TableReport) {
    let curves: Vec<(&str, &[AlphaPoint])> = table
        .tiles
        .iter()
        .filter_map(|tile| match &tile.curves {
            Curves::ByAlpha(points) => Some((tile.name.as_str(), points.as_slice())),
            Curves::Reflectance(_) | Curves::None => None,
        })
        .collect();
    if !curves.is_empty() {
        let _ = write!(
            out,
            "<figure style=\"max-width: 600px\">{}<figcaption>What a sharp lobe loses: the largest error at each \
             alpha relative to the peak of the distribution there. A curve that rises to the left says that the \
             table has too few nodes for small alpha.</figcaption></figure>",
            chart::error_by_alpha(&curves)
        );
    }
}
