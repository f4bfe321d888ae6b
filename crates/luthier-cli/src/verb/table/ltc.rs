//! `table ltc`: linearly transformed cosines of a rough metal.

use luthier_optics::masking::Correlation;
use luthier_report::Certificate;
use luthier_table::{Container, LtcError, LtcTable, PlacedError};
use luthier_terminal::{Failure, Outcome};
use serde_json::{Value as Json, json};

use super::container::encode;
use super::product::{Product, distribution, fact};
use crate::cli::LtcOptions;

/// Lowest cosine and alpha that count. Below these, a bilinear read on engines' axes yields no lobe as narrow as the reflection.
const FROM: [f64; 2] = [0.02, 0.002];

/// Fits the tables.
pub(super) fn product(options: &LtcOptions) -> Outcome<Product> {
    let masking = match options.masking.as_str() {
        "correlated" => Correlation::Height,
        "separable" => Correlation::Separable,
        other => return Err(Failure::unknown("masking term", other, &["correlated", "separable"])),
    };
    let table = LtcTable { masking, ..LtcTable::of_engines(distribution(options.distribution)) };
    let texels = table.bake();
    let between = table.error_between_texels(&texels, FROM[0], FROM[1]);
    let at = table.error_at_texels(&texels, FROM[0], FROM[1]);
    let light = table.irradiance_error(&texels);
    let domain = format!("cos_theta >= {}, alpha >= {}", FROM[0], FROM[1]);
    let [width, height] = table.size;
    let words = format!(
        "Linearly transformed cosines, {}, masking {}; over {}, nodes at ends; {width} x {height}, {}",
        table.distribution.name(),
        options.masking,
        table.layout,
        table.stored.name()
    );
    let measured = json!({
        "domain": domain, "at_texels": error_json(&at), "between_texels": error_json(&between),
        "rectangles_absolute": error_json(&light.absolute), "rectangles_relative": error_json(&light.relative),
    });
    let statement = json!({
        "function": "ltc", "distribution": table.distribution.name(), "masking": options.masking, "axes": table.layout.to_string(), "nodes": "ends",
        "size": table.size, "stored": table.stored.name(),
    });
    let folder = &options.delivery.output;
    let mut files = Vec::new();
    let contents = [
        ("ltc_1.ktx2", &texels.matrices, json!(["m11", "m31", "m13", "m33"])),
        ("ltc_2.ktx2", &texels.norms, json!(["albedo", "bias", "zero", "clipped_sphere"])),
    ];
    for (name, image, values) in contents {
        let mut statement = statement.clone();
        statement["values"] = values;
        let metadata = json!({ "table": statement, "error": measured }).to_string();
        let bytes = encode(Container::Ktx2, image, table.stored, &words, &metadata, options.delivery.no_zstd)?;
        files.push((folder.join(name), bytes));
    }
    let rows = [
        ("Energy, at texels", at),
        ("Energy, between texels", between),
        ("Light of rectangles, absolute", light.absolute),
        ("Light of rectangles, relative", light.relative),
    ];
    let mut facts = vec![fact("Table", words.clone()), fact("Domain", domain.clone())];
    facts.extend(rows.map(|(name, error)| fact(name, in_words(&error))));
    let certificate = Certificate {
        title: "Linearly transformed cosines".to_owned(),
        verdict: (format!("half of all reads err by less than {:.2e} of the light, 95 % by less than {:.2e}", between.median, between.p95), None),
        facts,
        maps: Vec::new(),
        method: "The error of a lobe is half the L1 distance of the light that lobe and BRDF reflect, over the albedo: no light errs by more. Rectangles are \
                 lights of radiance 1: the closed form of the lobe against quadrature of the BRDF over their area."
            .to_owned(),
    };
    let lines: String = rows.iter().map(|(name, error)| format!("{name}: {}\n", in_words(error))).collect();
    let text = format!("{words}\n{lines}  over {domain}; bilinear, 8-bit weights\n");
    Ok(Product { files, certificate, json: json!({ "table": statement, "error": measured }), text })
}

/// An error of many places, in words.
pub(super) fn in_words(error: &LtcError) -> String {
    let LtcError { median, p95, max: PlacedError { error, cos_theta_o, alpha } } = *error;
    format!(
        "median {median:.4}, 95 % below {p95:.4}, largest {error:.4} at cos_theta {cos_theta_o:.3}, alpha {alpha:.4}"
    )
}

/// An error of many places, for JSON.
pub(super) fn error_json(error: &LtcError) -> Json {
    let LtcError { median, p95, max: PlacedError { error, cos_theta_o, alpha } } = *error;
    json!({ "median": median, "p95": p95, "max": error, "cos_theta": cos_theta_o, "alpha": alpha })
}
