//! Materials.

use std::path::Path;

use luthier::Source;
use pyo3::prelude::*;

use crate::fault;

/// A valid material.
#[pyclass(frozen, module = "luthier._luthier")]
pub(crate) struct Material {
    pub(crate) source: Source,
    pub(crate) material: luthier::Material,
}

impl Material {
    fn of(py: Python<'_>, source: Source) -> PyResult<Self> {
        match source.material() {
            Some(material) => Ok(Self { material: material.clone(), source }),
            None => Err(fault::refused(py, source.diagnostics(), &source.text)),
        }
    }
}

#[pymethods]
impl Material {
    /// The name of the material.
    #[getter]
    fn name(&self) -> &str {
        &self.material.name
    }

    /// The file, as it was named.
    #[getter]
    fn source(&self) -> &str {
        &self.source.label
    }

    /// The text of the material file.
    #[getter]
    fn text(&self) -> &str {
        &self.source.text
    }

    /// The model that a bake chooses.
    #[getter]
    fn model(&self) -> &'static str {
        self.material.model().name()
    }

    /// Number of layers.
    #[getter]
    fn layers(&self) -> usize {
        self.material.stack.layers.len()
    }

    /// Warnings about the file.
    #[getter]
    fn warnings(&self, py: Python<'_>) -> PyResult<Vec<Py<PyAny>>> {
        self.source.diagnostics().iter().map(|one| fault::listed(py, one)).collect()
    }
}

/// Reads a material file.
#[pyfunction]
pub(crate) fn load(py: Python<'_>, path: &str) -> PyResult<Material> {
    let source = py.detach(|| Source::read(Path::new(path))).map_err(|error| fault::of(py, &error))?;
    Material::of(py, source)
}

/// The material of a text. Files that it names are relative to the folder of `label`.
#[pyfunction]
pub(crate) fn parse(py: Python<'_>, text: String, label: &str) -> PyResult<Material> {
    let source = py.detach(|| Source::of_text(Path::new(label), text));
    Material::of(py, source)
}
