//! Bakes in memory.

use std::collections::BTreeMap;
use std::path::Path;
use std::str::FromStr;

use luthier::{Compression, Encoded, FunctionGroup, Observer, Package, Shading, Source};
use luthier_bake::JobKind;
use luthier_lut::Image;
use numpy::PyArray3;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::arrays;
use crate::fault;
use crate::interrupt::{self, Interrupt};
use crate::material::Material;
use crate::store::store;

/// A package in memory.
#[pyclass(frozen, module = "luthier._luthier")]
pub(crate) struct Baked {
    package: Package,
    encoded: Encoded,
    warnings: Vec<String>,
}

/// Options in Python's names.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub(crate) struct Asked {
    model: Option<String>,
    no_fit: bool,
    forms: Vec<String>,
    targets: Vec<String>,
    functions: Vec<String>,
    tables: Vec<String>,
}

/// Ends a bake that no one waits for before its next job.
struct Watch<'a>(&'a Interrupt);

impl Observer for Watch<'_> {
    fn planned(&self, _: usize) {}
    fn finished(&self, _: JobKind) {}
    fn batch(&self, _: JobKind, _: bool) {}
    fn is_cancelled(&self) -> bool {
        self.0.is_raised()
    }
}

/// The values of names.
fn named<T: FromStr<Err: ToString>>(names: &[String]) -> PyResult<Vec<T>> {
    names.iter().map(|name| name.parse().map_err(fault::value)).collect()
}

/// Bakes materials.
#[pyfunction]
pub(crate) fn bake(py: Python<'_>, materials: Vec<PyRef<'_, Material>>, asked: Asked) -> PyResult<Baked> {
    let model = asked.model.map(|name| name.parse().map_err(fault::value)).transpose()?;
    let (forms, tables) = (named(&asked.forms)?, named(&asked.tables)?);
    let shading = Shading { model, no_fit: asked.no_fit, reflectance: None, tables, forms };
    let (targets, functions) = (named(&asked.targets)?, named::<FunctionGroup>(&asked.functions)?);
    let mut sources: Vec<Source> = materials.iter().map(|material| material.source.clone()).collect();
    py.detach(|| luthier::refuse(&mut sources, |material| shading.doubts(material)));
    if let Some(broken) = sources.iter().find(|source| source.material().is_none()) {
        return Err(fault::refused(py, broken.diagnostics(), &broken.text));
    }
    let warnings = sources.iter().flat_map(|source| source.diagnostics().iter().map(|one| one.render(&source.text)));
    let warnings = warnings.collect();
    let materials: Vec<luthier::Material> = sources.iter().filter_map(|source| source.material().cloned()).collect();
    let made = interrupt::at_once(py, move |interrupt| {
        let observer = &Watch(interrupt);
        let functions = functions.into_iter().collect();
        let bake = luthier::Bake { targets, functions, shading, observer, ..luthier::Bake::default() };
        let package = bake.package(&bake.shading.shaded(materials), store())?;
        let encoded = package.encode(Compression::Zstd)?;
        Ok((package, encoded))
    });
    let (package, encoded) = made?.map_err(|error: luthier::Error| fault::of(py, &error))?;
    Ok(Baked { package, encoded, warnings })
}

#[pymethods]
impl Baked {
    /// The manifest as JSON.
    #[getter]
    fn manifest(&self) -> PyResult<String> {
        self.encoded.manifest.to_json().map_err(fault::value)
    }

    /// Warnings as the command prints them.
    #[getter]
    fn warnings(&self) -> Vec<String> {
        self.warnings.clone()
    }

    /// All files but the manifest, by path.
    fn files<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let files = PyDict::new(py);
        for (path, bytes) in &self.encoded.files {
            files.set_item(path, pyo3::types::PyBytes::new(py, bytes))?;
        }
        Ok(files)
    }

    /// Texels of the tables as they are read, or before they were rounded, by kind.
    fn tables<'py>(
        &self,
        py: Python<'py>,
        unrounded: bool,
    ) -> PyResult<BTreeMap<&'static str, Bound<'py, PyArray3<f32>>>> {
        let tables = self.package.tables.iter().map(|table| {
            let image = match (&table.truth, unrounded) {
                (Some(truth), true) => truth.clone(),
                (Some(truth), false) => filled(table.texture.image().map_err(fault::value)?, truth.channels),
                (None, _) => table.texture.image().map_err(fault::value)?,
            };
            Ok((table.kind.name(), arrays::image(py, image)?))
        });
        tables.collect()
    }

    /// Writes the package into a folder.
    fn write(&self, py: Python<'_>, folder: &str) -> PyResult<()> {
        let folder = Path::new(folder);
        py.detach(|| self.encoded.clone().for_folder(folder).write(folder)).map_err(fault::file)
    }
}

/// The channels of an image that a table fills: formats of three channels are stored as four.
fn filled(image: Image, channels: u32) -> Image {
    if image.channels <= channels {
        return image;
    }
    let data = image.texels().flat_map(|texel| texel[..channels as usize].iter().copied()).collect();
    Image { channels, data, ..image }
}
