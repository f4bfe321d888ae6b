//! The section on provenance: commands, adapters and random numbers behind every figure.

use std::fmt::Write;

use crate::judge::report::Report;
use crate::text::format::escape;

pub(super) fn write(out: &mut String, report: &Report) {
    super::fold(out, "provenance", "Provenance", "the command, and the origin of every figure");
    out.push_str("<div class=\"scroll\"><table><tbody>");
    for (name, value) in &report.provenance {
        let _ = write!(out, "<tr><th>{}</th><td>{}</td></tr>", escape(name), escape(value));
    }
    out.push_str(
        "</tbody></table></div><div class=\"scroll\"><table><thead><tr><th>figures</th><th>measured by</th><th>on</th><th>random \
         numbers</th></tr></thead><tbody>",
    );
    let device = report.device.as_deref().unwrap_or("no device");
    let host = "the host, f64";
    row(out, ["tables, “here”", "this run", host, "none; albedos: a fixed sequence per point"]);
    row(out, ["tables, “by the baker”; searches", &report.generator, host, "fixed by texel and sample number"]);
    row(
        out,
        ["shaders, colour differences", "this run", device, "Halton sequence of directions, the same in every run"],
    );
    if report.materials.iter().any(|m| m.picture.is_some()) {
        row(out, ["pictures, FLIP", "this run", device, "directions of the environment, the same in every run"]);
    }
    if let Some(paths) = report.reference {
        let random = format!("{} paths a view and wavelength, seed {}", paths.paths, paths.seed);
        row(out, ["models against the reference", "this run", host, &random]);
    }
    if let Some(costs) = &report.costs {
        row(out, ["costs", &costs.generator, &format!("no GPU: {}", costs.driver), "none"]);
    }
    if let Some(stability) = &report.stability {
        let adapter = stability.device.as_deref().unwrap_or("no adapter");
        row(out, ["stability", &stability.generator, adapter, "fixed by case"]);
    }
    out.push_str(
        "</tbody></table></div><details><summary>Sources</summary><div class=\"scroll\"><table class=\"sortable\"><thead><tr><th>material</th><th>file</th><th>SHA-256 of the file \
         and of the files that it names</th></tr></thead><tbody>",
    );
    for m in &report.materials {
        let [name, source, hash] = [&m.name, &m.source, &m.source_hash].map(|t| escape(t));
        let of = super::of_material(&m.name);
        let _ = write!(
            out,
            "<tr{of}><th>{name}</th><td><code>{source}</code></td><td><code class=\"hash\">{hash}</code></td></tr>"
        );
    }
    out.push_str("</tbody></table></div></details>\n");
    super::end_fold(out);
}

fn row(out: &mut String, cells: [&str; 4]) {
    let [figures, by, on, random] = cells.map(escape);
    let _ = write!(out, "<tr><th>{figures}</th><td>{by}</td><td>{on}</td><td>{random}</td></tr>");
}
