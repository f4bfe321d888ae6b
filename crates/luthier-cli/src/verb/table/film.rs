//! `table film`: the colour that an interface reflects under a thin film.

use luthier_optics::color::Color;
use luthier_optics::num_complex::Complex64;
use luthier_report::ErrorMap;
use luthier_table::{FilmLayout, FilmTable};
use luthier_terminal::{Failure, Outcome};
use serde_json::json;

use super::container::by_ending;
use super::product::{Product, Sampled, fact, nodes, nodes_name, sampled};
use crate::cli::FilmOptions;

/// Wavelengths of the three-wavelength values, nm: CONVENTIONS.md.
const WAVELENGTHS: [f64; 3] = [680.0, 550.0, 440.0];
const QUANTITIES: [&str; 2] = ["cos_theta", "thickness_nm"];

/// Bakes the table that the options ask for.
pub(super) fn product(options: &FilmOptions) -> Outcome<Product> {
    let layout =
        FilmLayout::parse(&options.axes, nodes(options.nodes)).map_err(|source| Failure::Usage(source.into()))?;
    let (container, stored) = by_ending(&options.delivery.output)?;
    let [film, below] = [options.film, options.base].map(|[n, k]| Complex64::new(n, k));
    let color = if options.three_wavelengths { Color::ThreeWavelengths(WAVELENGTHS) } else { Color::Spectral };
    let colour = if options.three_wavelengths { "three wavelengths" } else { "spectral, D65" };
    let table = FilmTable { above: options.above, film, below, color, layout, size: options.size, stored };
    let texels = table.bake();
    let error = table.error(&texels, options.min_cos);
    let [width, height] = options.size;
    let indices = format!("{} / {film} / {below}", options.above);
    let words =
        format!("Thin film, indices {indices}, {colour}; RGB over {layout}; {width} x {height}, {}", stored.name());
    let statement = json!({
        "function": "film",
        "above": options.above, "film": options.film, "base": options.base, "color": colour,
        "axes": layout.to_string(), "nodes": nodes_name(nodes(options.nodes)), "values": ["r", "g", "b"],
        "size": options.size, "stored": stored.name(),
    });
    let mut maps = Vec::new();
    if options.delivery.report.is_some() {
        let [least, most] = table.thicknesses();
        let ranges = [[options.min_cos.max(1e-3), 1.0], [least.max(0.01 * most), most]];
        let worst = (error.max_abs_err, [error.worst.at[0], error.worst.at[1]]);
        let error_at = table.errors(&texels);
        maps.push(ErrorMap::sample("this table", QUANTITIES, ranges, worst, |[cos, thickness]| {
            error_at(cos, thickness)
        }));
    }
    let facts = vec![
        fact("Indices", format!("above {}, film {film}, below {below}", options.above)),
        fact("Colour", format!("linear Rec.709, {colour}")),
        fact("Axes", format!("{layout}, nodes at {}", nodes_name(nodes(options.nodes)))),
        fact("Texels", format!("{width} x {height}, {}", stored.name())),
    ];
    let table = Sampled {
        title: "Table of a thin film",
        words,
        statement,
        texels: &texels,
        file: (container, stored),
        error: (error, &QUANTITIES, format!("cos_theta >= {}", options.min_cos)),
        max_abs: None,
        facts,
        maps,
        method: "Reads are bilinear with 8-bit weights and texels as stored. They are compared with the sum of all interference (Airy) at every \
                 wavelength. A map shows the largest error of all channels; a circle marks the largest of the scan.",
    };
    sampled(table, &options.delivery)
}
