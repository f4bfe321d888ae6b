//! The three levels of error, side by side but never added up; then the limits.

use std::fmt::Write;

use super::cell;
use crate::judge::report::Report;
use crate::measure::seen::SeenLight;
use crate::text::format::{error, escape, none, number};

pub(super) fn write(out: &mut String, report: &Report) {
    out.push_str(
        "<h2 id=\"levels\">Three levels of error</h2><p>luthier measures errors at three levels. Each has its own reference and its own unit, so that no figure \
         below adds up levels or compares them.</p><div class=\"scroll\"><table><thead><tr><th>level</th><th>what is \
         compared</th><th>unit</th><th class=\"n\">largest</th><th>where</th></tr></thead><tbody>",
    );
    let mut row = |level: &str, what: &str, unit: &str, found: Option<(f64, String)>, missing: &str| {
        let (value, place) = found.map_or((none(), missing.to_owned()), |(v, p)| (error(v), p));
        let (place, value) = (escape(&place), cell(&value));
        let _ = write!(
            out,
            "<tr><th class=\"level\">{level}</th><td>{what}</td><td>{unit}</td>{value}<td>{place}</td></tr>"
        );
    };
    let table = report.worst_table().map(|(error, kind, tile)| (error, format!("{}, {tile}", kind.name())));
    let texels = "filtered reads of a table against the tabulated function";
    row("1 · table", texels, "absolute", table, "no table was measured");
    let of = if report.device.is_some() { "shaders on the device" } else { "tables in f64 arithmetic" };
    let worst =
        report.worst().map(|w| (w.error, format!("{}, {}, {} set", w.material, w.compared.name(), w.set.name())));
    let what = format!("{of} against their models in f64");
    let unit = format!("relative, floor {}", number(report.floor));
    row("2 · shader", &what, &unit, worst, "no material");
    for light in SeenLight::ALL {
        let seen = report.worst_seen(light).map(|(difference, material)| (difference, material.to_owned()));
        row("2 · shader, seen", &what, &format!("CIEDE2000, {}", light.name()), seen, "no material");
    }
    let pictures = report.materials.iter().filter_map(|m| Some((m.name.clone(), m.picture.as_ref()?)));
    let flip = pictures.clone().map(|(name, p)| (p.flip_mean, name)).max_by(|a, b| a.0.total_cmp(&b.0));
    let what = "pictures of the baked shader against those of the full one";
    row("2 · shader, seen", what, "mean FLIP", flip, "no pictures were made");
    let delta_e = pictures.map(|(name, p)| (p.delta_e_max, name)).max_by(|a, b| a.0.total_cmp(&b.0));
    row("2 · shader, seen", what, "CIEDE2000 of a pixel", delta_e, "no pictures were made");
    let model = report.worst_model();
    let what = report.reference.map_or_else(
        || "models against simulated paths (layered-mc)".to_owned(),
        |r| format!("the models of this bake against layered-mc, {} paths a view, seed {}", r.paths, r.seed),
    );
    let missing = "not measured; luthier report --reference measures it, and docs/pages/models.md has all models";
    let lobe = model.map(|(material, a)| {
        (
            a.lobe_err,
            format!(
                "{material}, {} at {}°; noise alone makes {}",
                a.model.name(),
                a.worst_theta_deg,
                error(a.lobe_noise)
            ),
        )
    });
    row("3 · model", &what, "share of the light in other directions", lobe, missing);
    let shipped = report.materials.iter().flat_map(|m| m.against_reference.iter().map(move |a| (m, a)));
    let shipped = shipped.filter(|(m, a)| m.model == a.model);
    let albedo = shipped.clone().map(|(m, a)| (a.albedo_err, format!("{}, ± {:.0e}", m.name, a.albedo_std_err)));
    row("3 · model", &what, "albedo, absolute", albedo.max_by(|a, b| a.0.total_cmp(&b.0)), missing);
    let seen = shipped.map(|(m, a)| (a.delta_e, m.name.clone())).max_by(|a, b| a.0.total_cmp(&b.0));
    row("3 · model, seen", &what, "CIEDE2000 of albedos, D65", seen, missing);
    out.push_str(
        "</tbody></table></div><p class=\"note\">CIEDE2000 compares colours as a display shows them: lit, and with each channel clipped to 0..1. Under “daylight” a white \
         diffuser is white. In highlights of saturated colour, far brighter than white, a small relative error can move a dark channel from \
         one end of the range to the other. The section of each material says how rare that is.</p>\n",
    );
    limits(out, report);
}

fn limits(out: &mut String, report: &Report) {
    if report.limits.is_empty() {
        return;
    }
    out.push_str(
        "<h3 id=\"limits\">Limits</h3><div class=\"scroll\"><table class=\"sortable\"><thead><tr><th>stated \
         by</th><th>quantity</th><th class=\"n\">limit</th><th class=\"n\">found</th><th>found by</th><th>verdict</th></tr></thead><tbody>",
    );
    for limit in &report.limits {
        let found = limit.found.map_or_else(|| "nothing to compare".to_owned(), error);
        let (class, verdict) = if limit.is_held { ("", "held") } else { (" class=\"over\"", "broken") };
        let _ = write!(
            out,
            "<tr><td>{}</td><td>{}</td>{}{}<td>{}</td><td{class}>{verdict}</td></tr>",
            escape(&limit.stated_by),
            escape(&limit.quantity),
            cell(&error(limit.limit)),
            cell(&found),
            escape(&limit.found_by)
        );
    }
    out.push_str("</tbody></table></div>\n");
}
