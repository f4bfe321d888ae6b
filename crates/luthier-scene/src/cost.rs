//! Costs of shaders by model, form and shape, as a compiler counted them.

use luthier_manifest::{Form, ShadingModel};
use serde::{Deserialize, Serialize};

use crate::shape::{distance, shape_of};

/// Output of `scripts/pages.sh shapes`, with the version of the driver in it.
pub const COST_DATA: &str = include_str!("../data/cost.json");

/// Costs of shaders by model, form and shape of the surface.
///
/// ```
/// use luthier_manifest::{Form, ShadingModel};
/// use luthier_scene::CostTable;
///
/// // A smooth dielectric of Beckmann slopes over a conductor.
/// let (cycles, is_of_similar) = CostTable::shipped().cost(ShadingModel::Elek, Form::Baked, "dbx/cb").unwrap();
/// assert!(cycles > 0.0 && !is_of_similar);
/// ```
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct CostTable {
    /// Driver and version.
    pub driver: String,
    /// Family of GPUs.
    pub family: String,
    /// One per model, form and shape, in this order.
    pub rows: Vec<CostRow>,
}

/// Cost of one shader.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct CostRow {
    /// The model.
    pub model: ShadingModel,
    /// The form.
    pub form: Form,
    /// The shape that the model sees, see [`shape_of`].
    pub shape: String,
    /// Inverse throughput, cycles per wave of 64.
    pub cycles: u32,
}

impl CostTable {
    /// The table that ships, [`COST_DATA`].
    pub fn shipped() -> Self {
        // A test reads the data. If it were broken all the same, no shader would have a cost, and no model would be a candidate.
        serde_json::from_str(COST_DATA).unwrap_or_else(|_| Self {
            driver: String::new(),
            family: String::new(),
            rows: Vec::new(),
        })
    }

    /// The table without the costs of a model. The model is then no candidate.
    pub(crate) fn without(mut self, model: ShadingModel) -> Self {
        self.rows.retain(|row| row.model != model);
        self
    }

    /// Cost of a shader for a surface of some [`shape`](crate::shape). The flag is true if the shape was not measured and the cost is that of the most
    /// similar one; among equally similar shapes the dearest counts.
    pub fn cost(&self, model: ShadingModel, form: Form, shape: &str) -> Option<(f64, bool)> {
        let wanted = shape_of(model, shape);
        let rows = self.rows.iter().filter(|row| row.model == model && row.form == form);
        let near = rows.map(|row| (distance(&row.shape, &wanted), row.cycles));
        let (distance, cycles) = near.min_by_key(|&(distance, cycles)| (distance, std::cmp::Reverse(cycles)))?;
        Some((f64::from(cycles), distance > 0))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_shipped_table_is_whole() {
        let table: CostTable = serde_json::from_str(COST_DATA).unwrap();
        for model in ShadingModel::ALL {
            for form in Form::ALL.into_iter().filter(|form| model.has(*form)) {
                let (cost, is_of_similar) = table.cost(model, form, "dbx/cb").unwrap();
                assert!(cost > 0.0 && !is_of_similar, "{model:?} {form:?}");
            }
        }
        let mut keys: Vec<_> = table.rows.iter().map(|row| (row.model.name(), row.form, &row.shape)).collect();
        let count = keys.len();
        keys.sort();
        keys.dedup();
        assert_eq!(keys.len(), count);
    }

    /// Why the form `full` is only looked at where tables have no room.
    #[test]
    fn no_full_form_is_cheaper_than_its_baked_form() {
        let table = CostTable::shipped();
        for row in table.rows.iter().filter(|row| row.form == Form::Full) {
            let baked = table.rows.iter().find(|r| (r.model, r.form, &r.shape) == (row.model, Form::Baked, &row.shape));
            assert!(baked.is_some_and(|baked| baked.cycles <= row.cycles), "{row:?} {baked:?}");
        }
    }
}
