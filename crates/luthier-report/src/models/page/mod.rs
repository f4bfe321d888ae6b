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

fn list(numbers: &[f64]) -> String {
    numbers.iter().map(f64::to_string).collect::<Vec<_>>().join(", ")
}

fn preamble(report: &ModelsReport, command: &str) -> String {
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

This page gives the error of every model of layers that `luthier models` lists, on every material. The reference is `layered-mc`, a Monte Carlo
simulation of the whole stack in which paths walk between the facets of rough interfaces. `microfacet` and `phong` are listed too, to show the error
of a model of one layer alone. This command makes the whole page:

    {command}

Errors are measured in *views*. A view has one of a material's three wavelengths ({wavelengths} nm), and looks at the surface from {thetas} degrees
to the normal, at azimuth {phi_deg}. Absorption and diffuse albedo are those of the colour channel of the wavelength. The tables show the worst view.
For each view the reference traces {samples} paths from the eye, seed {seed}. A model is integrated over all light directions.

- *Albedo error*: |a - a_ref|, where a is the directional albedo: the part of uniform unit light that the surface reflects to the eye.
- *Lobe error*: 1/2 sum |e_k - r_k| / a_ref, where e_k and r_k are the energies of the model and of the reference in {CELLS} cells of the
  hemisphere. It adds two parts: the share of the reference's light that the model sends into other directions, and half of the light that the model
  lacks or has too much. A perfect lobe has the error 0, a black model 1/2, and a lobe of the right energy in the wrong place 1. The error of
  too much light has no upper bound.

Cells are drawn around the mirror direction, by the half vector between light and eye: a disc of {first} degrees, then {rings} rings
up to {last} degrees from the normal, each about sqrt(2) times as wide as the one before, in {SECTORS} sectors. In the reference, smooth interfaces
reflect into a single direction. Models show them as lobes of their smallest roughness: alpha 0.001 in Elek's models, 0.0001 in all others. The
single direction and the lobe (but for 1.3 % of the wider lobe) lie in the disc, so that a mirror counts the same in both.

*±* is half the 95 % interval of the reference's noise, plus the change of the model's integral when its points were last
doubled. It is the largest of its row. *Noise* is the lobe error that a perfect model would show on average.

Two entries are not models: they check the reference itself. `layered-mc-one-facet` is the reference without bounces between the facets of one
interface: the light that a second facet blocks is lost, as most models assume. It measures the error of that assumption. `{CONTROL}` is the reference
with other random numbers, and measures the noise. Both trace 1/{FEWER} of the paths, and so have more noise than the reference.

`flakes` and `patina` are evaluated with the parameters that `luthier models` states, on every material. Models that leave layers out are still judged
against the whole material. The smallest error of a material is bold; among equal printed errors, the first one is.
",
        wavelengths = wavelengths.join(" or "),
        thetas = list(&report.thetas_deg),
    )
}
