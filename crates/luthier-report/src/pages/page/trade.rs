//! Charts of price against error: bytes and cost, by kind of table and by material.

use std::fmt::Write;

use luthier_lut::{Axis, RowBase, TableKind};
use luthier_manifest::{Budget, Candidate, CandidateForm, Form, MeasuredError, Search};

use super::cell;
use crate::judge::evidence::{Costs, ShaderCost};
use crate::judge::report::{Compared, MaterialReport, Report};
use crate::svg::{Choice, Mark, Price, Series, legend, pareto};
use crate::text::format::{axis, bytes, error, escape, none, number, rounded};

/// The instruction set in charts. Tables list all.
pub(super) const FAMILY: &str = "rdna2";

const CANDIDATE: Series = Series { class: "s-tables", name: "candidate of the search", mark: Mark::Diamond };
const SHIPS: Series =
    Series { class: "s-baked", name: "tables of this bake, as measured by the report", mark: Mark::Circle };
const BAKED: Series = Series { class: "s-tables", name: "model, baked", mark: Mark::Diamond };
const FULL: Series = Series { class: "s-full", name: "model, full", mark: Mark::Square };

/// All kinds of tables.
pub(super) fn write(out: &mut String, report: &Report) {
    let says = match report.searches.len() {
        0 => "the bake made no search".to_owned(),
        count => format!("candidates of the search for {count} kinds of tables, and its choices"),
    };
    super::fold(out, "trade", "Cost and bytes against error", &says);
    searches(out, report);
    times(out, report);
    super::end_fold(out);
}

/// Measured times of all shaders.
fn times(out: &mut String, report: &Report) {
    out.push_str("<h3 id=\"times\">Times</h3>");
    let Some(times) = &report.times else {
        out.push_str(
            "<p>None: <code>luthier report --times</code> times the shaders on the adapter, and names it.</p>\n",
        );
        return;
    };
    let kind = if times.is_software {
        "This adapter is a program on the CPU: the times compare shaders with each other there, and say nothing of a GPU."
    } else {
        "This adapter is a GPU."
    };
    let _ = write!(
        out,
        "<p>Nanoseconds per evaluation on {}, by the clock of the {}: median of {} runs of {} evaluations, less that of the same kernel without an evaluation; ± is the median \
         absolute deviation. {kind}</p><div class=\"scroll\"><table class=\"sortable\"><thead><tr><th>material</th><th class=\"n\">baked</th><th class=\"n\">full</th><th class=\"n\">full / \
         baked</th></tr></thead><tbody>",
        escape(&times.device),
        escape(&times.clock),
        times.repeats,
        times.evaluations
    );
    for material in &report.materials {
        let of = |form| times.rows.iter().find(|row| row.material == material.name && row.form == form);
        let [baked, full] = [Form::Baked, Form::Full].map(of);
        let cells = [baked, full].map(|row| {
            cell(&row.map_or_else(none, |row| {
                format!("{} ± {}", number(rounded(row.net_ns, 3)), number(rounded(row.mad_ns, 2)))
            }))
        });
        let ratio = baked.zip(full).map_or_else(none, |(baked, full)| number(rounded(full.net_ns / baked.net_ns, 3)));
        let of = super::of_material(&material.name);
        let _ = write!(out, "<tr{of}><th>{}</th>{}{}</tr>", escape(&material.name), cells.concat(), cell(&ratio));
    }
    out.push_str("</tbody></table></div>\n");
}

fn searches(out: &mut String, report: &Report) {
    if report.searches.is_empty() {
        out.push_str("<p>The sizes and formats of this bake are the fixed defaults, or those that its material files state.</p>\n");
        return;
    }
    out.push_str(
        "<p>The charts show the candidates that no other candidate beats in bytes, cost and error at once, over all materials. Their errors are absolute, of the worst \
         tile, as the bake measured them. A ring marks the choice of the search. Cost is an estimate in operations of one look-up. The sections of materials have the cycles \
         of whole shaders.</p>",
    );
    out.push_str(&legend(&[CANDIDATE, SHIPS]));
    for search in &report.searches {
        kind(out, report, search);
    }
}

