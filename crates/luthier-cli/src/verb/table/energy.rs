//! `table energy`: albedos by which energy compensation restores lost light.

use luthier_optics::dielectric_albedo::JointMasking;
use luthier_optics::split_sum::Masking;
use luthier_report::{Certificate, ErrorMap};
use luthier_table::{
    Container, EnergyDomain, EnergyLayout, EnergyPreset, EnergySurface, EnergyTable, EnergyValue, Found, Stored, Value,
    search,
};
use luthier_terminal::{Failure, Outcome};
use serde_json::{Value as Json, json};

use super::container::by_ending;
use super::dfg::map;
use super::product::{Product, Sampled, distribution, domain, fact, nodes, nodes_name, sampled};
use crate::cli::EnergyOptions;

const TITLE: &str = "Table of energy compensation";
/// How errors are measured, for the page.
const METHOD: &str = "Reads are linear between the nodes of each axis, with 8-bit weights and texels as stored. They are compared with quadrature, \
    which is within 1e-6 (averages 2e-6).";
/// Most nodes of a table: some take a fiftieth of a second each. Slices of as many nodes, one below the other, are also within the sides of textures.
const MAX_NODES: u64 = 1 << 16;
/// Indices over which errors count.
const INDICES: [f64; 2] = [1.05, 2.5];

/// Bakes the table that the options ask for, or all of a renderer.
pub(super) fn product(options: &EnergyOptions) -> Outcome<Product> {
    match (options.preset, options.max_abs) {
        (Some(preset), _) => Ok(of_preset(preset, options)),
        (None, Some(max_abs)) => searched(options, max_abs),
        (None, None) => one(options),
    }
}

fn errors_count(options: &EnergyOptions, table: &EnergyTable) -> (EnergyDomain, String, Vec<&'static str>) {
    let of = EnergyDomain { min_cos: options.domain.min_cos, min_alpha: options.domain.min_alpha, ior: INDICES };
    let axes = table.layout.axes();
    let mut words = format!("alpha >= {}", of.min_alpha);
    let mut quantities = vec!["alpha"];
    if axes.iter().any(|axis| axis.quantity.is_angle()) {
        words = domain(of.min_cos, of.min_alpha);
        quantities.insert(0, "cos_theta");
    }
    if axes.iter().any(|axis| axis.quantity.is_index()) {
        words = format!("{words}, index {} to {}", INDICES[0], INDICES[1]);
        quantities.push("index");
    }
    (of, words, quantities)
}

fn of_preset(preset: &EnergyPreset, options: &EnergyOptions) -> Product {
    let folder = &options.delivery.output;
    let (mut files, mut listed, mut text) = (Vec::new(), Vec::new(), String::new());
    for file in preset.files {
        let parts = preset.bake(file);
        let mut max_abs_err = 0.0_f64;
        let mut over = String::new();
        for (table, texels) in preset.tables(file).iter().zip(&parts) {
            let (of, words, _) = errors_count(options, table);
            max_abs_err = max_abs_err.max(table.error(texels, of).max_abs_err);
            over = words;
        }
        text.push_str(&format!("{}: max {max_abs_err:.2e} as sampled, over {over}\n", file.name));
        let parts_of: Vec<Json> = preset.tables(file).iter().map(statement).collect();
        listed.push(json!({ "name": file.name, "parts": parts_of, "max_abs_err": max_abs_err, "domain": over }));
        files.push((folder.join(preset.container.file_name(file.name)), preset.write(file, &parts)));
    }
    let certificate = Certificate {
        title: format!("Tables of energy of {}", preset.name),
        verdict: (String::new(), None),
        facts: Vec::new(),
        maps: Vec::new(),
        method: String::new(),
    };
    let json = json!({ "preset": { "name": preset.name, "source": preset.source }, "tables": listed });
    Product { files, certificate, json, text: format!("{text}linear between nodes, 8-bit weights\n") }
}

fn one(options: &EnergyOptions) -> Outcome<Product> {
    let surface = find(&EnergySurface::ALL, EnergySurface::name, "surface", &options.surface)?;
    let masking = find(&JointMasking::ALL, JointMasking::name, "masking term", &options.masking)?;
    let values = options
        .values
        .iter()
        .map(|name| find(&EnergyValue::ALL, EnergyValue::name, "value", name))
        .collect::<Outcome<Vec<_>>>()?;
    if values.len() > 4 {
        return Err(Failure::Usage(anyhow::anyhow!("{} values; a table has 1 to 4 channels", values.len())));
    }
    let layout =
        EnergyLayout::parse(&options.axes, nodes(options.nodes)).map_err(|source| Failure::Usage(source.into()))?;
    let has_index = layout.axes().iter().any(|axis| axis.quantity.is_index());
    if has_index == (surface == EnergySurface::Reflector) {
        let reason = if has_index { "has no index" } else { "needs an axis of the index, such as sqrt_f0" };
        return Err(Failure::Usage(anyhow::anyhow!(
            "the surface {} {reason}: --axes {}",
            surface.name(),
            options.axes
        )));
    }
    let count = layout.axes().len();
    if options.size[count..].iter().any(|side| *side > 1) || options.size[..count].iter().any(|side| *side < 2) {
        return Err(Failure::Usage(anyhow::anyhow!(
            "--size states 2 nodes at least for each of the {count} axes and no more sides"
        )));
    }
    let [width, height, depth] = options.size.map(u64::from);
    if width * height * depth > MAX_NODES {
        return Err(Failure::Usage(anyhow::anyhow!(
            "--size states {width} x {height} x {depth} nodes; a table has {MAX_NODES} at most"
        )));
    }
    let (container, stored) = by_ending(&options.delivery.output)?;
    let table = EnergyTable {
        distribution: distribution(options.distribution),
        masking,
        surface,
        layout,
        size: options.size,
        values,
        stored,
        balanced: true,
        clear_within: 0.0,
    };
    let texels = table.bake();
    let (of, domain, quantities) = errors_count(options, &table);
    let error = table.error(&texels, of);
    let mut maps = Vec::new();
    if options.delivery.report.is_some() && quantities == ["cos_theta", "alpha"] {
        let ranges = [[of.min_cos.max(1e-3), 1.0], [of.min_alpha.max(1e-3), 1.0]];
        let worst = (error.max_abs_err, [error.worst.at[0], error.worst.at[1]]);
        maps.push(ErrorMap::sample("this table", ["cos_theta", "alpha"], ranges, worst, |[cos, alpha]| {
            table.error_at(&texels, cos, alpha)
        }));
    }
    let [width, height] = [texels.width, texels.height];
    let facts = vec![
        fact(
            "Model",
            format!("{} distribution, masking {}, {}", table.distribution.name(), masking.name(), surface.name()),
        ),
        fact("Axes", format!("{}, nodes at {}", table.layout, nodes_name(nodes(options.nodes)))),
        fact("Channels", options.values.join(", ")),
        fact("Texels", format!("{width} x {height}, {}", stored.name())),
    ];
    let product = Sampled {
        title: TITLE,
        words: words(&table),
        statement: statement(&table),
        texels: &texels,
        file: (container, stored),
        error: (error, &quantities, domain),
        max_abs: None,
        facts,
        maps,
        method: METHOD,
    };
    sampled(product, &options.delivery)
}

