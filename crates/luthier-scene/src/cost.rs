//! Costs of shaders by model, form and shape, on a device.

use luthier_cost::{DEFAULT_DEVICE, DeviceCost, Family, StaticCounts};
use luthier_layers::models::lobes::LOBES;
use luthier_manifest::{CostDevice, Form, LobesForm, Manifest, ShadingModel};
use serde::{Deserialize, Serialize};

use crate::shape::{distance, shape_of};

/// Output of `scripts/pages.sh shapes`, with the version of the driver in it.
pub const COST_DATA: &str = include_str!("../data/cost.json");

/// Counts of shaders by model, form and shape of the surface: [`COST_DATA`].
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ShapeTable {
    /// Driver whose compiler counted cycles, with its version.
    pub driver: String,
    /// Families of GPUs, in the order of [`ShapeRow::cycles`].
    pub families: Vec<Family>,
    /// Names of the counts, in the order of [`ShapeRow::counts`].
    pub counts: Vec<String>,
    /// One per model, form and shape.
    pub rows: Vec<ShapeRow>,
}

/// Counts of one shader.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ShapeRow {
    /// The model.
    pub model: ShadingModel,
    /// The form.
    pub form: Form,
    /// The shape that the model sees, see [`shape_of`].
    pub shape: String,
    /// Form of its rows, of the model `lobes`.
    #[serde(default)]
    pub lobes: Option<LobesForm>,
    /// Whether its rows are in steps in a buffer, see [`RowLayout::Steps`](luthier_lut::RowLayout::Steps); else a texture that is filtered has them.
    #[serde(default)]
    pub in_steps: bool,
    /// Inverse throughput by the driver's compiler, cycles per wave of 64, for each family.
    pub cycles: Vec<u32>,
    /// Counts of the text for one light.
    pub counts: [u32; StaticCounts::NAMES.len()],
}

/// Costs of shaders on one device, by model, form and shape of the surface.
///
/// ```
/// use luthier_manifest::{Form, ShadingModel};
/// use luthier_scene::CostTable;
///
/// // A smooth dielectric of Beckmann slopes over a conductor.
/// let (cost, is_of_similar) = CostTable::shipped().cost(ShadingModel::Elek, Form::Baked, "dbx/cb", None).unwrap();
/// assert!(cost > 0.0 && !is_of_similar);
/// // Reads of textures weigh more on a device that was timed than in the cycles that a compiler counts.
/// let ratio = |device| {
///     let costs = CostTable::on(device).unwrap();
///     let [lobes, elek] = [ShadingModel::Lobes, ShadingModel::Elek].map(|m| costs.cost(m, Form::Baked, "dbx/cb", None).unwrap().0);
///     lobes / elek
/// };
/// assert!(ratio("h100") > 1.2 * ratio("rdna2"));
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct CostTable {
    /// The device.
    pub device: DeviceCost,
    /// One per model, form, shape and rows, in the order of the data.
    pub rows: Vec<CostRow>,
    /// Whether targets have room for rows in steps.
    pub has_steps: bool,
}

/// Cost of one shader.
#[derive(Debug, Clone, PartialEq)]
pub struct CostRow {
    /// The model.
    pub model: ShadingModel,
    /// The form.
    pub form: Form,
    /// The shape that the model sees, see [`shape_of`].
    pub shape: String,
    /// Form of its rows, of the model `lobes`.
    pub lobes: Option<LobesForm>,
    /// Whether its rows are in steps in a buffer.
    pub in_steps: bool,
    /// Cost of one evaluation, in the unit of the device.
    pub cost: f64,
}

impl CostTable {
    /// The costs of shapes on a device: the compiler's own count where it stands for a family of chips, and the counts of the text times the numbers of
    /// the device elsewhere.
    pub fn of(device: DeviceCost) -> Self {
        // A test reads the data. If it were broken all the same, no shader would have a cost, and no model would be a candidate.
        let table: Option<ShapeTable> = serde_json::from_str(COST_DATA).ok();
        let place = table.iter().flat_map(|table| &table.families).position(|family| device.family == Some(*family));
        let rows = table.into_iter().flat_map(|table| table.rows).map(
            |ShapeRow { model, form, shape, lobes, in_steps, cycles, counts }| {
                let by_compiler = place.and_then(|place| cycles.get(place)).map(|cycles| f64::from(*cycles));
                let cost = by_compiler.unwrap_or_else(|| device.cost(&StaticCounts::of_values(counts)));
                CostRow { model, form, shape, lobes, in_steps, cost }
            },
        );
        Self { rows: rows.collect(), device, has_steps: true }
    }

    /// The costs on a device whose costs ship; `None` for another name.
    pub fn on(device: &str) -> Option<Self> {
        DeviceCost::shipped(device).map(Self::of)
    }

    /// The cycles that RADV's compiler counts for RDNA2.
    pub fn rdna2() -> Self {
        Self::on("rdna2").unwrap_or_else(Self::shipped)
    }

