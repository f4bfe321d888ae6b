//! The list of models.

use luthier_layers::registry;
use pyo3::prelude::*;
use pyo3::types::PyDict;

/// All models, in the order of `luthier models`.
#[pyfunction]
pub(crate) fn models(py: Python<'_>) -> PyResult<Vec<Bound<'_, PyDict>>> {
    let entry = |info: luthier_layers::model::ModelInfo| {
        let dict = PyDict::new(py);
        dict.set_item("name", info.name)?;
        dict.set_item("kind", info.kind.name())?;
        dict.set_item("source", info.source)?;
        dict.set_item("domain", info.domain)?;
        dict.set_item("leaves_out", info.leaves_out)?;
        dict.set_item("reciprocal", info.claims.reciprocal)?;
        dict.set_item("conserves_energy", info.claims.conserves_energy)?;
        dict.set_item("inputs", info.inputs.iter().map(|input| input.name()).collect::<Vec<_>>())?;
        Ok(dict)
    };
    registry::models().iter().map(|model| entry(model.info())).collect()
}