fn kind(out: &mut String, report: &Report, search: &Search) {
    let name = search.kind.name();
    let _ = write!(
        out,
        "<h3 id=\"trade-{name}\">{name}</h3><p class=\"sub\">{} candidates measured; the budget asks for {}.</p>",
        search.measured,
        asked(&search.budget)
    );
    if let [only] = search.front.as_slice() {
        let Candidate { form, bytes: size, cost, error: found } = only;
        let _ = writeln!(
            out,
            "<p>One candidate beats all others, and the search chose it: {}, {}, cost {}, error {}.</p>",
            escape(&words(form)),
            bytes(*size),
            number(*cost),
            error(own_error(found))
        );
        return;
    }
    let has_lobes = has_lobe_errors(search);
    // The report measures texels of lobes, and no lobe errors.
    let ships = shipped(report, search.kind, None).filter(|_| !has_lobes);
    charts(out, search, ships, &format!("{name}, all materials"));
    let _ = write!(
        out,
        "<details class=\"long\"><summary>All {} candidates of the front</summary><div class=\"scroll\"><table class=\"sortable\"><thead><tr><th>candidate</th><th \
         class=\"n\">bytes</th><th class=\"n\">cost</th>{}<th>chosen</th></tr></thead><tbody>",
        search.front.len(),
        if has_lobes { heads(&["lobe error", "albedo error"]) } else { heads(&["max abs", "max rel", "CIEDE2000"]) }
    );
    for (i, candidate) in search.front.iter().enumerate() {
        let Candidate { form, bytes: size, cost, error: found } = candidate;
        let or_none = |found: Option<f64>| cell(&found.map_or_else(none, error));
        let errors = match has_lobes {
            true => or_none(found.lobe) + &or_none(found.albedo),
            false => cell(&error(found.max_abs)) + &cell(&error(found.max_rel)) + &or_none(found.delta_e),
        };
        let _ = write!(
            out,
            "<tr><td>{}</td><td class=\"n\" data-v=\"{size}\">{}</td>{}{errors}<td>{}</td></tr>",
            escape(&words(form)),
            bytes(*size),
            cell(&number(*cost)),
            if i == search.chosen { "yes" } else { "" }
        );
    }
    out.push_str("</tbody></table></div></details>\n");
}

fn heads(words: &[&str]) -> String {
    words.iter().map(|word| format!("<th class=\"n\">{word}</th>")).collect()
}

/// Whether a search is for lobes: they have errors of their own in place of absolute ones.
fn has_lobe_errors(search: &Search) -> bool {
    search.front.iter().any(|candidate| candidate.error.lobe.is_some())
}

/// The lobe error, or else the absolute one.
fn own_error(found: &MeasuredError) -> f64 {
    found.lobe.unwrap_or(found.max_abs)
}

/// Bytes and cost of a search against its errors, side by side.
fn charts(out: &mut String, search: &Search, ships: Option<(f64, f64)>, of: &str) {
    let has_lobes = has_lobe_errors(search);
    let limit = if has_lobes { search.budget.max_lobe_err } else { search.budget.max_abs };
    let limit = limit.map(|limit| (limit, "limit"));
    let y_title = if has_lobes { "lobe error" } else { "largest absolute error" };
    out.push_str("<div class=\"pair\">");
    for (price, x_title, by) in
        [(Price::Bytes, "bytes of texels", "bytes"), (Price::Cost, "estimated operations of one look-up", "cost")]
    {
        let choices = search.front.iter().enumerate().map(|(i, candidate)| Choice {
            price: if price == Price::Bytes { candidate.bytes as f64 } else { candidate.cost },
            error: own_error(&candidate.error),
            tip: format!(
                "{}: {}, cost {}, error {}",
                words(&candidate.form),
                bytes(candidate.bytes),
                number(candidate.cost),
                error(own_error(&candidate.error))
            ),
            label: "",
            series: CANDIDATE,
            is_chosen: i == search.chosen,
        });
        let mut choices: Vec<Choice> = choices.collect();
        if let (Price::Bytes, Some((size, found))) = (price, ships) {
            let tip = format!(
                "tables of this bake: {}, error as measured by the report {}",
                bytes(size as u64),
                error(found)
            );
            choices.push(Choice { price: size, error: found, tip, label: "", series: SHIPS, is_chosen: false });
        }
        let label = format!("{of}: {by} against error");
        let _ = write!(out, "<figure>{}</figure>", pareto(&label, price, [x_title, y_title], &choices, limit));
    }
    out.push_str("</div>");
}

/// Bytes of the tiles of a kind that a material reads (any material, if `None`), and their largest error as measured here.
fn shipped(report: &Report, kind: TableKind, material: Option<&str>) -> Option<(f64, f64)> {
    let table = report.tables.iter().find(|t| t.kind == kind)?;
    let read = table.tiles.iter().filter(|t| material.map_or(!t.users.is_empty(), |name| t.is_read_by(name)));
    let read: Vec<_> = read.collect();
    let found = read.iter().filter_map(|tile| Some(tile.judge.as_ref()?.max_abs_err)).reduce(f64::max)?;
    Some((table.texel_bytes as f64 * read.len() as f64 / table.tiles.len() as f64, found))
}

