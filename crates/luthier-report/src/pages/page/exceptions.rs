//! Samples that miss the target, and their causes.

use std::fmt::Write;

use super::{anchor, cell, of_material};
use crate::judge::exceptions::Exception;
use crate::judge::report::Report;
use crate::measure::causes::{Cause, Factor, Part};
use crate::text::format::{angles, error, escape, none, number, rounded, value};

pub(super) fn write(out: &mut String, report: &Report) {
    let target = number(report.target_max_rel_err);
    let says = match report.exceptions.len() {
        0 => format!("none: every comparison meets the target of {target}"),
        count => format!("{count} comparisons miss the target of {target}, each with its cause"),
    };
    super::fold(out, "exceptions", "Exceptions", &says);
    list(out, report);
    super::end_fold(out);
}

fn list(out: &mut String, report: &Report) {
    let comparisons = report.materials.iter().flat_map(|m| report.judged(m));
    let target = number(report.target_max_rel_err);
    let floor = number(report.floor);
    let of = if report.device.is_some() { "materials × shaders" } else { "materials" };
    let all = comparisons.clone().count();
    if report.exceptions.is_empty() {
        let _ = writeln!(
            out,
            "<p>None: no finite sample of the {all} {of} is further than {target} from its reference, relative to \
             the brightest channel of the reference, or to {floor} where that is larger.</p>"
        );
        return;
    }
    let samples: u64 = comparisons.flat_map(|c| &c.sets).map(|(_, s)| 3 * s.pairs - s.not_finite).sum();
    let above: u64 = report.exceptions.iter().map(|e| e.samples_above).sum();
    let _ = write!(
        out,
        "<p>The target is a largest error of {target}, relative to the brightest channel of the reference, or to {floor} where that is larger. {} of \
         {all} {of} miss it somewhere. Together they miss it in {} of all samples ({above} of {samples}).</p>",
        report.exceptions.len(),
        share(above, samples)
    );
    out.push_str(
        "<div class=\"scroll\"><table class=\"exceptions sortable\"><thead><tr><th>material</th><th class=\"n\">max</th><th \
         class=\"n\">above target</th><th>worst pair</th><th>cause</th></tr></thead><tbody>",
    );
    for exception in &report.exceptions {
        row(out, report, exception);
    }
    out.push_str(
        "</tbody></table></div><p class=\"note\">“Beyond” gives an angle: each pair above the target has a direction at least so far from the normal. Causes are measured. The f64 model is evaluated with one factor \
         read from the tables and all others exact, for each factor in turn, and f32 arithmetic is measured by itself. The factor with the largest error is the cause. \
         One error may exceed the total where another cancels part of it. The last words of a row say which factors cause the errors of the other pairs above the \
         target.</p>\n",
    );
}

fn row(out: &mut String, report: &Report, exception: &Exception) {
    let Exception { material, compared, worst, .. } = exception;
    let index = report.materials.iter().position(|m| m.name == *material).unwrap_or_default();
    let _ = write!(
        out,
        "<tr{}><th><a href=\"#{}\">{}</a><small>{}</small></th>",
        of_material(material),
        anchor(index),
        escape(material),
        compared.name()
    );
    out.push_str(&cell(&error(worst.error)));
    let _ = write!(
        out,
        "<td class=\"n\">{}<small>beyond {:.1}°</small></td>",
        share(exception.samples_above, exception.samples),
        exception.least_angle_deg
    );
    let _ = write!(
        out,
        "<td>{}<small>{}, {}: {}, reference {}</small></td>",
        angles(worst.wi, worst.wo),
        exception.set.name(),
        ["R", "G", "B"].get(worst.channel as usize).unwrap_or(&"?"),
        value(worst.found),
        value(worst.expected)
    );
    let Some((first, rest)) = exception.parts.split_first() else {
        out.push_str("<td>–</td></tr>");
        return;
    };
    let mut small = format!("by itself {}", error(first.rel_err.abs()));
    if let Some(next) = rest.first() {
        let _ = write!(small, ", {} {}", short(next), error(next.rel_err.abs()));
    }
    let _ = write!(small, " · {}", tally(&exception.tally));
    let _ = write!(out, "<td>{}<small>{}</small></td></tr>", escape(&first.cause.words()), escape(&small));
}

fn short(part: &Part) -> String {
    match &part.cause {
        Cause::Fresnel { layer, .. } => format!("Fresnel of layer {layer}"),
        Cause::Distribution { layer, .. } => format!("distribution of layer {layer}"),
        Cause::Phase { layer, .. } => format!("phase of layer {layer}"),
        Cause::Fgd { layer, .. } => format!("albedo of layer {layer}"),
        Cause::Escape { layer, .. } => format!("escape from layer {layer}"),
        Cause::Veil { .. } => "internal reflectance".to_owned(),
        Cause::Lobes { .. } => "rows of lobes".to_owned(),
        Cause::Arithmetic => "arithmetic".to_owned(),
    }
}

/// The factors that cause the misses, in words.
fn tally(tally: &[(Factor, u64)]) -> String {
    let total: u64 = tally.iter().map(|(_, count)| count).sum();
    match tally {
        [] => "no pair was examined".to_owned(),
        [(factor, _)] => format!("all pairs above the target: {}", factor.name()),
        several => {
            let each = several.iter().map(|(factor, count)| format!("{} {}", factor.name(), share(*count, total)));
            format!("pairs above the target: {}", each.collect::<Vec<_>>().join(", "))
        }
    }
}

/// A percentage in two significant digits.
fn share(part: u64, whole: u64) -> String {
    if whole == 0 {
        return none();
    }
    format!("{}\u{a0}%", number(rounded(100.0 * part as f64 / whole as f64, 2)))
}
