//! The page of `coats`.

use std::fmt::Write as _;

use luthier_report::ViewError;

use super::cases::Group;
use super::{COS_MIN, ENGINES, Judged, OWN, PAIRS, Result};
use crate::cli::CoatsOptions;

/// Sources of formulas: words that are typed to the letter, and choices.
const SOURCES: &str = "
## What is to the letter

| formula | source | to the letter | chosen here |
|---|---|---|---|
| glTF | glTF 2.0, appendix B; `KHR_materials_clearcoat` | coat mixed over the base by Schlick's reflectance at the eye's cosine; masking as B.3.2 prints it, a product | nothing; viewers take the correlated masking |
| Filament | `surface_shading_model_standard.fs`, `surface_brdf.fs` | Kelemen's masking, F0 below index 1.5, the base at least as rough as the coat, factor of energy | integrals of albedos in place of a table |
| Disney | `disney.brdf` of wdas/brdf | a quarter of GTR1 added by design, nothing taken from the base | `clearcoatGloss` beyond its range for slope parameters above .1 |
| Standard Surface | `standard_surface.mtlx`, MaterialX 1.39 | the graph, the GLSL nodes with their fit of albedos, `artistic_ior` with a white edge; `coat_affect_color` and `coat_affect_roughness`, which would darken and roughen the base, at their default of 0 | exact conductors |
| albedo scaling | Cycles' Principled BSDF: `closure.h`, `bsdf_util.h` and `bsdf_microfacet.h` of Blender; Kulla and Conty 2017 | the base times 1 less the albedo of the coat; energy preserved in all lobes | integrals in place of tables |
| OpenPBR | `open_pbr_surface.mtlx`, MaterialX 1.39 | the graph with its roughening and darkening, the GLSL nodes | `coat_ior` 1.5 in place of 1.6 |
| Adobe | adobe/openpbr-bsdf, a29da969 | both passages through the coat, its own roughening and darkening, light between facets of metals | integrals in place of tables, masking as a product |
";

const INTRODUCTION: &str = "\
Engines draw a clear coat by formulas. This page transcribes seven of them from their sources (`crates/luthier-lab/src/coats`, one file for each, which says what is to the letter, what the source leaves open, and where a choice had to be
taken), and compares them with the simulation, as [lobes.md](lobes.md) compares fits: with the errors of that page, at six angles of the eye, 0, 30, 45, 60, 70 and 80 degrees, and three channels.

The coat is clear, of index 1.5, with slope parameter .05, .2 or .4. Bases have slope parameter .1 or .3: grey metal of F0 .7 and copper of (.95, .6, .4); plastics of colour .8 and (.4, .25, .12), with F0 .04; copper with `metallic` .5. Bases reflect by
that F0 also below the coat, and their colour is what they show without one: the last two tables have the errors of formulas there, which are no fault of the coat. Filament, OpenPBR and Adobe's code make F0 relative to the coat on purpose, so that a base of index 1.5 reflects nothing there: a part of
their error is this difference of meaning. So is the roughness: every formula gets that of the base below the coat, and an author who looks through a coat may mean what is seen. Both are dials; [formats.md](formats.md) has what remains when they are fitted. A mixture is one interface with an F0 half way, as luthier reads a number `metallic = 0.5`: glTF, Standard Surface and OpenPBR blend two surfaces, so that this group measures that difference, too. Random places are six of
other colours and slope parameters, metals and plastics by turns, as texels have them; `lobes` is fitted to each.

The simulation refracts at every facet, so that a smooth coat makes the lobe of a metal wider by its index, and light that meets the coat from below beyond 41.8 degrees goes back. Formulas that have neither are too sharp and too bright.
";

/// Median and largest.
fn ranks(mut values: Vec<f64>) -> [f64; 2] {
    values.sort_by(f64::total_cmp);
    [values.get(values.len() / 2).copied().unwrap_or(0.0), values.last().copied().unwrap_or(0.0)]
}

fn names() -> impl Iterator<Item = &'static str> {
    ENGINES.iter().map(|engine| engine.name).chain(OWN)
}

/// Views of a model in groups.
fn views<'a>(
    results: &'a [Result],
    number: usize,
    groups: &'a [Group],
    of: fn(&Judged) -> &Vec<ViewError>,
) -> impl Iterator<Item = &'a ViewError> {
    results.iter().filter(|result| groups.contains(&result.group)).flat_map(move |result| of(&result.models[number]))
}

/// Cells of a row: signed mean, median and largest albedo error; median and largest lobe error.
fn cells<'a>(views: impl Iterator<Item = &'a ViewError>) -> ([f64; 5], String) {
    let views: Vec<&ViewError> = views.collect();
    let signed: f64 = views.iter().map(|view| view.albedo_model - view.albedo_reference).sum();
    let [middle, most] = ranks(views.iter().map(|view| view.albedo.error).collect());
    let [lobe, lobe_most] = ranks(views.iter().map(|view| view.lobe.error).collect());
    let all = [signed / views.len().max(1) as f64, middle, most, lobe, lobe_most];
    (all, format!("{:+.3} | {middle:.3} | {most:.3} | {lobe:.3} | {lobe_most:.3}", all[0]))
}

