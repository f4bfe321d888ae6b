//! `table dfg`: the split sum of image-based lighting, as a table or in closed form.

use std::path::Path;

use luthier_export::input;
use luthier_lut::{ErrorStats, Image};
use luthier_optics::split_sum::Masking;
use luthier_report::{Certificate, ErrorMap};
use luthier_shader::Target;
use luthier_table::{
    ClosedForm, Container, Cost, DfgTable, FittedForm, Found, Preset, SPLIT_SUM, Stored, rgbd, search,
    search_beside_form,
};
use luthier_terminal::{Failure, Outcome, complain, files};
use luthier_texture::table;
use serde_json::{Value as Json, json};

use super::container::{by_ending, ending_of};
use super::look_up;
use super::product::{Product, Sampled, distribution, domain, error_facts, fact, nodes_name, sampled, verdict};
use crate::cli::DfgOptions;

const QUANTITIES: [&str; 2] = ["cos_theta", "alpha"];
/// How errors of tables are measured, for the page.
const METHOD: &str = "Reads are bilinear with 8-bit weights and texels as stored. They are compared with quadrature over reflected directions, \
    which is within 1e-6 for GGX and Beckmann with smooth masking terms, and within 4e-3 with V-cavities. A map shows the largest error of all \
    channels; a circle marks the largest of the scan.";

/// Bakes, finds or fits what the options ask for.
pub(super) fn product(options: &DfgOptions) -> Outcome<Product> {
    if options.closed {
        return closed(options);
    }
    let (Found { table, texels, error, .. }, container) = match options.preset {
        Some(preset) => {
            ending_of(preset, &options.delivery.output)?;
            (of_preset(preset, options), preset.container)
        }
        None => searched(options)?,
    };
    let from = [options.min_cos, options.min_alpha];
    let preset = options.preset.map(|preset| json!({ "name": preset.name, "source": preset.source }));
    let channels = table.channel_errors(&texels, from[0], from[1]);
    let channels: Vec<(&str, f64)> =
        table.values.iter().zip(&channels).map(|(value, error)| (value.name(), error.max_abs_err)).collect();
    // A table beside a closed form means nothing without its look-up.
    let languages =
        if table.base.is_some() && options.shader.is_empty() { &[Target::Wgsl][..] } else { &options.shader };
    let look_ups = match languages {
        [] => Vec::new(),
        languages => {
            let reason = "the channels of this table do not determine scale and bias: there is no look-up";
            let text =
                table.wgsl(look_up::bindings(options.bind)).ok_or_else(|| Failure::Usage(anyhow::anyhow!(reason)))?;
            look_up::beside(&options.delivery.output, languages, &text)?
        }
    };
    let each = channels.iter().map(|(name, largest)| format!("{name} {largest:.2e}")).collect::<Vec<_>>().join(", ");
    let product = Sampled {
        title: &options
            .preset
            .map_or("Split-sum table".to_owned(), |preset| format!("Split-sum table of {}", preset.name)),
        words: words(&table),
        statement: statement(&table),
        texels: &texels,
        file: (container, table.stored),
        error: (error.clone(), &QUANTITIES, domain(from[0], from[1])),
        max_abs: options.max_abs,
        facts: facts(options, &table, &each),
        maps: maps(options, &table, &texels, &error)?,
        method: METHOD,
    };
    let mut product = sampled(product, &options.delivery)?;
    product.files.extend(look_ups);
    product.text.push_str(&format!("channels: {each}\n"));
    product.json["preset"] = json!(preset);
    product.json["channels"] =
        channels.iter().map(|(name, largest)| json!({ "value": name, "max_abs_err": largest })).collect();
    Ok(product)
}

