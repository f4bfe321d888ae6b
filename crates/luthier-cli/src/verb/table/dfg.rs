//! `table dfg`: the split sum of image-based lighting.

use luthier_export::input;
use luthier_lut::{ErrorStats, Image};
use luthier_optics::split_sum::Masking;
use luthier_optics::stack::Distribution;
use luthier_report::{Certificate, ErrorMap};
use luthier_table::{Container, DfgTable, Found, Preset, search};
use luthier_terminal::{Failure, Outcome, files};
use luthier_texture::table;
use serde_json::json;

use super::container::encode;
use super::product::{Product, error_json, nodes, words};
use crate::cli::{DfgOptions, DistributionName};

/// Bakes or finds the table that the options ask for.
pub(super) fn product(options: &DfgOptions) -> Outcome<Product> {
    let (Found { table, texels, error, .. }, container) = match options.preset {
        Some(preset) => (of_preset(preset, options), preset.container),
        None => (searched(options)?, Container::Ktx2),
    };
    let from = [options.min_cos, options.min_alpha];
    let words = words(&table);
    let statement = statement(&table);
    let measured = error_json(&error, from);
    let preset = options.preset.map(|preset| json!({ "name": preset.name, "source": preset.source }));
    let mut json = serde_json::Map::new();
    json.insert("table".to_owned(), statement.clone());
    json.insert("preset".to_owned(), json!(preset));
    json.insert("max_abs".to_owned(), json!(options.max_abs));
    json.insert("error".to_owned(), measured.clone());
    let metadata = json!({ "table": statement, "error": measured }).to_string();
    let comment = format!("{words}. Largest error as sampled: {:.2e}.", error.max_abs_err);
    let bytes = encode(container, &texels, table.stored, &comment, &metadata, options.delivery.no_zstd)?;

    let maps = maps(options, &table, &texels, &error)?;
    let at = &error.worst.at;
    let text = format!(
        "{words}\nerror as sampled: max {:.2e} at cos_theta {:.3}, alpha {:.3}; rms {:.2e}\n  over cos_theta >= {}, alpha >= {}; bilinear, \
         8-bit weights{}\n",
        error.max_abs_err,
        at[0],
        at[1],
        error.rms_err,
        from[0],
        from[1],
        options.max_abs.map_or(String::new(), |limit| format!("\nholds {limit}")),
    );
    let certificate = Certificate {
        title: options.preset.map_or("Split-sum table".to_owned(), |preset| format!("Split-sum table of {}", preset.name)),
        verdict: verdict(options, &error),
        facts: facts(options, &table, &error),
        maps,
        method: "Reads are bilinear with 8-bit weights and texels as stored. They are compared with quadrature over reflected directions, \
                 which is within 1e-6 for GGX and Beckmann with smooth masking terms, and within 4e-3 with V-cavities. A map shows the largest \
                 error of all channels; a circle marks the largest of the scan."
            .to_owned(),
    };
    Ok(Product { files: vec![(options.delivery.output.clone(), bytes)], certificate, json, text })
}

fn verdict(options: &DfgOptions, error: &ErrorStats) -> (String, bool) {
    let largest = format!("largest error as sampled {:.2e}", error.max_abs_err);
    match options.max_abs {
        Some(limit) => (format!("holds {limit}: {largest}"), true),
        None => (largest, true),
    }
}

fn of_preset(preset: &Preset, options: &DfgOptions) -> Found {
    let mut table = preset.table();
    table.size = options.size.unwrap_or(table.size);
    let texels = table.bake();
    let error = table.error(&texels, options.min_cos, options.min_alpha);
    Found { table, texels, error, held: true }
}

