//! Limits that a report is held against.

use luthier_lut::Values;
use luthier_manifest::{Budget, Candidate};
use serde::{Deserialize, Serialize};

use crate::judge::report::Report;
use crate::measure::seen::SeenLight;

/// A limit and the value that it was compared with.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Limit {
    /// Origin of the limit: a material file, or the command line.
    pub stated_by: String,
    /// Quantity that is limited, in words.
    pub quantity: String,
    /// The limit.
    pub limit: f64,
    /// Value that was found; `None` if it is not finite, or if nothing was measured for the limit.
    pub found: Option<f64>,
    /// Source of the value: measured here, or stated by the baker.
    pub found_by: String,
    /// Whether the value is at most the limit.
    pub is_held: bool,
}

/// The budget of a material file.
#[derive(Debug, Clone, PartialEq)]
pub struct FileBudget {
    /// Place of the material in the report.
    pub material: usize,
    /// Its limits.
    pub budget: Budget,
}

/// Limits of the command line.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Asked {
    /// Limit on the absolute error of every table, as measured here.
    pub max_abs: Option<f64>,
    /// Limit on the colour difference of the shaders (without a device, of the tables) under [`SeenLight::Daylight`].
    pub delta_e: Option<f64>,
    /// Limit on the mean FLIP of the pictures.
    pub flip: Option<f64>,
    /// Limit on the texel bytes of all tables.
    pub max_bytes: Option<u64>,
    /// Limit on the lobe error of the models that ship against the reference.
    pub lobe: Option<f64>,
}

const HERE: &str = "measured here";
const BAKER: &str = "stated by the baker";
const BOTH: &str = "measured here; of tables that are not, stated by the baker";

const LARGER: &str = "measured here or stated by the baker, whichever is larger";

/// Compares a report with the budgets of its materials and with those asked for. A quantity that was not measured breaks its limit.
pub fn limits(report: &Report, files: &[FileBudget], asked: &Asked) -> Vec<Limit> {
    let mut out = Vec::new();
    for FileBudget { material, budget } in files {
        let Some(material) = report.materials.get(*material) else { continue };
        // Thickness textures are pictures.
        let tables = report.tables.iter().filter(|t| t.kind.facts().values != Values::Picture);
        let read = tables.flat_map(|t| &t.tiles).filter(|tile| tile.is_read_by(&material.name));
        let measured = read.clone().map(|tile| tile.judge.as_ref().unwrap_or(&tile.baker).max_abs_err);
        let measured = Some(measured.fold(0.0, f64::max));
        let by = if read.clone().all(|tile| tile.judge.is_some()) { HERE } else { BOTH };
        let chosen: Vec<&Candidate> = report.searches.iter().filter_map(|s| s.front.get(s.chosen)).collect();
        let cost = Some(chosen.iter().map(|c| c.cost).sum()).filter(|_| !report.searches.is_empty());
        let stated = [
            ("tables: largest absolute error", budget.max_abs, measured, by),
            ("tables: largest relative error", budget.max_rel, largest(&chosen, |c| Some(c.error.max_rel)), BAKER),
            ("tables: largest CIEDE2000", budget.delta_e, largest(&chosen, |c| c.error.delta_e), BAKER),
            ("bytes of all tables", budget.max_bytes.map(|b| b as f64), Some(bytes(report)), HERE),
            ("estimated cost of one read of every searched table", budget.max_cost, cost, BAKER),
            ("lobes: largest lobe error", budget.max_lobe_err, largest(&chosen, |c| c.error.lobe), BAKER),
            ("lobes: largest error of the albedo", budget.max_albedo_err, largest(&chosen, |c| c.error.albedo), BAKER),
        ];
        for (quantity, limit, found, by) in stated {
            out.extend(limit.map(|limit| made(&material.source, quantity, limit, found, by)));
        }
    }
    // Random directions may miss the place of the largest error of a tile, so tiles are held to the aim of the bake as well.
    let missed = report.tables.iter().flat_map(|table| table.tiles.iter().map(|tile| (table.kind.name(), tile)));
    let missed = missed.filter_map(|(kind, tile)| Some((tile.miss()?.0, kind, &tile.name)));
    if let Some((found, kind, tile)) = missed.max_by(|a, b| a.0.total_cmp(&b.0)) {
        let quantity = format!("tables: absolute error of {kind} tile {tile}, which misses what the bake aimed at");
        out.extend(report.budget.map(|limit| made("command line", &quantity, limit, Some(found), LARGER)));
    }
    // A budget of tables does not apply to lobes that are another stack's: these have limits of their own.
    for material in report.materials.iter().filter(|_| report.budget.is_some()) {
        let at = material.at_places.iter().filter_map(|at| at.simulated.as_ref());
        let views = at.flat_map(|simulated| &simulated.views);
        if let Some(worst) = views.max_by(|a, b| a.excess().total_cmp(&b.excess())) {
            for (name, found, limit) in worst.misses() {
                let angle = format!("{:.1} degrees", worst.theta_deg);
                let quantity =
                    format!("{}: {name} at place {} ({}), from {angle}", material.name, worst.number, worst.place);
                out.push(made("places of lobes", &quantity, limit, Some(found), HERE));
            }
        }
    }
    // Without tables nothing is read wrongly.
    let tables = report.worst_table().map_or(0.0, |(error, ..)| error);
    let seen = report.worst_seen(SeenLight::Daylight).map(|(difference, _)| difference);
    let flip = report.materials.iter().map(|m| m.picture.as_ref().map(|p| p.flip_mean));
    let flip = flip.collect::<Option<Vec<f64>>>().and_then(|all| all.into_iter().reduce(f64::max));
    let lobe = report.worst_model().map(|(_, model)| model.lobe_err);
    let stated = [
        ("tables: largest absolute error", asked.max_abs, Some(tables), LARGER),
        ("shaders: largest CIEDE2000 in daylight", asked.delta_e, seen, HERE),
        ("pictures: largest mean FLIP", asked.flip, flip, HERE),
        ("bytes of all tables", asked.max_bytes.map(|b| b as f64), Some(bytes(report)), HERE),
        ("models: largest lobe error against the reference", asked.lobe, lobe, HERE),
    ];
    for (quantity, limit, found, by) in stated {
        out.extend(limit.map(|limit| made("command line", quantity, limit, found, by)));
    }
    out
}

/// The largest figure of the candidates that have it.
fn largest(candidates: &[&Candidate], figure: fn(&Candidate) -> Option<f64>) -> Option<f64> {
    candidates.iter().filter_map(|candidate| figure(candidate)).reduce(f64::max)
}

fn bytes(report: &Report) -> f64 {
    report.tables.iter().map(|t| t.texel_bytes).sum::<u64>() as f64
}

fn made(stated_by: &str, quantity: &str, limit: f64, found: Option<f64>, found_by: &str) -> Limit {
    let found = found.filter(|f| f.is_finite());
    Limit {
        stated_by: stated_by.to_owned(),
        quantity: quantity.to_owned(),
        limit,
        found,
        found_by: found_by.to_owned(),
        is_held: found.is_some_and(|found| found <= limit),
    }
}