/// Writes the charts of one material: its tables if it is baked alone, and its models by cost.
pub(super) fn of_material(out: &mut String, report: &Report, material: &MaterialReport) {
    let alone: Vec<&Search> = material.alone.iter().filter(|s| s.front.len() > 1).collect();
    let costs = report.costs.as_ref().map_or(Vec::new(), |costs| of_shaders(report, material, costs));
    if !alone.is_empty() {
        out.push_str(&legend(&[CANDIDATE, SHIPS]));
    }
    for search in alone {
        let name = search.kind.name();
        let ships = shipped(report, search.kind, Some(&material.name));
        charts(out, search, ships, &format!("{}, {name} alone", material.name));
        let _ = write!(
            out,
            "<p class=\"note\">The chart shows the search for the table {name} if this material is baked alone; the ring is its choice. All materials of this bake share \
             one table. Its mark stands at the bytes of the tiles that this material reads.</p>"
        );
    }
    models(out, material, &costs);
    if let Some(choice) = &material.choice {
        out.push_str("<h4>Why this model</h4><table class=\"choice\"><tbody>");
        choice_rows(out, choice);
        out.push_str("</tbody></table>");
    }
}

/// A choice as the manifest states it, name by name.
fn choice_rows(out: &mut String, choice: &serde_json::Value) {
    match choice.as_object() {
        Some(members) => {
            for (name, value) in members {
                let _ = write!(
                    out,
                    "<tr><th>{}</th><td>{}</td></tr>",
                    escape(&name.replace('_', " ")),
                    escape(&text(value))
                );
            }
        }
        None => {
            let _ = write!(out, "<tr><td>{}</td></tr>", escape(&text(choice)));
        }
    }
}

/// A string without quotes; other JSON as it is.
fn text(value: &serde_json::Value) -> String {
    value.as_str().map_or_else(|| value.to_string(), str::to_owned)
}

/// The shader of a model and form, with its cycles per instruction set.
pub(super) struct Shader<'a> {
    pub(super) row: &'a ShaderCost,
    cycles: Vec<(&'a str, i64)>,
}

/// Shaders of a material whose numbers come from the buffer, with D as this bake has it.
pub(super) fn of_shaders<'a>(report: &Report, material: &MaterialReport, costs: &'a Costs) -> Vec<Shader<'a>> {
    let reads_d = report.tables.iter().any(|t| t.kind == TableKind::Distribution);
    let rows = costs.rows.iter().filter(|r| r.material == material.name && !r.constant);
    // A shader that reads no table of D is always listed as closed, even if the bake has such a table.
    let ours = rows.clone().filter(|r| {
        let key = (r.model, &r.form, &r.family);
        let has_other = rows.clone().any(|o| (o.model, &o.form, &o.family) == key && o.closed != r.closed);
        !has_other || r.closed != reads_d
    });
    let ours: Vec<&ShaderCost> = ours.collect();
    let shaders = ours.iter().filter(|r| r.family == FAMILY).map(|row| {
        let same = ours.iter().filter(|o| (o.model, &o.form) == (row.model, &row.form));
        Shader { row, cycles: same.map(|o| (o.family.as_str(), o.inverse_throughput)).collect() }
    });
    shaders.collect()
}

