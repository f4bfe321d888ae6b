//! Values of the tables that a bake ships, at a place.

use std::path::Path;

use luthier::function::{Color, Kind};
use luthier_export::{Folder, shared};
use luthier_layers::model::Estimate;
use luthier_manifest::ColorMode;
use luthier_report::{Rows, Subject as Judged, Weights};
use luthier_terminal::{Failure, Outcome};
use rayon::prelude::*;

use super::{Subject, values};
use crate::directions::Angles;
use crate::materials::is_baked_as;

/// Prints the values of the rows in a folder for pairs (wi, wo).
pub(super) fn shipped(subject: &Subject, folder: &Path, pairs: &[[Angles; 2]], json: bool) -> Outcome {
    let lock = shared(folder);
    let bake = Folder::open(folder)?;
    let (manifest, textures) = (bake.manifest(), bake.textures()?);
    drop(lock);
    let (material, model) = (&subject.of.material, subject.of.model.info().name);
    let number = manifest.materials.iter().position(|entry| entry.name == material.name);
    let number = number.ok_or_else(|| missing(folder, &format!("the bake has no material `{}`", material.name)))?;
    let entry = &manifest.materials[number];
    if entry.model.name() != model {
        let text = format!("the bake shades `{}` by `{}`, not by `{model}`", material.name, entry.model.name());
        return Err(missing(folder, &text));
    }
    if !is_baked_as(&mut material.clone(), entry)? {
        let source = &material.source;
        let text = format!("{source} has changed since it was baked, or a file that it names; bake again");
        return Err(missing(folder, &text));
    }
    // Only this material is evaluated.
    let stacks = vec![material.reflecting_stack().into_owned(); manifest.materials.len()];
    let judged = Judged { manifest, textures, stacks, maps: Vec::new(), films: Vec::new() };
    let rows = Rows::at(&judged, number, &subject.of.place, Weights::Exact).map_err(Failure::input)?;
    let found: Vec<Vec<Estimate>> = pairs
        .par_iter()
        .map(|[wi, wo]| rows.eval(wi.direction(), wo.direction()).map(Estimate::exact).to_vec())
        .collect();
    let color = match entry.color {
        ColorMode::Spectral => Color::Spectral,
        ColorMode::ThreeWavelengths => Color::ThreeWavelengths(entry.wavelengths_nm),
    };
    values::show(subject.head(), Kind::Color(color), false, pairs, &found, json)
}

fn missing(folder: &Path, why: &str) -> Failure {
    Failure::Input(anyhow::anyhow!("{}: {why}", folder.display()))
}