/// The smallest table of a metal.
fn searched(options: &EnergyOptions, max_abs: f64) -> Outcome<Product> {
    let (container, _) = by_ending(&options.delivery.output)?;
    if options.surface != EnergySurface::Reflector.name() || container == Container::Exr {
        let reason = "--max-abs searches tables of half floats of the surface reflector";
        return Err(Failure::Usage(anyhow::anyhow!("{reason}; state --axes and --size of others")));
    }
    let values = options.values.iter();
    let values = values.map(|name| find(&[Value::Albedo, Value::Loss], Value::name, "value of a search", name));
    let values = values.collect::<Outcome<Vec<_>>>()?;
    let known = [Masking::SmithCorrelated, Masking::SmithSeparable];
    let masking = find(&known, Masking::name, "masking term", &options.masking)?;
    let from = [options.domain.min_cos, options.domain.min_alpha];
    let Found { table, texels, error, held } =
        search(distribution(options.distribution), masking, &values, max_abs, from[0], from[1]);
    let domain = domain(from[0], from[1]);
    let [width, height] = table.size;
    if !held {
        return Err(Failure::Input(anyhow::anyhow!(
            "no table of half floats up to {width} x {height} holds {max_abs} over {domain}: the nearest errs by {:.2e}",
            error.max_abs_err
        )));
    }
    let names = values.iter().map(|value| value.name()).collect::<Vec<_>>();
    let (model, layout) = (table.distribution.name(), &table.layout);
    let maps = options.delivery.report.iter().map(|_| map("this table", &table, &texels, &error, from)).collect();
    let product = Sampled {
        title: TITLE,
        words: format!(
            "Energy of a reflector, {model}, masking {}; {} over {layout}, nodes at ends; {width} x {height}, half",
            masking.name(),
            names.join(",")
        ),
        statement: json!({
            "function": "energy", "surface": "reflector", "distribution": model, "masking": masking.name(), "axes": layout.to_string(),
            "nodes": "ends", "values": names, "size": table.size, "stored": "half",
        }),
        texels: &texels,
        file: (container, table.stored),
        error: (error, &["cos_theta", "alpha"], domain),
        max_abs: Some(max_abs),
        facts: vec![
            fact("Model", format!("{model} distribution, masking {}, reflector", masking.name())),
            fact("Axes", format!("{layout}, nodes at ends")),
            fact("Texels", format!("{width} x {height}, half: {} bytes", table.bytes())),
        ],
        maps,
        method: METHOD,
    };
    sampled(product, &options.delivery)
}

/// The one of a name.
fn find<T: Copy>(all: &[T], name_of: fn(T) -> &'static str, what: &str, name: &str) -> Outcome<T> {
    let names: Vec<&str> = all.iter().map(|one| name_of(*one)).collect();
    all.iter().copied().find(|one| name_of(*one) == name).ok_or_else(|| Failure::unknown(what, name, &names))
}

fn words(table: &EnergyTable) -> String {
    let EnergyTable { distribution, masking, surface, layout, size, values, stored, .. } = table;
    let values = values.iter().map(|value| value.name()).collect::<Vec<_>>().join(",");
    let size = size.iter().take(layout.axes().len()).map(u32::to_string).collect::<Vec<_>>().join(" x ");
    format!(
        "Energy of a {}, {}, masking {}; {values} over {layout}; {size}, {}",
        surface.name(),
        distribution.name(),
        masking.name(),
        Stored::name(*stored)
    )
}

fn statement(table: &EnergyTable) -> Json {
    json!({
        "function": "energy",
        "surface": table.surface.name(),
        "distribution": table.distribution.name(),
        "masking": table.masking.name(),
        "axes": table.layout.to_string(),
        "nodes": table.layout.axes().first().map(|axis| nodes_name(axis.nodes)),
        "values": table.values.iter().map(|value| value.name()).collect::<Vec<_>>(),
        "size": table.size,
        "stored": table.stored.name(),
    })
}