/// The models of a material: cost against error.
fn models(out: &mut String, material: &MaterialReport, shaders: &[Shader<'_>]) {
    let has_reference = !material.against_reference.is_empty();
    let choices = shaders.iter().filter_map(|Shader { row, .. }| {
        let found = if has_reference {
            material.against_reference.iter().find(|a| a.model == row.model)?.lobe_err
        } else if row.model == material.model {
            let compared = if row.form == "full" { Compared::FullDevice } else { Compared::BakedDevice };
            material.comparison(compared)?.max_error()
        } else {
            // Without the reference, errors are those of shaders against their model, and only the shaders of the model that ships were run.
            return None;
        };
        let is_chosen = row.model == material.model && row.form == "baked";
        let (series, label) = if row.form == "full" { (FULL, "") } else { (BAKED, row.model.name()) };
        let tip =
            format!("{}, {}: {} cycles, error {}", row.model.name(), row.form, row.inverse_throughput, error(found));
        Some(Choice { price: row.inverse_throughput as f64, error: found, tip, label, series, is_chosen })
    });
    let choices: Vec<Choice> = choices.collect();
    let (title, note) = if has_reference {
        (
            "share of the light in other directions",
            "The errors are those of the models against layered-mc. The errors of tables and arithmetic are shown above.",
        )
    } else {
        (
            "largest relative error",
            "The errors are those of the shaders against their model. luthier report --reference measures those of the models.",
        )
    };
    if !choices.is_empty() {
        let x_title = format!("cycles per wave of 64 threads, {FAMILY}, inverse throughput");
        let label = format!("{}: cost of models against error", material.name);
        let _ = write!(
            out,
            "{}<figure class=\"half\">{}<figcaption>{note} The ring marks the shader of this bake.</figcaption></figure>",
            legend(&[BAKED, FULL]),
            pareto(&label, Price::Cost, [&x_title, title], &choices, None)
        );
    }
    if has_reference {
        model_rows(out, material, shaders);
    }
}

fn model_rows(out: &mut String, material: &MaterialReport, shaders: &[Shader<'_>]) {
    out.push_str(
        "<details><summary>Models against the reference</summary><div class=\"scroll\"><table class=\"sortable\"><thead><tr><th>model</th><th \
         class=\"n\">lobe</th><th class=\"n\">noise alone</th><th class=\"n\">albedo</th><th class=\"n\">CIEDE2000</th>",
    );
    let angles = material.against_reference.first().map_or(&[][..], |a| &a.by_angle);
    for (theta_deg, _) in angles {
        let _ = write!(out, "<th class=\"n\">lobe at {theta_deg}°</th>");
    }
    out.push_str("<th>cycles, baked</th><th>cycles, full</th></tr></thead><tbody>");
    for a in &material.against_reference {
        let ships = if a.model == material.model { "<small>of this bake</small>" } else { "" };
        let _ = write!(out, "<tr><th>{}{ships}</th>", a.model.name());
        for value in
            [a.lobe_err, a.lobe_noise, a.albedo_err, a.delta_e].into_iter().chain(a.by_angle.iter().map(|p| p.1))
        {
            out.push_str(&cell(&error(value)));
        }
        for form in ["baked", "full"] {
            let shader = shaders.iter().find(|s| s.row.model == a.model && s.row.form == form);
            let words = shader.map_or_else(none, |s| {
                s.cycles.iter().map(|(family, cycles)| format!("{cycles} {family}")).collect::<Vec<_>>().join(", ")
            });
            let _ = write!(out, "<td>{}</td>", escape(&words));
        }
        out.push_str("</tr>");
    }
    out.push_str("</tbody></table></div></details>");
}

fn asked(budget: &Budget) -> String {
    let parts = [
        ("absolute error", budget.max_abs.map(error)),
        ("relative error", budget.max_rel.map(error)),
        ("CIEDE2000", budget.delta_e.map(number)),
        ("bytes", budget.max_bytes.map(bytes)),
        ("cost", budget.max_cost.map(number)),
        ("lobe error", budget.max_lobe_err.map(error)),
        ("error of the albedo of lobes", budget.max_albedo_err.map(error)),
    ];
    let stated: Vec<String> =
        parts.into_iter().filter_map(|(name, limit)| Some(format!("{name} at most {}", limit?))).collect();
    if stated.is_empty() { "nothing".to_owned() } else { stated.join(", ") }
}

/// A candidate in words.
fn words(form: &CandidateForm) -> String {
    match form {
        CandidateForm::ClosedForm => "closed form".to_owned(),
        CandidateForm::Table { x, y, format, base } => {
            let over = if *base == RowBase::Zero { "" } else { " over Schlick's form" };
            let axes: Vec<String> = [Some(x), y.as_ref()].into_iter().flatten().map(|a: &Axis| axis(a)).collect();
            format!("{format}{over}; {}", axes.join("; "))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Absolute errors of lobes are zero: their charts would be flat.
    #[test]
    fn lobes_are_charted_by_their_lobe_error() {
        let candidate = |bytes, lobe| {
            let error = MeasuredError { lobe: Some(lobe), albedo: Some(1e-3), ..MeasuredError::default() };
            Candidate { form: CandidateForm::ClosedForm, bytes, cost: bytes as f64, error }
        };
        let search = Search {
            kind: TableKind::Lobes,
            budget: Budget { max_lobe_err: Some(0.05), ..Budget::default() },
            chosen: 1,
            front: vec![candidate(100, 0.2), candidate(200, 0.03)],
            measured: 8,
        };
        let mut out = String::new();
        charts(&mut out, &search, None, "lobes");
        assert_eq!(out.matches(">lobe error<").count(), 2, "{out}");
        assert!(out.contains(">limit<") && !out.contains("absolute"), "{out}");
        // The better choice is lower.
        let heights: Vec<f64> = out
            .split("<path class=\"mark")
            .skip(1)
            .filter_map(|mark| mark.split("d=\"M").nth(1)?.split([' ', 'l']).nth(1)?.parse().ok())
            .collect();
        assert!(heights.len() == 4 && heights[0] < heights[1], "{heights:?}");
    }
}
