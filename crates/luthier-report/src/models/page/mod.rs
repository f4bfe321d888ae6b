//! The page of the judge of models, in Markdown.

mod findings;
mod tables;

use std::collections::BTreeSet;

use super::cells::{CELLS, RINGS_DEG, SECTORS};
use super::{CONTROL, FEWER, ModelsReport};

/// The whole page.
pub(super) fn page(report: &ModelsReport, command: &str) -> String {
    let mut out = preamble(report, command);
    out.push_str(&findings::findings(report));
    out.push_str(&tables::best(report));
    out.push_str("\n## Albedo error\n");
    out.push_str(&tables::errors(report, tables::Kind::Albedo));
    out.push_str("\n## Lobe error\n");
    out.push_str(&tables::errors(report, tables::Kind::Lobe));
    out
}

fn preamble(report: &ModelsReport, command: &str) -> String {
    let list = |numbers: &[f64]| numbers.iter().map(f64::to_string).collect::<Vec<_>>().join(", ");
    let mut wavelengths = BTreeSet::new();
    for material in &report.materials {
        wavelengths.insert(list(&material.wavelengths_nm));
    }
    let wavelengths: Vec<String> = wavelengths.into_iter().collect();
    let (first, last) = (RINGS_DEG[0], RINGS_DEG[RINGS_DEG.len() - 1]);
    let rings = RINGS_DEG.len() - 1;
    let ModelsReport { samples, seed, phi_deg, .. } = report;
    format!(
        "# The models against the reference

How far every model of layers that `luthier models` lists is from `layered-mc`, the Monte Carlo of the whole stack that walks between the
facets of rough interfaces; `microfacet` and `phong` stand beside them for what one layer alone does. Every line of this page is made by

    {command}

A *view* is one of a material's three wavelengths ({wavelengths} nm; absorption and diffuse albedo are those of the
channel of the wavelength) seen at {thetas} degrees from the normal, at azimuth {phi_deg}. Tables show the worst view. For each the reference
traces {samples} paths from the eye, seed {seed}; a model is integrated over all light directions.

- *Albedo error*: |a - a_ref|, a being the directional albedo, the part of unit light from everywhere that reaches the eye.
- *Lobe error*: 1/2 sum |e_k - r_k| / a_ref, over the energies e of the model and r of the reference in {CELLS} cells of the
  hemisphere: the share of the reference's light that goes elsewhere, and half of what is missing or too much. The same lobe has 0, a
  black model 1/2, a lobe of the right energy that goes elsewhere 1; too much light has no limit.

Cells are drawn around the mirror direction, by the half vector between light and eye: a disc of {first} degrees, then {rings} rings
up to {last} degrees from the normal, each about sqrt(2) times as wide as the one before, in {SECTORS} sectors. Smooth interfaces
reflect into a single direction in the reference; models show them as lobes of their smallest roughness, alpha 0.0001 or, Elek's
models, 0.001. Both end in the albedo and in the disc (all but 1.3 % of the wider lobe), so that a mirror counts the same either way.

*±* is half the 95 % interval of the reference's noise, plus what the model's quadrature changed by when its points were last
doubled: the largest of a row. *Noise* is the lobe error that a perfect model would show on average.

Two rows are no models. `layered-mc-one-facet` is the reference without bounces between facets of the same interface (what is blocked
is lost), as most models assume. `{CONTROL}` is the reference against itself. Both have 1/{FEWER} of the paths, so more
noise. `flakes` and `patina` stand for what `luthier models` says, on every material; models that leave layers out are judged on the
whole material all the same. The smallest error of a material is bold, the first of those
that are equal as printed.
",
        wavelengths = wavelengths.join(" or "),
        thetas = list(&report.thetas_deg),
    )
}
