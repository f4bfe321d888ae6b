//! `table fresnel`: the reflectance of any smooth surface, over angle, n and k.

use luthier_report::ErrorMap;
use luthier_table::{FresnelLayout, FresnelTable, Quantity};
use luthier_terminal::{Failure, Outcome};
use serde_json::json;

use super::container::by_ending;
use super::look_up;
use super::product::{Product, Sampled, fact, nodes, nodes_name, sampled};
use crate::cli::FresnelOptions;

const QUANTITIES: [&str; 3] = ["cos_theta", "ior_n", "ior_k"];

/// Bakes the table that the options ask for.
pub(super) fn product(options: &FresnelOptions) -> Outcome<Product> {
    let nodes = nodes(options.nodes);
    let layout = FresnelLayout::parse(&options.axes, nodes).map_err(|source| Failure::Usage(source.into()))?;
    let (container, stored) = by_ending(&options.delivery.output)?;
    let table = FresnelTable { layout, size: options.size, stored };
    let texels = table.bake();
    let error = table.error(&texels, options.min_cos);
    let [width, rows, slices] = options.size;
    let size = format!("{width} x {rows} x {slices}, {}", stored.name());
    let statement = json!({
        "function": "fresnel", "axes": layout.to_string(), "nodes": nodes_name(nodes), "values": ["reflectance"],
        "size": options.size, "stored": stored.name(),
    });
    let mut maps = Vec::new();
    if options.delivery.report.is_some() {
        let ranges = [Quantity::IorN, Quantity::IorK].map(|quantity| {
            let axis = layout.axes().iter().find(|axis| axis.quantity == quantity);
            axis.map_or([0.0; 2], |axis| [axis.min.max(1e-3 * axis.max), axis.max])
        });
        let [cos, n, k] = [0, 1, 2].map(|i: usize| error.worst.at[i]);
        let exact = FresnelTable::exact;
        let title = format!("this table, at cos_theta {cos:.3}");
        maps.push(ErrorMap::sample(&title, ["ior_n", "ior_k"], ranges, (error.max_abs_err, [n, k]), |[n, k]| {
            (table.sample(&texels, [cos, n, k]) - exact([cos, n, k])).abs()
        }));
    }
    let facts = vec![
        fact("Surface", "smooth, of index n + ik, in air; unpolarised light"),
        fact("Axes", format!("{layout}, nodes at {}", nodes_name(nodes))),
        fact("Texels", format!("{size}; slices of the third axis one below the other")),
    ];
    let product = Sampled {
        title: "Table of reflectances",
        words: format!("Fresnel's reflectance of any index; {layout}, nodes at {}; {size}", nodes_name(nodes)),
        statement,
        texels: &texels,
        file: (container, stored),
        error: (error, &QUANTITIES, format!("cos_theta >= {}, all n and k of the axes", options.min_cos)),
        max_abs: None,
        facts,
        maps,
        method: "Reads are linear along each axis with 8-bit weights and texels as stored. They are compared with Fresnel's equations. The map shows \
                 the slice of the worst angle; a circle marks the largest error of the scan.",
    };
    let mut product = sampled(product, &options.delivery)?;
    if !options.shader.is_empty() {
        let reason = "this layout has no look-up";
        let bindings = look_up::bindings(options.bind);
        let text = table.wgsl(bindings).ok_or_else(|| Failure::Usage(anyhow::anyhow!(reason)))?;
        product.files.extend(look_up::beside(&options.delivery.output, &options.shader, &text)?);
    }
    Ok(product)
}
