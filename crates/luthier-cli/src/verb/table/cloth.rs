//! `table cloth`: the directional albedo of Charlie's distribution.

use luthier_optics::split_sum::Masking;
use luthier_optics::stack::Distribution;
use luthier_table::{DfgTable, Layout, Value};
use luthier_terminal::{Failure, Outcome};
use serde_json::json;

use super::container::by_ending;
use super::dfg::map;
use super::product::{Product, Sampled, domain, fact, nodes, nodes_name, sampled};
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
    let maps = options.delivery.report.iter().map(|_| map("this table", &table, &texels, &error, from)).collect();
    let facts = vec![
        fact("Model", format!("Charlie's distribution, visibility of {visibility}")),
        fact("Axes", format!("{layout}, nodes at {at}")),
        fact("Texels", format!("{width} x {height}, {}", stored.name())),
    ];
    let table = Sampled {
        title: "Table of cloth",
        words,
        statement,
        texels: &texels,
        file: (container, stored),
        error: (error, &QUANTITIES, domain(from[0], from[1])),
        max_abs: None,
        facts,
        maps,
        method: "Reads are bilinear with 8-bit weights and texels as stored. They are compared with quadrature over directions, which is within 1e-6 \
                 of the albedo or of 1, whichever is larger. The albedo exceeds 1 where light grazes smooth cloth: Charlie's lobe is not energy-conserving there.",
    };
    sampled(table, &options.delivery)
}