/// Groups with a coat that shows in pictures.
pub(super) const COATED: [Group; 4] = [Group::Metal, Group::Plastic, Group::Mixture, Group::Place];

pub(super) fn page(results: &[Result], options: &CoatsOptions) -> std::result::Result<String, std::fmt::Error> {
    let mut out = String::new();
    writeln!(out, "# Coats of engines\n\nGenerated by `luthier-lab coats --noise {}`.\n", options.precision.noise)?;
    out.push_str(INTRODUCTION);
    out.push_str("\nThe mean of an albedo error has a sign: + where a formula is too bright. Medians and largest errors have none.\n");
    errors(&mut out, "All coats", results, &COATED)?;
    for group in [Group::Metal, Group::Plastic, Group::Mixture, Group::Place, Group::Bare, Group::BareMixture] {
        errors(&mut out, group.title(), results, &[group])?;
    }
    let noise = results.iter().map(|result| result.noise).fold(0.0, f64::max);
    writeln!(out, "\nThe judge's own random numbers make a lobe error of at most {noise:.3}.")?;
    laws(&mut out, results)?;
    remedies(&mut out, results)?;
    out.push_str(SOURCES);
    Ok(out)
}

fn errors(out: &mut String, title: &str, results: &[Result], groups: &[Group]) -> std::fmt::Result {
    writeln!(
        out,
        "\n## {title}\n\n| formula | albedo error: mean | median | largest | lobe error: median | largest |\n|---|--:|--:|--:|--:|--:|"
    )?;
    names().enumerate().try_for_each(|(number, name)| {
        writeln!(out, "| {name} | {} |", cells(views(results, number, groups, |judged| &judged.views)).1)
    })
}

fn laws(out: &mut String, results: &[Result]) -> std::fmt::Result {
    writeln!(
        out,
        "\n## Energy and reciprocity\n\nA clear coat over a metal that absorbs nothing returns all light: the *white furnace* is the range of directional albedos there, which should be 1. \
         *Largest albedo* is that over all other coats. *Asymmetry* is the largest difference of f when light and eye change places, over the larger value, among {PAIRS} random pairs a case with cosines from {COS_MIN}. \
         `lobes` is not reciprocal, because its rows follow the angle of the eye: it is not for methods that trace light from both ends.\n\n\
         | formula | white furnace: least | most | largest albedo | asymmetry |\n|---|--:|--:|--:|--:|"
    )?;
    for (number, name) in names().enumerate() {
        let white = |fold: fn(f64, f64) -> f64, start| {
            views(results, number, &[Group::Furnace], |judged| &judged.views)
                .map(|view| view.albedo_model)
                .fold(start, fold)
        };
        let largest =
            views(results, number, &COATED, |judged| &judged.views).map(|view| view.albedo_model).fold(0.0, f64::max);
        let coated = results.iter().filter(|result| !matches!(result.group, Group::Bare | Group::BareMixture));
        let asymmetry = coated.map(|result| result.models[number].asymmetry).fold(0.0, f64::max);
        writeln!(
            out,
            "| {name} | {:.3} | {:.3} | {largest:.3} | {asymmetry:.3} |",
            white(f64::min, f64::INFINITY),
            white(f64::max, 0.0)
        )?;
    }
    Ok(())
}

fn remedies(out: &mut String, results: &[Result]) -> std::fmt::Result {
    out.push_str(
        "\n## What each could change\n\nOne change, the same for all, which takes no table: below a coat of index n and slope parameter a_c the base has the slope parameter `sqrt(n^2 a^2 + (n - 1)^2 a_c^2 / 2)`, at most 1, \
         and the factor `(1 - K) / (1 - K c)`, c its colour. K is what the coat sends back: its average reflectance F from outside for mirrors, `1 - (1 - F) / n^2` for diffuse bases, and between them by the slope parameter for metals and by `metallic`. \
         It stands in place of the width and the factor that a formula has; all else stays. Formulas without a factor gain by it; OpenPBR in MaterialX has both already, and its lines say whether these are better. The width is derived for small slopes; the factor is OpenPBR 1.1's, with another measure of roughness. Unity's HDRP, whose coat is not on this page, widens the base by n in the same way (`FillMaterialClearCoatData` of its Lit shader); those of Unreal and Godot are not here, either.\n\n",
    );
    for (number, engine) in ENGINES.iter().enumerate() {
        let part = |groups: &[Group]| {
            let now = cells(views(results, number, groups, |judged| &judged.views)).0;
            (now, cells(views(results, number, groups, |judged| &judged.remedied)).0)
        };
        let ((now, then), (metal, metal_then)) = (part(&COATED), part(&[Group::Metal]));
        writeln!(
            out,
            "- {}: with this base the median lobe error goes from {:.3} to {:.3} over all coats, from {:.3} to {:.3} over metals; the median albedo error from {:.3} to {:.3}, and from {:.3} to {:.3}; the largest albedo error from {:.3} to {:.3}.",
            engine.name,
            now[3],
            then[3],
            metal[3],
            metal_then[3],
            now[1],
            then[1],
            metal[1],
            metal_then[1],
            now[2],
            then[2]
        )?;
    }
    Ok(())
}
