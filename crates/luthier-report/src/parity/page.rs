//! The page of a parity run, in Markdown.

use std::fmt::Write;

use luthier_manifest::{Form, ShadingModel};
use luthier_model::Tolerance;

use super::tolerances::{KNOWN, Known, tolerance};
use super::{AT_PLACES, Parity, ParityRow, ParitySet, Share, Verdict};
use crate::measure::statistics::ErrorSummary;
use crate::places::PLACE_FLOOR;
use crate::text::format::{angles, error, number};

/// The whole page.
pub(super) fn markdown(parity: &Parity, command: &str) -> String {
    let mut out = preamble(parity, command);
    summary(&mut out, parity);
    tolerances(&mut out, parity);
    exceptions(&mut out, parity);
    places(&mut out, parity);
    for model in models(parity) {
        materials(&mut out, parity, model);
    }
    out
}

fn models(parity: &Parity) -> Vec<ShadingModel> {
    let mut models: Vec<ShadingModel> = parity.rows.iter().map(|row| row.model).collect();
    models.dedup();
    models
}

fn preamble(parity: &Parity, command: &str) -> String {
    let Parity { generator, device, pairs_per_set, floor, rows } = parity;
    let pairs: u64 = rows.iter().map(|row| row.pairs).max().unwrap_or(0);
    let mut out = format!(
        "# The shaders against their f64 twins

luthier runs every shader of every material on a device and compares it with the same model in f64. This command makes the whole page:

    {command}

It ran on {device}, by {generator}. The compared value is f cos θᵢ, at {pairs} pairs of directions for each model, form and material: {pairs_per_set} in \
each of five sets. An error is divided by the brightest channel of the reference, or by {} where that is larger: a tenth of what a white diffuser \
gives. Every channel counts as a sample.

| error | compares | with |
|---|---|---|
| total | the shader on the device | the reference in f64 |
| table | f64 arithmetic on the texels that the shader reads | the reference in f64 |
| arithmetic | the shader on the device | f64 arithmetic on the texels that the shader reads; the reference in f64 where the shader reads no table |

Table and arithmetic are the two shares of the total error. The reference depends on the form and on the model:

- The reference of `baked` has the colour of the material: spectral, or at three wavelengths.
- The reference of `full` is computed at three wavelengths, like the shader.
- For `belcour` and `yamaguchi`, the reference of `baked` computes directional albedos from the micro-surface (to 5e-4) and total reflection by \
integration.
- For `belcour` and `yamaguchi`, the reference of `full` takes facets as level, as the shader does. It takes the terms of the layers over a diffuse \
base from the record of the material.

| set | directions |
|---|---|
",
        number(*floor)
    );
    for set in ParitySet::ALL {
        let _ = writeln!(out, "| {} | {} |", set.name(), set.description());
    }
    out
}

fn summary(out: &mut String, parity: &Parity) {
    out.push_str(
        "\n## Summary\n\nEach value is the largest over all materials: the largest error (max), the 99th percentile (p99) and the root mean square (rms).\n\n| model | form | total max | p99 | rms | table max | p99 \
         | rms | arithmetic max | p99 | rms | not finite |\n|---|---|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|\n",
    );
    for model in models(parity) {
        for form in Form::ALL.into_iter().filter(|&form| model.has(form)) {
            let rows = parity.rows.iter().filter(|row| row.model == model && row.form == form);
            let shares: [fn(&ParityRow) -> Option<ErrorSummary>; 3] =
                [|row| Some(row.total), |row| row.table, |row| Some(row.arithmetic)];
            let cells = shares.map(|share| {
                errors(rows.clone().filter_map(share).reduce(|a, b| ErrorSummary {
                    max: a.max.max(b.max),
                    p99: a.p99.max(b.p99),
                    rms: a.rms.max(b.rms),
                }))
            });
            let not_finite: u64 = rows.map(|row| row.not_finite).sum();
            let _ = writeln!(out, "| {} | {form} | {} | {not_finite} |", model.name(), cells.join(" | "));
        }
    }
    out.push_str("\nThe largest error in each set: of the tables, then of the arithmetic. The form `full` has an error of arithmetic only.\n\n| model | form |");
    for set in ParitySet::ALL {
        let _ = write!(out, " {} |", set.name());
    }
    out.push_str("\n|---|---|--:|--:|--:|--:|--:|\n");
    for model in models(parity) {
        for form in Form::ALL.into_iter().filter(|&form| model.has(form)) {
            let _ = write!(out, "| {} | {form} |", model.name());
            for (index, _) in ParitySet::ALL.iter().enumerate() {
                let rows = parity.rows.iter().filter(|row| row.model == model && row.form == form);
                let [table, arithmetic] = rows.fold([0.0_f64; 2], |max, row| {
                    let (_, errors) = row.sets[index];
                    [max[0].max(errors[0]), max[1].max(errors[1])]
                });
                let _ = match form {
                    Form::Baked => write!(out, " {}, {} |", error(table), error(arithmetic)),
                    Form::Full => write!(out, " {} |", error(arithmetic)),
                };
            }
            out.push('\n');
        }
    }
}

/// Maximum, 99th percentile and root mean square, as cells.
fn errors(summary: Option<ErrorSummary>) -> String {
    summary
        .map_or_else(|| "– | – | –".to_owned(), |s| format!("{} | {} | {}", error(s.max), error(s.p99), error(s.rms)))
}

