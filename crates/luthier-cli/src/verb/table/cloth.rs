//! `table cloth`: the directional albedo of Charlie's distribution.

use luthier_optics::split_sum::Masking;
use luthier_optics::stack::Distribution;
use luthier_report::Certificate;
use luthier_table::{DfgTable, Layout, Value};
use luthier_terminal::{Failure, Outcome};
use serde_json::json;

use super::container::{by_ending, encode};
use super::dfg::map;
use super::product::{Product, domain, error_facts, error_json, error_text, fact, nodes, nodes_name};
use crate::cli::{ClothName, ClothOptions};

const QUANTITIES: [&str; 2] = ["cos_theta", "alpha"];

/// Bakes the table that the options ask for.
pub(super) fn product(options: &ClothOptions) -> Outcome<Product> {
    let grid = &options.grid;
    let (value, visibility) = match options.visibility {
        ClothName::Neubelt => (Value::Cloth, "Neubelt"),
        ClothName::EstevezKulla => (Value::Sheen, "Estevez and Kulla"),
    };
    let layout = Layout::parse(&grid.axes, nodes(grid.nodes)).map_err(|source| Failure::Usage(source.into()))?;
    let (container, stored) = by_ending(&options.delivery.output)?;
    // The distribution and the masking are of split sums, which this table does not hold.
    let (distribution, masking) = (Distribution::Ggx, Masking::SmithCorrelated);
    let table = DfgTable { distribution, masking, layout, values: vec![value], size: grid.size, stored, base: None };
    let texels = table.bake();
    let from = [options.domain.min_cos, options.domain.min_alpha];
    let error = table.error(&texels, from[0], from[1]);
    let domain = domain(from[0], from[1]);
    let [width, height] = grid.size;
    let at = nodes_name(nodes(grid.nodes));
    let words = format!(
        "Albedo of cloth, Charlie, visibility of {visibility}, over {layout}, nodes at {at}; {width} x {height}, {}",
        stored.name()
    );
    let statement = json!({
        "function": "cloth", "distribution": "charlie", "visibility": visibility, "axes": layout.to_string(), "nodes": at,
        "values": [value.name()], "size": grid.size, "stored": stored.name(),
    });
    let measured = error_json(&error, &domain);
    let metadata = json!({ "table": statement, "error": measured }).to_string();
    let bytes = encode(container, &texels, stored, &words, &metadata, options.delivery.no_zstd)?;
    let maps = options.delivery.report.iter().map(|_| map("this table", &table, &texels, &error, from)).collect();
    let mut facts = vec![
        fact("Model", format!("Charlie's distribution, visibility of {visibility}")),
        fact("Axes", format!("{layout}, nodes at {at}")),
        fact("Texels", format!("{width} x {height}, {}", stored.name())),
    ];
    facts.extend(error_facts(&error, &QUANTITIES));
    facts.push(fact("Domain", domain.clone()));
    let certificate = Certificate {
        title: "Table of cloth".to_owned(),
        verdict: (format!("largest error as sampled {:.2e}", error.max_abs_err), None),
        facts,
        maps,
        method: "Reads are bilinear with 8-bit weights and texels as stored. They are compared with quadrature over directions, which is within 1e-6 \
                 of the albedo or of 1, whichever is larger. The albedo exceeds 1 where light grazes smooth cloth: Charlie's lobe is not energy-conserving there."
            .to_owned(),
    };
    let text = format!("{words}\n{}", error_text(&error, &QUANTITIES, &domain));
    let json = json!({ "table": statement, "error": measured });
    Ok(Product { files: vec![(options.delivery.output.clone(), bytes)], certificate, json, text })
}