/// The closed form that holds the limit at the least cost.
fn closed(options: &DfgOptions) -> Outcome<Product> {
    let output = &options.delivery.output;
    let target = language(output)?;
    let masking = masking(options)?;
    let max_abs = options.max_abs.unwrap_or(f64::INFINITY);
    let FittedForm { form, error, held } =
        ClosedForm::fit(distribution(options.distribution), masking, max_abs, options.min_cos, options.min_alpha);
    let domain = domain(form.floor[0], form.floor[1]);
    if !held {
        let nearest = error.max_abs_err;
        return Err(Failure::Input(anyhow::anyhow!(
            "no closed form holds {max_abs} over {domain}: the nearest errs by {nearest:.2e}; a table may hold it: leave out --closed"
        )));
    }
    let cost = form.cost();
    let words = format!(
        "Split sum in closed form, {}, masking {}: {}",
        form.distribution.name(),
        masking.name(),
        operations(cost)
    );
    let text = form.wgsl();
    let mut written = vec![(output.clone(), look_up::text(&text, target)?)];
    written.extend(look_up::beside(output, &options.shader, &text)?);
    let mut facts = vec![
        fact("Model", format!("{} distribution, masking {}", form.distribution.name(), masking.name())),
        fact("Cost", operations(cost)),
        fact("Domain", format!("{domain}; lower ones are read as these")),
    ];
    facts.extend(error_facts(&error, &QUANTITIES));
    let mut maps = Vec::new();
    if options.delivery.report.is_some() {
        let worst = (error.max_abs_err, [error.worst.at[0], error.worst.at[1]]);
        let ranges = form.floor.map(|lowest| [lowest, 1.0]);
        maps.push(ErrorMap::sample("this form", QUANTITIES, ranges, worst, |[cos, alpha]| form.error_at(cos, alpha)));
    }
    let certificate = Certificate {
        title: "Split sum in closed form".to_owned(),
        verdict: verdict(options.max_abs, format!("largest error {:.2e}", error.max_abs_err)),
        facts,
        maps,
        method: "The form is evaluated in single precision, as a shader does, and compared with quadrature over reflected directions: the largest error of bias \
                 and albedo, which are the reflectances for f0 = 0 and 1."
            .to_owned(),
    };
    let measured = json!({
        "max_abs_err": error.max_abs_err, "rms_err": error.rms_err, "p99_abs_err": error.p99_abs_err, "worst": error.worst,
        "points": error.points, "domain": domain,
    });
    let cost = json!({ "multiply_adds": cost.multiply_adds, "clamps": cost.clamps, "specials": cost.specials });
    let form =
        json!({ "function": "dfg", "model": format!("{}-{}", form.distribution.name(), masking.name()), "cost": cost });
    let json = json!({ "closed_form": form, "max_abs": options.max_abs, "error": measured });
    let text = format!(
        "{words}\nerror in single precision: max {:.2e} at cos_theta {:.3}, alpha {:.3}; rms {:.2e}\n  over {domain}\nholds {max_abs}\n",
        error.max_abs_err, error.worst.at[0], error.worst.at[1], error.rms_err
    );
    Ok(Product { files: written, certificate, json, text })
}

fn of_preset(preset: &Preset, options: &DfgOptions) -> Found {
    let mut table = preset.table();
    table.size = options.size.unwrap_or(table.size);
    let texels = table.bake();
    let error = table.error(&texels, options.min_cos, options.min_alpha);
    Found { table, texels, error, held: true }
}

fn masking(options: &DfgOptions) -> Outcome<Masking> {
    Masking::ALL
        .into_iter()
        .find(|masking| masking.name() == options.masking)
        .ok_or_else(|| Failure::unknown("masking term", &options.masking, &Masking::ALL.map(Masking::name)))
}

/// The smallest table, and its container.
fn searched(options: &DfgOptions) -> Outcome<(Found, Container)> {
    let max_abs = options.max_abs.unwrap_or(f64::INFINITY);
    let (masking, distribution) = (masking(options)?, distribution(options.distribution));
    let (container, stored) = match by_ending(&options.delivery.output)? {
        (Container::Exr, _) => (Container::Exr, Stored::Float),
        (container, _) => (container, Stored::Half),
    };
    let mut found = search(distribution, masking, &SPLIT_SUM, max_abs, options.min_cos, options.min_alpha);
    let domain = domain(options.min_cos, options.min_alpha);
    if stored == Stored::Float {
        found = restored(found, stored, options, max_abs);
    }
    let Some(max_bytes) = options.max_bytes.filter(|max_bytes| !found.held || found.table.bytes() > *max_bytes) else {
        if found.held {
            return Ok((found, container));
        }
        let [width, height] = found.table.size;
        return Err(Failure::Input(anyhow::anyhow!(
            "no table of half floats up to {width} x {height} holds {max_abs} over {domain}: the nearest errs by {:.2e}",
            found.error.max_abs_err
        )));
    };
    // The search is for texels of two bytes; KTX2 holds two half floats.
    let is_raw = container == Container::Raw;
    let bytes = if is_raw { max_bytes } else { max_bytes / 2 };
    let mut found = search_beside_form(distribution, masking, max_abs, [options.min_cos, options.min_alpha], bytes);
    if !is_raw {
        found = restored(found, stored, options, max_abs);
    }
    if found.held && found.table.bytes() <= max_bytes {
        return Ok((found, container));
    }
    Err(Failure::Input(anyhow::anyhow!(
        "no table of {max_bytes} bytes beside a closed form holds {max_abs} over {domain}: the nearest, of {} bytes, errs by {:.2e}",
        found.table.bytes(),
        found.error.max_abs_err
    )))
}

/// The table in texels of another type.
fn restored(found: Found, stored: Stored, options: &DfgOptions, max_abs: f64) -> Found {
    let table = DfgTable { stored, ..found.table };
    let texels = table.bake();
    let error = table.error(&texels, options.min_cos, options.min_alpha);
    Found { held: error.max_abs_err <= max_abs, table, texels, error }
}

