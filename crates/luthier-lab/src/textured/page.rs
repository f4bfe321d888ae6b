//! The page of textured materials.

use std::fmt::Write as _;

use luthier_report::{AT_PLACES, SimulatedErrors};
use luthier_terminal::{Failure, Outcome};

use super::{Judged, THETAS_DEG};
use crate::cli::{TexturedOptions, call};

/// The page.
pub(super) fn write(judged: &[Judged], generator: &str, adapter: &str, options: &TexturedOptions) -> Outcome<String> {
    let mut out = introduction(generator, adapter, options);
    let written =
        shaders(&mut out, judged).and_then(|()| rows(&mut out, judged)).and_then(|()| misses(&mut out, judged));
    written.map_err(Failure::input)?;
    Ok(out)
}

fn introduction(generator: &str, adapter: &str, options: &TexturedOptions) -> String {
    let TexturedOptions { pairs, places, precision, .. } = options;
    let (noise, command) = (precision.noise, command(options));
    let angles: Vec<String> = THETAS_DEG.iter().map(f64::to_string).collect();
    format!(
        "# Textured materials at random places\n\n\
         `{command}` makes this page. It ran on {adapter}, by {generator}.\n\n\
         A *place* has values of all maps and effects of a material, drawn at random and each by itself, from the range that the texels of its map can give: factors on \
         slope parameters, slab and film, base colour, normals, patina. The page compares three things there, each with the next.\n\n\
         1. *Shader*: `luthier_eval_at` on the device, at {pairs} places with a pair of directions each, half all over the hemisphere and half in highlights.\n\
         2. *Rows*: the same model in f64, on the tables that ship: their quantised texels, read with the weights of the device.\n\
         3. *Simulation*: the paths of `layered-mc` in the stack that the file means at the place. Rows of `lobes` are compared with it at {places} places, from angles of the eye of \
         {} degrees. For other models the exact terms at the place stand here.\n\n\
         Errors of the shader are over max(brightest channel, 0.01); their 99th percentile may be {AT_PLACES}. The lobe error of rows may be 0.08 and the error of their albedo \
         0.02; both are those of [lobes.md](lobes.md), the largest channel, the largest of all places and angles. *Grazing* is the error of the mean of `f cos` over light flatter than \
         87.1 degrees, over max(the mean, 0.01); it may be 0.08. Eyes flatter than 78.5 degrees have their highlight in that light, and are left out. Behind ± is the noise of the simulation there: of lobe errors what noise makes of no error, else a standard \
         error. Views were traced to a lobe noise of {noise}. A miss is beyond its limit by more than one and a half times the noise of a lobe error, or four standard errors.\n\n\
         Normals turn the frame of the eye alone, and flakes have a measure of their own: the simulation leaves both out. Patina is there whole or not at all, because light is \
         linear between; patina that scatters is compared where it is bare.\n\n",
        angles.join(", ")
    )
}

/// The command line that makes the page.
fn command(options: &TexturedOptions) -> String {
    let mut words = vec![call("textured", &options.paths)];
    words.push(format!("--pairs {} --places {} --noise {}", options.pairs, options.places, options.precision.noise));
    words.extend(options.no_generated.then(|| "--no-generated".to_owned()));
    words.extend(options.only.as_ref().map(|name| format!("--only {name}")));
    words.extend(options.destination.output.as_ref().map(|path| format!("-o {}", path.display())));
    words.join(" ")
}

fn shaders(out: &mut String, judged: &[Judged]) -> std::fmt::Result {
    let held = judged.iter().filter(|judged| judged.holds()).count();
    writeln!(out, "## Shader against rows\n\nOf {} materials {held} hold.\n", judged.len())?;
    writeln!(
        out,
        "| material | model | varies | 99th percentile | largest | not finite | rows against exact terms, 99th | largest |"
    )?;
    writeln!(out, "|---|---|---|--:|--:|--:|--:|--:|")?;
    for Judged { name, model, at, .. } in judged {
        let shader = at.shader.as_ref().map_or_else(
            || "– | – | –".to_owned(),
            |e| format!("{:.1e} | {:.1e} | {}", e.relative_dim.p99, e.relative_dim.max, e.not_finite),
        );
        let tables = at
            .tables
            .as_ref()
            .map_or_else(|| "– | –".to_owned(), |e| format!("{:.1e} | {:.1e}", e.relative_dim.p99, e.relative_dim.max));
        writeln!(out, "| {name} | `{model}` | {} | {shader} | {tables} |", at.varies.join(", "))?;
    }
    Ok(())
}

fn rows(out: &mut String, judged: &[Judged]) -> std::fmt::Result {
    let simulated: Vec<_> = judged.iter().filter_map(|judged| Some((judged, judged.at.simulated.as_ref()?))).collect();
    let paths: u64 = simulated.iter().map(|(_, found)| found.paths).sum();
    let noise = simulated.iter().map(|(_, found)| noise(found)).fold(0.0, f64::max);
    writeln!(
        out,
        "\n## Rows against the simulation\n\n{} million paths; the largest noise of a lobe error is {noise:.4}.\n",
        paths / 1_000_000
    )?;
    writeln!(
        out,
        "| material | places and angles | lobe error | albedo | grazing | misses |\n|---|--:|--:|--:|--:|--:|"
    )?;
    for (Judged { name, .. }, found) in simulated {
        let worst = [found.worst(|v| v.lobe), found.worst(|v| v.albedo), found.worst(|v| v.grazing)];
        let [lobe, albedo, grazing] = worst.map(|[error, noise]| format!("{error:.3} ± {noise:.3}"));
        let (views, misses) = (found.views.len(), found.misses().count());
        writeln!(out, "| {name} | {views} | {lobe} | {albedo} | {grazing} | {misses} |")?;
    }
    Ok(())
}

/// The largest noise of a lobe error.
fn noise(found: &SimulatedErrors) -> f64 {
    found.views.iter().map(|view| view.lobe[1]).fold(0.0, f64::max)
}

fn misses(out: &mut String, judged: &[Judged]) -> std::fmt::Result {
    let all: Vec<_> = judged.iter().filter_map(|judged| Some((judged, judged.worst.as_ref()?))).collect();
    if all.is_empty() {
        return writeln!(out, "\nThere is no miss.");
    }
    writeln!(
        out,
        "\n## Misses, and why\n\nThe worst view of each material that misses. *Fitted there* are the errors of lobes that are fitted to the stack of that very place, with all that \
         varies in it: where these hold, what is wrong is the way from the rows to the place; where they do not, two lobes have not the shape.\n"
    )?;
    writeln!(out, "| material | place | angle | what | fitted there | cause |\n|---|---|--:|---|---|---|")?;
    for (Judged { name, left_out, .. }, (worst, again)) in all {
        let [there, fitted] = [worst, again].map(|view| {
            format!("lobe {:.3}, albedo {:.3}, grazing {:.3}", view.lobe[0], view.albedo[0], view.grazing[0])
        });
        let cause = if !left_out.is_empty() {
            format!("the model leaves out {}", left_out.join(", "))
        } else if again.misses().is_empty() {
            "rows are not those of the place".to_owned()
        } else {
            "shape: two lobes have not this one".to_owned()
        };
        let (place, theta_deg) = (&worst.place, worst.theta_deg);
        writeln!(out, "| {name} | {place} | {theta_deg} | {there} | {fitted} | {cause} |")?;
    }
    Ok(())
}
