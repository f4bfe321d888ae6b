//! How the figures came about: enough to repeat them, and to know what they do not say.

use std::fmt::Write;

use crate::format::{error, escape, number};
use crate::report::{Compared, Report};
use crate::table_terms::Weights;
use crate::{DIM_FLOOR, DirectionSet, PEAK_FRACTION};

pub(super) fn write(out: &mut String, report: &Report) {
    super::fold(
        out,
        "method",
        "Method",
        "references, directions and floors: what the figures say, and what they do not",
    );
    let _ = write!(
        out,
        "<p><b>Reference.</b> The model <code>{}</code> in f64 with exact Fresnel and distribution terms (of statistical models: directional \
         albedos from the micro-surface, and total reflection), at exactly the f32 directions that the shader gets. The baked shader and the tables are compared with terms \
         integrated over the spectrum (CIE 1931 2° observer, D65, to linear Rec.709), or taken at the material's three \
         wavelengths where its file asks for that; the full shader with terms at the material's three wavelengths, because that is what it \
         evaluates, and, of statistical models, with facets that count as level. The errors are those of tables and arithmetic, not of the model.</p>",
        escape(&report.model)
    );
    comparisons(out, report);
    let _ = write!(
        out,
        "<p><b>Relative errors</b> are |value − reference| / max(brightest channel of the reference, floor), every colour channel a \
         sample. The floor of the headline is {} in f cos θᵢ: a tenth of a white diffuser lit along its normal. \
         Below it an error of 10⁻³ is 10⁻⁴ of diffuse white, a third of the darkest step of an 8-bit sRGB picture \
         exposed for that white. Two other floors show what this one hides: {} (a thousandth of white) judges the \
         dark, {} of the peak of the set judges the highlight alone, and forgives everything else.</p>",
        number(report.floor),
        error(DIM_FLOOR),
        number(PEAK_FRACTION)
    );
    let _ = write!(
        out,
        "<p><b>Directions.</b> {} pairs in every set, from a Halton sequence; a later run draws the \
         same.</p><div class=\"scroll\"><table><tbody>",
        report.pairs_per_set
    );
    for set in DirectionSet::ALL {
        let _ = write!(out, "<tr><th>{}</th><td>{}</td></tr>", set.name(), escape(set.description()));
    }
    out.push_str("</tbody></table></div>");
    out.push_str(
        "<p><b>Tables</b> are scanned from the shipped texels: Fresnel rows at eight points a cell and 256 grazing \
         cosines against every interface that reads them, distributions at one point in every cell, phase rows at \
         eight points a cell against the closed form, shares that escape total reflection on a grid over the same domain as albedos, albedos at some dozen points against an estimate of their own. \
         Formats that a sampler filters are read with 8-bit weights; others exactly, as shaders fetch them. Values and \
         weights are otherwise f64.</p><p><b>Exceptions.</b> For a pair that misses the target, the f64 model is \
         evaluated again with exact terms but for one, which is read from the tables: the Fresnel term, the \
         distribution and so on of each layer in turn. What the device adds to f64 on the same tables is f32 arithmetic. The \
         largest of these is the cause.</p><p><b>Not judged here:</b> the model against nature; pairs below the \
         horizon; film thickness maps, which the reference takes at their nominal value.</p>\n",
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
            Compared::TablesExact => "the same with exact weights".to_owned(),
            Compared::Arithmetic => {
                format!(
                    "the table-reading shader on the device, against f64 arithmetic on the same texels with {weights}"
                )
            }
            Compared::FullDevice => {
                "the table-free shader on the device, against exact terms at three wavelengths".to_owned()
            }
            Compared::ThreeWavelengths => {
                "no error: exact terms at three wavelengths against exact spectral terms, both in f64".to_owned()
            }
        };
        let _ = write!(out, "<tr><th>{}</th><td>{words}</td></tr>", compared.name());
    }
    out.push_str("</tbody></table></div>");
}