/// The language of a file, by its ending.
fn language(path: &Path) -> Outcome<Target> {
    let name = path.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
    let all = Target::ALL;
    let found = all.iter().filter(|target| name.ends_with(&format!(".{}", target.extension())));
    found.max_by_key(|target| target.extension().len()).copied().ok_or_else(|| {
        let endings = all.iter().map(|target| format!(".{}", target.extension())).collect::<Vec<_>>().join(", ");
        Failure::Usage(anyhow::anyhow!(
            "{}: a closed form is a shader; its language is told by the ending: {endings}",
            path.display()
        ))
    })
}

/// The table in words.
fn words(table: &DfgTable) -> String {
    let DfgTable { distribution, masking, layout, values, size: [width, height], stored, base } = table;
    let values = values.iter().map(|value| value.name()).collect::<Vec<_>>().join(",");
    let (name, masking, stored) = (distribution.name(), masking.name(), stored.name());
    let nodes = nodes_name(layout.angle.nodes);
    let beside = if base.is_some() { ", beside a closed form in its look-up" } else { "" };
    format!(
        "Split sum, {name}, masking {masking}; {values} over {layout}, nodes at {nodes}; {width} x {height}, {stored}{beside}"
    )
}

/// The table in the words of `luthier audit`.
fn statement(table: &DfgTable) -> Json {
    let DfgTable { distribution, masking, layout, values, size, stored, base } = table;
    json!({
        "function": "dfg",
        "model": format!("{}-{}", distribution.name(), masking.name()),
        "axes": layout.to_string(),
        "nodes": nodes_name(layout.angle.nodes),
        "values": values.iter().map(|value| value.name()).collect::<Vec<_>>(),
        "size": size,
        "stored": stored.name(),
        "bytes": table.bytes(),
        "beside_form": base.as_ref().map(|base| json!({ "scale": base.scale, "offset": base.offset, "multiply_adds": base.form.cost().multiply_adds })),
    })
}

fn facts(options: &DfgOptions, table: &DfgTable, channels: &str) -> Vec<(String, String)> {
    let [width, height] = table.size;
    let mut facts = vec![
        fact("Model", format!("{} distribution, masking {}", table.distribution.name(), table.masking.name())),
        fact("Axes", format!("{}, nodes at {}", table.layout, nodes_name(table.layout.angle.nodes))),
        fact("Texels", format!("{width} x {height}, {}: {} bytes", table.stored.name(), table.bytes())),
        fact("Channels, largest errors", channels),
    ];
    if let Some(cost) = table.cost().filter(|_| table.base.is_some()) {
        facts.push(fact("Look-up", format!("a closed form and one read: {}", operations(cost))));
    }
    if let Some(preset) = options.preset {
        facts.push(fact("Layout read in", preset.source));
    }
    facts
}

/// A cost in words.
fn operations(cost: Cost) -> String {
    let Cost { multiply_adds, clamps, specials } = cost;
    format!("{multiply_adds} multiply-adds, {clamps} clamps, {specials} divisions and roots")
}

/// Map of the errors of a table.
pub(super) fn map(title: &str, table: &DfgTable, texels: &Image, error: &ErrorStats, from: [f64; 2]) -> ErrorMap {
    let worst = (error.max_abs_err, [error.worst.at[0], error.worst.at[1]]);
    let ranges = from.map(|lowest| [lowest.max(1e-3), 1.0]);
    ErrorMap::sample(title, QUANTITIES, ranges, worst, |[cos, alpha]| table.error_at(texels, cos, alpha))
}

/// Maps of the errors, of the table and of the one beside it.
fn maps(options: &DfgOptions, table: &DfgTable, texels: &Image, error: &ErrorStats) -> Outcome<Vec<ErrorMap>> {
    if options.delivery.report.is_none() {
        return Ok(Vec::new());
    }
    let from = [options.min_cos, options.min_alpha];
    let mut maps = vec![map("this table", table, texels, error, from)];
    if let Some(path) = &options.beside {
        let bytes = input::image(path).map_err(files(path, "read"))?;
        let read =
            table::read(&bytes).map_err(|source| Failure::Input(anyhow::anyhow!("{}: {source}", path.display())));
        let read = read?;
        for note in &read.notes {
            complain(&format!("warning: {}: {note}", path.display()));
        }
        let is_encoded = table.stored == Stored::Rgbd && read.format.starts_with("PNG");
        let other = if is_encoded { rgbd::decode_image(&read.image) } else { read.image };
        let channels = table.values.len();
        if (other.channels as usize) < channels {
            return Err(Failure::Input(anyhow::anyhow!(
                "{}: {} channels, where the preset has {channels}",
                path.display(),
                other.channels
            )));
        }
        let beside = DfgTable { size: [other.width, other.height], ..table.clone() };
        let error = beside.error(&other, from[0], from[1]);
        let title = format!("{} ({} x {})", path.display(), other.width, other.height);
        maps.push(map(&title, &beside, &other, &error, from));
    }
    Ok(maps)
}