    /// The costs on [`DEFAULT_DEVICE`].
    pub fn shipped() -> Self {
        // A test reads the files of all devices.
        Self::on(DEFAULT_DEVICE).unwrap_or_else(|| unreachable!("the costs of {DEFAULT_DEVICE} ship"))
    }

    /// The device, for manifests.
    pub fn manifest_device(&self) -> CostDevice {
        let DeviceCost { name, device, driver, unit, .. } = self.device.clone();
        CostDevice { name, device, driver, unit: unit.name().to_owned() }
    }

    /// The table without the costs of a model. The model is then no candidate.
    pub(crate) fn without(mut self, model: ShadingModel) -> Self {
        self.rows.retain(|row| row.model != model);
        self
    }

    /// The costs for targets without room for rows in steps.
    #[must_use]
    pub fn filtered(self) -> Self {
        Self { has_steps: false, ..self }
    }

    /// The costs of the rows that a bake has.
    #[must_use]
    pub fn reading(self, manifest: &Manifest) -> Self {
        let has_steps = manifest.tables.iter().any(|table| table.format.has_steps());
        Self { has_steps, ..self }
    }

    /// Cost of a shader for a surface of some [`shape`](crate::shape). The flag is true if the shape was not counted and the cost is that of the most
    /// similar one; among equally similar shapes the dearest counts. `lobes` is the form of rows of that model; without one they are as dear as the dearest that bakes without limits have, in a texture that is filtered.
    pub fn cost(&self, model: ShadingModel, form: Form, shape: &str, lobes: Option<LobesForm>) -> Option<(f64, bool)> {
        let wanted = shape_of(model, shape);
        let in_steps = self.has_steps && lobes.is_some();
        let rows = self.rows.iter().filter(|row| row.model == model && row.form == form);
        let plain = |form: LobesForm| form.most() <= LOBES;
        let rows = rows.filter(|row| row.lobes.is_none_or(|form| lobes.map_or(plain(form), |lobes| lobes == form)));
        let rows = rows.filter(|row| in_steps || !row.in_steps);
        let near = rows.map(|row| (distance(&row.shape, &wanted), in_steps && !row.in_steps, row.cost));
        let (distance, _, cost) = near.min_by(|a, b| a.0.cmp(&b.0).then(a.1.cmp(&b.1)).then(b.2.total_cmp(&a.2)))?;
        Some((cost, distance > 0))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_shipped_table_is_whole() {
        let data: ShapeTable = serde_json::from_str(COST_DATA).unwrap();
        assert_eq!(data.counts, StaticCounts::NAMES);
        assert_eq!(data.families, Family::ALL);
        for device in DeviceCost::names() {
            let table = CostTable::on(device).unwrap();
            for model in ShadingModel::ALL {
                for form in Form::ALL.into_iter().filter(|form| model.has(*form)) {
                    let (cost, is_of_similar) = table.cost(model, form, "dbx/cb", None).unwrap();
                    assert!(cost > 0.0 && !is_of_similar, "{device} {model:?} {form:?}");
                }
            }
        }
        let table = CostTable::shipped();
        let mut keys: Vec<_> =
            table.rows.iter().map(|row| (row.model.name(), row.form, &row.shape, row.lobes, row.in_steps)).collect();
        let count = keys.len();
        keys.sort();
        keys.dedup();
        assert_eq!(keys.len(), count);
    }

    /// The grammar of scenes knows the devices whose costs ship, and no other.
    #[test]
    fn scenes_may_name_every_device() {
        let text = |name: &str| {
            format!(
                "scene = 1\nname = \"shelf\"\n[[material]]\nfile = \"a.toml\"\n[[light]]\ntype = \"environment\"\n\
                 [target]\ndevice = \"{name}\"\n[budget]\nmax_rel = 0.1\n"
            )
        };
        for name in DeviceCost::names() {
            let scene = luthier_material::parse_scene("shelf.toml", &text(name)).unwrap();
            assert_eq!(scene.target.device.as_deref(), Some(name));
        }
        let wrong = luthier_material::parse_scene("shelf.toml", &text("abacus")).unwrap_err();
        assert_eq!(wrong.len(), 1);
    }

    /// Why the form `full` is only looked at where tables have no room. Of clear interfaces alone it may be cheaper: their reflectance is a few operations, and a read of
    /// a row takes longer. llvmpipe filters textures in software, and is no target of scenes.
    #[test]
    fn on_no_gpu_is_a_full_form_with_metals_or_films_cheaper_than_its_baked_form() {
        for device in DeviceCost::names().filter(|name| *name != "llvmpipe") {
            let table = CostTable::on(device).unwrap();
            for row in table.rows.iter().filter(|row| row.form == Form::Full && row.shape.contains(['c', 'f', 'v'])) {
                let same = |r: &&CostRow| (r.model, r.form, &r.shape) == (row.model, Form::Baked, &row.shape);
                let baked = table.rows.iter().find(same);
                assert!(baked.is_some_and(|baked| baked.cost <= row.cost), "{device}: {row:?} {baked:?}");
            }
        }
    }
}
