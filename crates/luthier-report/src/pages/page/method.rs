//! The section on method: references, directions and floors, so that a reader can repeat the figures and knows their limits.

use std::fmt::Write;

use crate::judge::report::{Compared, Report};
use crate::measure::directions::DirectionSet;
use crate::measure::statistics::{DIM_FLOOR, PEAK_FRACTION};
use crate::measure::table_terms::Weights;
use crate::text::format::{error, escape, number};

pub(super) fn write(out: &mut String, report: &Report) {
    super::fold(out, "method", "Method", "references, directions and floors");
    let _ = write!(
        out,
        "<p><b>Reference.</b> The model <code>{}</code> in f64, at exactly the f32 directions that the shader gets. It has exact Fresnel and distribution terms; a statistical model \
         has directional albedos from the micro-surface and exact total reflection. The reference of the baked shader and of the tables integrates these terms over the \
         spectrum (CIE 1931 2° observer, D65, to linear Rec.709), or takes them at three wavelengths if the material file asks for that. The reference of the \
         full shader takes them at three wavelengths, as the shader does; in a statistical model it takes facets as level. The errors are those of tables \
         and arithmetic, not those of the model.</p>",
        escape(&report.model)
    );
    comparisons(out, report);
    let _ = write!(
        out,
        "<p><b>Relative errors</b> are |value − reference| / max(brightest channel of the reference, floor). Every colour channel is a \
         sample. The floor of the main figures is {} in f cos θᵢ: a tenth of a white diffuser lit along its normal. \
         Below it an error of 10⁻³ is 10⁻⁴ of diffuse white, a third of the darkest step of an 8-bit sRGB picture \
         exposed for that white. Two other floors show what the main one hides. The floor of {} (a thousandth of white) shows errors in the \
         dark. The floor of {} of the peak of the set shows errors of the highlight alone.</p>",
        number(report.floor),
        error(DIM_FLOOR),
        number(PEAK_FRACTION)
    );
    let _ = write!(
        out,
        "<p><b>Directions.</b> Every set has {} pairs, from a Halton sequence, so that every run draws the \
         same pairs.</p><div class=\"scroll\"><table><tbody>",
        report.pairs_per_set
    );
    for set in DirectionSet::ALL {
        let _ = write!(out, "<tr><th>{}</th><td>{}</td></tr>", set.name(), escape(set.description()));
    }
    out.push_str("</tbody></table></div>");
    out.push_str(
        "<p><b>Tables</b> are compared with their functions as the texels store them. Fresnel rows are read at eight points a cell and at 256 grazing \
         cosines, and compared with every interface that reads them; distributions are read at one point in every cell; phase rows at \
         eight points a cell, against the closed form; film tiles at 96 cosines and 96 thicknesses, against the interfaces that read them. Shares that escape total reflection are read on a grid over the range of the albedos. Albedos are read at some dozen points, and compared with an estimate that does not use the baker's. \
         Formats that a sampler filters are read with 8-bit weights, others with exact weights, as shaders fetch them. All other \
         arithmetic is f64.</p><p><b>Exceptions.</b> For a pair that misses the target, the f64 model is \
         evaluated again with one term read from the tables and all others exact: the Fresnel term, the \
         distribution and so on of each layer in turn. The difference between the device and f64 on the same tables is the error of f32 arithmetic. The \
         largest of these errors is the cause.</p><p><b>The report does not judge</b> the model against nature, pairs below the \
         horizon, or film thickness maps, which the reference takes at their nominal value.</p>\n",
    );
    super::end_fold(out);
}

fn comparisons(out: &mut String, report: &Report) {
    let weights = match report.device_weights {
        Some(Weights::Exact) => "exact interpolation weights, which explain this device better than 8-bit ones",
        Some(Weights::EightBit) => "8-bit interpolation weights, which explain this device better than exact ones",
        None => "the weights of the device",
    };
    let made: Vec<Compared> =
        report.materials.first().map_or(Vec::new(), |m| m.comparisons.iter().map(|c| c.compared).collect());
    out.push_str("<div class=\"scroll\"><table><tbody>");
    for compared in made {
        let words = match compared {
            Compared::BakedDevice => "the table-reading shader on the device, against exact terms".to_owned(),
            Compared::TablesEightBit => {
                "f64 arithmetic on the shipped texels, filtered with 8-bit weights, against exact terms".to_owned()
            }
            Compared::TablesExact => {
                "f64 arithmetic on the shipped texels, filtered with exact weights, against exact terms".to_owned()
            },
            Compared::Arithmetic => {
                format!(
                    "the table-reading shader on the device, against f64 arithmetic on the same texels with {weights}"
                )
            }
            Compared::FullDevice => {
                "the table-free shader on the device, against exact terms at three wavelengths".to_owned()
            }
            Compared::ThreeWavelengths => {
                "exact terms at three wavelengths against exact spectral terms, both in f64; a property of the material, not an error of the bake".to_owned()
            }
        };
        let _ = write!(out, "<tr><th>{}</th><td>{words}</td></tr>", compared.name());
    }
    out.push_str("</tbody></table></div>");
}
