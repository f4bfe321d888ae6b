//! The report in a few lines of Markdown.

use std::fmt::Write;

use crate::judge::report::{Compared, Report};
use crate::measure::seen::SeenLight;
use crate::places::SimulatedAt;
use crate::stability::Level;
use crate::text::format::{bytes, error, none, number};

/// Findings listed by name.
const SHOWN: usize = 10;

/// The summary.
pub(crate) fn markdown(report: &Report) -> String {
    let mut out = String::from("# Error report\n\n");
    let verdict = match report.is_within_budget() {
        Some(true) => "**All limits are held.** ",
        Some(false) => "**A limit is broken.** ",
        None => "No limit was stated. ",
    };
    out.push_str(verdict);
    let on = report.device.as_ref().map_or_else(|| "tables only".to_owned(), |device| format!("on {device}"));
    let total: u64 = report.tables.iter().map(|t| t.texel_bytes).sum();
    let _ = writeln!(
        out,
        "{}, {} ({}), {}, {on}.\n",
        report.generator,
        count(report.tables.len(), "table"),
        bytes(total),
        count(report.materials.len(), "material")
    );
    limits(&mut out, report);
    levels(&mut out, report);
    materials(&mut out, report);
    places(&mut out, report);
    stability(&mut out, report);
    if let Some(s) = &report.stability {
        let _ = writeln!(
            out,
            "The suite of stability: {} cells, {} hold, {} degrade, {} fail, {} unexplained, {} not finite.\n",
            s.cells, s.holds, s.degrades, s.fails, s.unexplained, s.not_finite
        );
    }
    if report.findings.is_empty() {
        out.push_str("No findings.\n");
    } else {
        let _ = writeln!(out, "{}:\n", count(report.findings.len(), "finding"));
        report.findings.iter().take(SHOWN).for_each(|f| out.push_str(&format!("- {f}\n")));
        if report.findings.len() > SHOWN {
            let _ = writeln!(out, "- and {} more, see the page", report.findings.len() - SHOWN);
        }
    }
    if !report.provenance.is_empty() {
        let facts: Vec<String> = report.provenance.iter().map(|(name, value)| format!("{name} `{value}`")).collect();
        let _ = writeln!(out, "\n{}", facts.join(", "));
    }
    out
}

fn count(n: usize, word: &str) -> String {
    format!("{n} {word}{}", if n == 1 { "" } else { "s" })
}

fn verdict(is_held: bool) -> &'static str {
    if is_held { "held" } else { "**broken**" }
}

fn limits(out: &mut String, report: &Report) {
    if report.budget.is_none() && report.limits.is_empty() {
        return;
    }
    out.push_str("| limit | stated by | at most | found | |\n|---|---|--:|--:|---|\n");
    if let Some(budget) = report.budget {
        let max = report.max_error();
        let held = verdict(max <= budget);
        let _ = writeln!(
            out,
            "| shaders: largest relative error | command line | {} | {} | {held} |",
            error(budget),
            error(max)
        );
    }
    for limit in &report.limits {
        let found = limit.found.map_or_else(none, error);
        let (quantity, by) = (line(&limit.quantity), line(&limit.stated_by));
        let _ = writeln!(out, "| {quantity} | {by} | {} | {found} | {} |", error(limit.limit), verdict(limit.is_held));
    }
    out.push('\n');
}

fn levels(out: &mut String, report: &Report) {
    out.push_str("| level | unit | largest | where |\n|---|---|--:|---|\n");
    if let Some((found, kind, tile)) = report.worst_table() {
        let _ = writeln!(
            out,
            "| 1 table against function | absolute | {} | {}, {} |",
            error(found),
            kind.name(),
            line(tile)
        );
    }
    let level = if report.device.is_some() { "2 shader against model" } else { "2 tables against model" };
    if let Some(worst) = report.worst() {
        let (unit, place) = (format!("relative, floor {}", number(report.floor)), line(worst.material));
        let _ = writeln!(out, "| {level} | {unit} | {} | {place}, {} |", error(worst.error), worst.compared.name());
    }
    if let Some((found, material)) = report.worst_seen(SeenLight::Daylight) {
        let _ = writeln!(out, "| {level} | CIEDE2000, daylight | {} | {} |", error(found), line(material));
    }
    if let Some((material, model)) = report.worst_model() {
        let place = format!("{}, {}", line(material), model.model.name());
        let _ = writeln!(
            out,
            "| 3 model against reference | share of light in other directions | {} | {place} |",
            error(model.lobe_err)
        );
    }
    out.push('\n');
}

