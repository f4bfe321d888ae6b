//! `table sheen`: linearly transformed cosines of a layer of fibres.

use luthier_report::Certificate;
use luthier_table::SheenTable;
use luthier_terminal::Outcome;
use serde_json::json;

use super::container::{by_ending, encode};
use super::ltc::{error_json, in_words};
use super::product::{Product, fact};
use crate::cli::SheenOptions;

/// Least albedo that counts. A lobe that reflects less may have any shape.
const MIN_ALBEDO: f64 = 1e-3;

/// Bakes the table.
pub(super) fn product(options: &SheenOptions) -> Outcome<Product> {
    let (container, stored) = by_ending(&options.delivery.output)?;
    let table = SheenTable { stored, ..SheenTable::of_engines() };
    let texels = table.bake();
    let [lobe, albedo] = table.error_between_texels(&texels, MIN_ALBEDO);
    let [width, height] = table.size;
    let words = format!(
        "Sheen, layer of fibres, linearly transformed cosines; a,b,albedo over {}, nodes at ends; {width} x {height}, {}",
        table.layout,
        stored.name()
    );
    let domain = format!("albedo >= {MIN_ALBEDO}");
    let statement = json!({
        "function": "sheen", "axes": table.layout.to_string(), "nodes": "ends", "values": ["a", "b", "albedo"], "size": table.size,
        "stored": stored.name(),
    });
    let measured = json!({ "domain": domain, "lobe": error_json(&lobe), "albedo": error_json(&albedo) });
    let metadata = json!({ "table": statement, "error": measured }).to_string();
    let bytes = encode(container, &texels, stored, &words, &metadata, options.delivery.no_zstd)?;
    let facts = vec![
        fact("Table", words.clone()),
        fact("Energy, between texels", in_words(&lobe)),
        fact("Albedo, between texels", in_words(&albedo)),
        fact("Domain", domain.clone()),
    ];
    let certificate = Certificate {
        title: "Table of sheen".to_owned(),
        verdict: (format!("half of all reads err by less than {:.2e} of the light, 95 % by less than {:.2e}", lobe.median, lobe.p95), None),
        facts,
        maps: Vec::new(),
        method: "The error of a lobe is half the L1 distance of the light that lobe and layer reflect, over the albedo. The layer is computed by adding and \
                 doubling. The alpha of places is the cross section of the fibres, the square of the roughness."
            .to_owned(),
    };
    let text = format!(
        "{words}\nenergy: {}\nalbedo: {}\n  over {domain}; bilinear, 8-bit weights, half-way between texels\n",
        in_words(&lobe),
        in_words(&albedo)
    );
    let json = json!({ "table": statement, "error": measured });
    Ok(Product { files: vec![(options.delivery.output.clone(), bytes)], certificate, json, text })
}