fn searched(options: &DfgOptions) -> Outcome<Found> {
    let masking = Masking::ALL
        .into_iter()
        .find(|masking| masking.name() == options.masking)
        .ok_or_else(|| Failure::unknown("masking term", &options.masking, &Masking::ALL.map(Masking::name)))?;
    let distribution = match options.distribution {
        DistributionName::Ggx => Distribution::Ggx,
        DistributionName::Beckmann => Distribution::Beckmann,
    };
    let max_abs = options.max_abs.unwrap_or(f64::INFINITY);
    let found = search(distribution, masking, max_abs, options.min_cos, options.min_alpha);
    if found.held {
        return Ok(found);
    }
    let [width, height] = found.table.size;
    Err(Failure::Input(anyhow::anyhow!(
        "no table of half floats up to {width} x {height} holds {max_abs} over cos_theta >= {}, alpha >= {}: the nearest errs by {:.2e}",
        options.min_cos,
        options.min_alpha,
        found.error.max_abs_err
    )))
}

/// The table in the words of `luthier audit`.
fn statement(table: &DfgTable) -> serde_json::Value {
    let DfgTable { distribution, masking, layout, values, size, stored } = table;
    json!({
        "function": "dfg",
        "model": format!("{}-{}", distribution.name(), masking.name()),
        "axes": layout.to_string(),
        "nodes": nodes(layout),
        "values": values.iter().map(|value| value.name()).collect::<Vec<_>>(),
        "size": size,
        "stored": stored.name(),
    })
}

fn facts(options: &DfgOptions, table: &DfgTable, error: &ErrorStats) -> Vec<(String, String)> {
    let fact = |name: &str, value: String| (name.to_owned(), value);
    let [width, height] = table.size;
    let mut facts = vec![
        fact("Model", format!("{} distribution, masking {}", table.distribution.name(), table.masking.name())),
        fact("Axes", format!("{}, nodes at {}", table.layout, nodes(&table.layout))),
        fact("Channels", table.values.iter().map(|value| value.name()).collect::<Vec<_>>().join(", ")),
        fact(
            "Texels",
            format!(
                "{width} x {height}, {}: {} bytes",
                table.stored.name(),
                width as usize * height as usize * table.stored.texel_bytes(table.values.len())
            ),
        ),
        fact(
            "Errors",
            format!(
                "largest {:.2e}, 99 % below {:.2e}, rms {:.2e}",
                error.max_abs_err, error.p99_abs_err, error.rms_err
            ),
        ),
        fact("Largest at", format!("cos_theta {:.4}, alpha {:.4}", error.worst.at[0], error.worst.at[1])),
        fact("Domain", format!("cos_theta from {}, alpha from {}", options.min_cos, options.min_alpha)),
    ];
    if let Some(preset) = options.preset {
        facts.push(fact("Layout read in", preset.source.to_owned()));
    }
    facts
}

/// Maps of the errors, of the table and of the one beside it.
fn maps(options: &DfgOptions, table: &DfgTable, texels: &Image, error: &ErrorStats) -> Outcome<Vec<ErrorMap>> {
    if options.delivery.report.is_none() {
        return Ok(Vec::new());
    }
    let ranges = [[options.min_cos.max(1e-3), 1.0], [options.min_alpha.max(1e-3), 1.0]];
    let map = |title: &str, table: &DfgTable, texels: &Image, error: &ErrorStats| {
        let worst = (error.max_abs_err, [error.worst.at[0], error.worst.at[1]]);
        ErrorMap::sample(title, ["cos_theta", "alpha"], ranges, worst, |[cos, alpha]| {
            table.error_at(texels, cos, alpha)
        })
    };
    let mut maps = vec![map("this table", table, texels, error)];
    if let Some(path) = &options.beside {
        let bytes = input::image(path).map_err(files(path, "read"))?;
        let other = table::read(&bytes)
            .map_err(|source| Failure::Input(anyhow::anyhow!("{}: {source}", path.display())))?
            .image;
        let channels = table.values.len();
        if (other.channels as usize) < channels {
            return Err(Failure::Input(anyhow::anyhow!(
                "{}: {} channels, where the preset has {channels}",
                path.display(),
                other.channels
            )));
        }
        let beside = DfgTable { size: [other.width, other.height], ..table.clone() };
        let error = beside.error(&other, options.min_cos, options.min_alpha);
        maps.push(map(&format!("{} ({} x {})", path.display(), other.width, other.height), &beside, &other, &error));
    }
    Ok(maps)
}