fn materials(out: &mut String, report: &Report) {
    let with_device = report.device.is_some();
    let compared = if with_device { Compared::BakedDevice } else { Compared::TablesEightBit };
    let _ = writeln!(
        out,
        "| material | model | {} | CIEDE2000 | FLIP | against reference |\n|---|---|--:|--:|--:|--:|",
        compared.name()
    );
    for m in &report.materials {
        let comparison = m.comparison(compared);
        let seen = comparison.and_then(|c| c.seen.iter().find(|s| s.light == SeenLight::Daylight));
        let lobe = m.against_reference.iter().find(|a| a.model == m.model);
        let _ = writeln!(
            out,
            "| {} | {} | {} | {} | {} | {} |",
            line(&m.name),
            m.model.name(),
            comparison.map_or_else(none, |c| error(c.max_error())),
            seen.map_or_else(none, |s| error(s.max)),
            m.picture.as_ref().map_or_else(none, |p| error(p.flip_mean)),
            lobe.map_or_else(none, |a| error(a.lobe_err))
        );
    }
    out.push('\n');
}

/// Materials that vary, at random places.
fn places(out: &mut String, report: &Report) {
    let mut at = report.materials.iter().filter_map(|m| Some((m, m.at_places.as_ref()?))).peekable();
    if at.peek().is_none() {
        return;
    }
    out.push_str(
        "| at random places | varies | shader against f64 on its tables | tables against exact terms | lobes: lobe error | albedo | grazing light |\n\
         |---|---|--:|--:|--:|--:|--:|\n",
    );
    let of_simulated: [fn(&SimulatedAt) -> [f64; 2]; 3] = [|view| view.lobe, |view| view.albedo, |view| view.grazing];
    for (material, at) in at {
        let [shader, tables] =
            [&at.shader, &at.tables].map(|errors| errors.as_ref().map_or_else(none, |e| error(e.max_error())));
        let simulated = of_simulated.map(|of| {
            at.simulated.as_ref().map_or_else(none, |s| {
                let [found, noise] = s.worst(of);
                format!("{found:.3} ± {noise:.3}")
            })
        });
        let _ = writeln!(
            out,
            "| {} | {} | {shader} | {tables} | {} |",
            line(&material.name),
            at.varies.join(", "),
            simulated.join(" | ")
        );
    }
    out.push('\n');
}

/// Tables and shaders at the directions where methods fail, the worst of all materials.
fn stability(out: &mut String, report: &Report) {
    let all = || report.materials.iter().filter_map(|m| Some((m, m.stability.as_ref()?)));
    if all().next().is_none() {
        return;
    }
    out.push_str(
        "| where methods fail | values | not finite | negative | largest error | f32 arithmetic | largest albedo |\n|---|--:|--:|--:|--:|--:|--:|\n",
    );
    for level in [Level::Table, Level::Device, Level::F32] {
        let here = || all().flat_map(|(m, s)| s.stressed.iter().map(move |s| (m, s))).filter(|(_, s)| s.level == level);
        let Some((material, worst)) = here().max_by(|a, b| a.1.error.total_cmp(&b.1.error)) else { continue };
        let values: u64 = here().map(|(_, s)| s.values).sum();
        let not_finite: u64 = here().map(|(_, s)| s.not_finite).sum();
        let negative = here().map(|(_, s)| s.negative).fold(0.0, f64::max);
        let arithmetic = if level == Level::F32 {
            Some(worst.error)
        } else {
            here().filter_map(|(_, s)| s.arithmetic).reduce(f64::max)
        };
        let albedos = all().flat_map(|(m, s)| s.albedos.iter().filter_map(move |a| Some((m, a, a.albedo?))));
        let albedo = albedos.filter(|(_, a, _)| a.level == level).max_by(|a, b| a.2.total_cmp(&b.2));
        let _ = writeln!(
            out,
            "| {} | {values} | {not_finite} | {} | {}, {} | {} | {} |",
            level.shipped_name(),
            error(negative),
            error(worst.error),
            line(&material.name),
            arithmetic.map_or_else(none, error),
            albedo.map_or_else(none, |(m, a, albedo)| format!("{albedo:.3} at {}°, {}", a.theta_deg, line(&m.name)))
        );
    }
    out.push('\n');
}

/// Text in a cell.
fn line(text: &str) -> String {
    text.replace('|', "\\|").replace('\n', " ")
}
