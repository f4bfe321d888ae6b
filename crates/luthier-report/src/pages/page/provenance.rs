//! The section on provenance: commands, adapters and random numbers behind every figure.

use std::fmt::Write;

use luthier_manifest::Target;

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
    if let Some(times) = &report.times {
        let clock = format!("{}, clock of the {}", times.device, times.clock);
        row(out, ["times", "this run", &clock, "none; times differ from run to run"]);
    }
    out.push_str("</tbody></table></div>");
    shaders(out, report);
    out.push_str(
        "<details><summary>Sources</summary><div class=\"scroll\"><table class=\"sortable\"><thead><tr><th>material</th><th>file</th><th>SHA-256 of the file \
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

/// The shaders, with the judges that each passed when it was emitted.
fn shaders(out: &mut String, report: &Report) {
    if report.shaders.is_empty() {
        return;
    }
    out.push_str(
        "<h3 id=\"shaders\">Shaders</h3><div class=\"scroll\"><table><thead><tr><th>file</th><th>language</th><th>form</th><th>passed when it was emitted</th><th>ran in this \
         report</th></tr></thead><tbody>",
    );
    for shader in &report.shaders {
        let checks = shader.checks.iter().map(|check| {
            let of = if check.is_of_text(shader.target) {
                "this text".to_owned()
            } else {
                format!("the {} that it was translated from", check.read)
            };
            let capabilities = match check.capabilities.as_deref() {
                None => String::new(),
                Some([]) => ", no capability beyond core WebGPU".to_owned(),
                Some(all) => format!(", with {}", all.join(", ")),
            };
            format!("{} on {of}{capabilities}", check.by)
        });
        let checks: Vec<String> = checks.collect();
        let checks = if checks.is_empty() { "not in the manifest".to_owned() } else { checks.join("; ") };
        let ran = if report.device.is_some() && shader.target == Target::Wgsl { "yes" } else { "no" };
        let _ = write!(
            out,
            "<tr><td><code>{}</code></td><td>{}</td><td>{}</td><td>{}</td><td>{ran}</td></tr>",
            escape(&shader.path),
            shader.target,
            shader.form,
            escape(&checks)
        );
    }
    out.push_str(
        "</tbody></table></div><p class=\"note\">naga reads WGSL here. No judge of this bake reads GLSL and SPIR-V themselves: glslang and spirv-val do in the tests of luthier, on shaders like these.</p>",
    );
}

fn row(out: &mut String, cells: [&str; 4]) {
    let [figures, by, on, random] = cells.map(escape);
    let _ = write!(out, "<tr><th>{figures}</th><td>{by}</td><td>{on}</td><td>{random}</td></tr>");
}