fn tolerances(out: &mut String, parity: &Parity) {
    out.push_str("\n## Tolerances\n\nA tolerance limits the largest error of a share, table or arithmetic.\n\n| tolerance | limit | of | reason |\n|---|--:|---|---|\n");
    let mut named: Vec<(Tolerance, Vec<String>)> = Vec::new();
    for model in models(parity) {
        for form in Form::ALL.into_iter().filter(|&form| model.has(form)) {
            let row = parity.rows.iter().find(|row| (row.model, row.form) == (model, form));
            let weights = row.and_then(|row| row.weights);
            for share in Share::ALL {
                if share == Share::Table && form == Form::Full {
                    continue;
                }
                let tolerance = tolerance(model, form, share, weights);
                let of = format!("{} {form}: {}", model.name(), share.name());
                match named.iter_mut().find(|(t, _)| *t == tolerance) {
                    Some((_, all)) => all.push(of),
                    None => named.push((tolerance, vec![of])),
                }
            }
        }
    }
    for (Tolerance { name, limit, reason }, of) in named {
        let _ = writeln!(out, "| `{name}` | {} | {} | {reason} |", limit_text(limit), of.join(", "));
    }
}

fn limit_text(limit: f64) -> String {
    if limit == 0.0 { "0".to_owned() } else { format!("{limit:e}") }
}

fn exceptions(out: &mut String, parity: &Parity) {
    out.push_str("\n## Exceptions\n\n");
    let beyond: Vec<(&ParityRow, Share, Verdict)> = parity
        .rows
        .iter()
        .flat_map(|row| Share::ALL.map(|share| (row, share, row.verdict(share))))
        .filter(|(.., verdict)| *verdict != Verdict::Met)
        .collect();
    if beyond.is_empty() {
        out.push_str("There are none: every tolerance is met.\n");
        return;
    }
    let used: Vec<&Known> = KNOWN
        .iter()
        .filter(|known| beyond.iter().any(|(.., v)| matches!(v, Verdict::Explained(k) if k.name == known.name)))
        .collect();
    if !used.is_empty() {
        out.push_str("An error beyond its tolerance is accepted where the page has measured which factor of the model causes it, and a reason is known for that factor:\n\n| known | limit | reason |\n|---|--:|---|\n");
        for known in used {
            let _ = writeln!(out, "| `{}` | {} | {} |", known.name, limit_text(known.limit), known.reason);
        }
        out.push('\n');
    }
    out.push_str("| model | form | material | share | max | p99 | set, worst pair | at fault there | accepted as |\n|---|---|---|---|--:|--:|---|---|---|\n");
    for (row, share, verdict) in beyond {
        let (errors, worst) = match share {
            Share::Table => (row.table, &row.worst_table),
            Share::Arithmetic => (Some(row.arithmetic), &row.worst_arithmetic),
        };
        let p99 = errors.map_or(0.0, |errors| errors.p99);
        let place =
            worst.as_ref().map_or_else(String::new, |(set, w)| format!("{}, {}", set.name(), angles(w.wi, w.wo)));
        let fault = match share {
            Share::Table => row.parts.first().map_or_else(String::new, |part| part.cause.words()),
            Share::Arithmetic => "f32 arithmetic".to_owned(),
        };
        let accepted = match verdict {
            Verdict::Explained(known) => format!("`{}`", known.name),
            Verdict::Met | Verdict::Broken => "**not accepted**".to_owned(),
        };
        let _ = writeln!(
            out,
            "| {} | {} | {} | {} | {} | {} | {place} | {fault} | {accepted} |",
            row.model.name(),
            row.form,
            row.material,
            share.name(),
            error(row.max(share)),
            error(p99),
        );
    }
}

fn places(out: &mut String, parity: &Parity) {
    let all: Vec<_> = parity.rows.iter().filter_map(|row| Some((row, row.places.as_ref()?))).collect();
    if all.is_empty() {
        return;
    }
    let _ = writeln!(
        out,
        "\n## Random places\n\nMaterials that maps or effects vary, each at {} random places with a pair of directions: the form `baked` on the device, against f64 on the \
         same tables at the same place. Errors are over max(brightest channel, {PLACE_FLOOR}); their 99th percentile may be {AT_PLACES}. \
         `luthier-lab textured` has more.\n\n| model | material | p99 | max | not finite | worst place | |\n|---|---|--:|--:|--:|---|---|",
        parity.pairs_per_set
    );
    for (row, at) in all {
        let place = at.worst.as_ref().map_or_else(String::new, |w| format!("{}; {}", w.place, angles(w.wi, w.wo)));
        let verdict = if row.holds_at_places() { "" } else { "**not accepted**" };
        let _ = writeln!(
            out,
            "| {} | {} | {} | {} | {} | {place} | {verdict} |",
            row.model.name(),
            row.material,
            error(at.relative_dim.p99),
            error(at.relative_dim.max),
            at.not_finite
        );
    }
}

fn materials(out: &mut String, parity: &Parity, model: ShadingModel) {
    let _ = write!(
        out,
        "\n## {}\n\n| material | form | total max | p99 | rms | table max | p99 | rms | arithmetic max | p99 | rms | not finite |\n\
         |---|---|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|\n",
        model.name()
    );
    for row in parity.rows.iter().filter(|row| row.model == model) {
        let ParityRow { material, form, total, table, arithmetic, not_finite, .. } = row;
        let cells = [errors(Some(*total)), errors(*table), errors(Some(*arithmetic))].join(" | ");
        let _ = writeln!(out, "| {material} | {form} | {cells} | {not_finite} |");
    }
}
