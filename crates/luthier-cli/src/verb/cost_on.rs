//! `cost --device`: costs of shaders on a device that was timed, by counts of their texts. No driver is needed.

use std::fmt::Write as _;

use luthier_cost::{DeviceCost, StaticCounts};
use luthier_export::GENERATOR;
use luthier_manifest::ShadingModel;
use luthier_scene::cost_text;
use luthier_shader::{Form, style_name};
use luthier_terminal::{Failure, Outcome};
use serde_json::json;

/// Version of the JSON.
const SCHEMA: u32 = 1;

/// One shader.
pub(super) struct Shader {
    pub(super) material: String,
    pub(super) model: ShadingModel,
    pub(super) form: Form,
    pub(super) closed: bool,
    pub(super) constant: bool,
    /// Counts of its text for one light.
    pub(super) counts: StaticCounts,
}

/// The costs as JSON.
pub(super) fn json(costs: &DeviceCost, shaders: &[Shader]) -> Outcome<String> {
    let rows = shaders.iter().map(|shader| {
        let counts = StaticCounts::NAMES
            .iter()
            .zip(shader.counts.values())
            .map(|(name, count)| ((*name).to_owned(), count.into()));
        json!({
            "material": shader.material,
            "model": shader.model,
            "form": shader.form,
            "closed": shader.closed,
            "constant": shader.constant,
            "cost": costs.cost(&shader.counts),
            "counts": counts.collect::<serde_json::Map<String, serde_json::Value>>(),
        })
    });
    let costs = serde_json::to_value(costs).map_err(Failure::input)?;
    let rows: Vec<serde_json::Value> = rows.collect();
    Ok(format!("{:#}\n", json!({ "schema": SCHEMA, "generator": GENERATOR, "device": costs, "rows": rows })))
}

/// The costs as a page; `command` is the command line that makes it.
pub(super) fn markdown(costs: &DeviceCost, shaders: &[Shader], command: &str) -> String {
    let own = costs.fit.own;
    let mut page = format!(
        "# What the shaders cost on {}\n\nMade by `{command}`, {GENERATOR}. Costs are {}, driver {}: predicted from counts of the texts, not timed. The fit behind them ({}) is off by {:.0} % \
         in the median and {:.0} % at most on its own {} shaders.\n\n| material | model | form |",
        costs.name,
        costs.label(),
        costs.driver,
        costs.source,
        100.0 * own.median,
        100.0 * own.largest,
        costs.fit.rows,
    );
    for name in StaticCounts::NAMES {
        let _ = write!(page, " {} |", name.replace('_', " "));
    }
    page.push_str(" cost |\n|---|---|---|");
    page.push_str(&"--:|".repeat(StaticCounts::NAMES.len() + 1));
    page.push('\n');
    for Shader { material, model, form, closed, constant, counts } in shaders {
        let style = style_name(*model, *form, *closed, *constant);
        let _ = write!(page, "| {material} | {model} | {style} |");
        for count in counts.values() {
            let _ = write!(page, " {count} |");
        }
        let _ = writeln!(page, " {} |", cost_text(costs.cost(counts), costs.unit));
    }
    page
}
